#include "facts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plab/rotation.h"

namespace plab::solvers
{
namespace
{

constexpr int kPowers = 3;
constexpr double kShort = 1e-5;  ///< of the motion within a step: for derivatives
constexpr double kLeast = 1e-2;  ///< m, rad, m/s, rad/s: motion that is taken for granted

class Look
{
public:
    Look(DynamicSystem& system, double h, StiffnessMemory& m) : flat_(system), m_(m)
    {
        for (auto* v : {&m.y, &m.f, &m.direction, &m.image, &m.work, &m.units, &m.sizes}) v->resize(flat_.size());
        flat_.read(m_.y);
        flat_.units(m_.units);
        flat_.evaluate(0, m_.y, m_.f);
        flat_.sizes(m_.y, m_.f, h, m_.sizes);
        for (std::size_t i = 0; i < flat_.size(); ++i) m_.sizes[i] = std::fmax(m_.sizes[i], kLeast * m_.units[i]);
    }

    double run()
    {
        const double found = all_finite(m_.f) ? rate() : std::numeric_limits<double>::infinity();
        flat_.write(m_.y);
        return found;
    }

private:
    /// A fixed vector without symmetries, about 1.
    static double pattern(std::size_t i)
    {
        const double fraction = 0.618033988749895 * static_cast<double>(i % 64);
        return (i % 2 == 0 ? 1 : -1) * (0.6 + 0.4 * (fraction - std::floor(fraction)));
    }

    double rate()
    {
        std::fill(m_.direction.begin(), m_.direction.end(), 0.0);
        for (std::size_t i = flat_.places(); i < flat_.size(); ++i) m_.direction[i] = pattern(i) * m_.units[i];
        normalise();
        double square = 0;
        for (int k = 0; k < kPowers; ++k)
        {
            differentiate();
            std::copy(m_.image.begin(), m_.image.end(), m_.direction.begin());
            if (largest(0, flat_.size()) == 0) break;
            differentiate();
            std::copy(m_.image.begin(), m_.image.end(), m_.direction.begin());
            std::fill(m_.direction.begin(), m_.direction.begin() + static_cast<std::ptrdiff_t>(flat_.places()), 0.0);
            square = largest(flat_.places(), flat_.size());
            if (!std::isfinite(square)) return std::numeric_limits<double>::infinity();
            if (square == 0) break;
            normalise();
        }
        return std::sqrt(square);
    }

    double largest(std::size_t from, std::size_t to) const
    {
        double most = 0;
        for (std::size_t i = from; i < to; ++i)
            if (const double part = std::fabs(m_.direction[i]) / m_.units[i]; !(part <= most)) most = part;
        return most;
    }
    void normalise()
    {
        const double size = largest(0, flat_.size());
        for (double& d : m_.direction) d /= size;
    }

    /// image = J direction, over a length that moves nothing by more than kShort of its size.
    void differentiate()
    {
        double most = 0;
        for (std::size_t i = 0; i < flat_.size(); ++i) most = std::fmax(most, std::fabs(m_.direction[i]) / m_.sizes[i]);
        const double length = kShort / most;
        for (std::size_t i = 0; i < flat_.size(); ++i) m_.work[i] = m_.y[i] + length * m_.direction[i];
        flat_.evaluate(0, m_.work, m_.image);
        for (std::size_t i = 0; i < flat_.size(); ++i)
        {
            const double change = m_.image[i] - m_.f[i];
            const bool noise = std::fabs(change) <= 4e-16 * std::fabs(m_.f[i]);
            m_.image[i] = noise ? 0 : change / length;
        }
    }

    FlatSystem flat_;
    StiffnessMemory& m_;
};

}  // namespace

double measure_stiffness(DynamicSystem& system, double h, StiffnessMemory memory) { return Look(system, h, memory).run(); }

double fastest_spin(DynamicSystem& system)
{
    double most = 0;
    const auto u = system.speeds();
    for (std::size_t b = 0; b < system.body_count(); ++b)
    {
        const RigidMember member = system.rigid(b);
        const Vec3 s{u[6 * b + 3], u[6 * b + 4], u[6 * b + 5]};
        most = std::fmax(most, length(member.needle ? s : member.inverse_inertia_B * rotate_back(member.orientation, s)));
    }
    return most;
}

}  // namespace plab::solvers
