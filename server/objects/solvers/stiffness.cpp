#include "stiffness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "plab/rotation.h"

namespace plab::solvers
{
namespace
{

constexpr double kShare = 0.1;                 ///< share of the others' d1 that is added to the member's own
constexpr double kNegligible = 1e-9;           ///< relative to the speeds: a smaller d3 is irrelevant
constexpr double kRoundingOfMotion = 0x1p-43;  ///< relative to a body's size per step, or to a rad: likewise irrelevant
constexpr double kStiff = 0.5, kOverSpin = 4;

double spin_of(DynamicSystem& system, std::size_t body, std::span<const double> u)
{
    const RigidMember member = system.rigid(body);
    const Vec3 s{u[6 * body + 3], u[6 * body + 4], u[6 * body + 5]};
    return length(member.needle ? s : member.inverse_inertia_B * rotate_back(member.orientation, s));
}

/// Numbers [begin, end) that are judged together. `unit`: divisor of the last three speeds of a body, with which rotation counts as
/// motion at the radius of gyration `size` (m; 1 for objects that only rotate).
struct Member
{
    std::size_t begin = 0, end = 0;
    double unit = 1, size = 1;
    bool is_body = false, quantities = false;
};

struct Norms
{
    double first = 0, third = 0, speed = 0;  ///< |d1|, |d3|, and speeds plus their change in the step
};

class Judge
{
public:
    Judge(DynamicSystem& system, double h, const StageSlopes& slopes, bool each_alone)
        : system_(system), h_(h), k_(slopes), u0_(system.workspace(0)), each_alone_(each_alone)
    {
    }

    Stiffness find()
    {
        Norms all[2];
        if (!each_alone_) for_each([&](const Member& m) { add(norms(m), all[m.quantities ? 1 : 0]); });
        Stiffness out;
        for_each(
            [&](const Member& m)
            {
                const Norms n = norms(m), &others = each_alone_ ? n : all[m.quantities ? 1 : 0];
                if (!std::isfinite(n.third)) out.value = std::numeric_limits<double>::infinity(), out.too_much = true;
                if (!(h_ * n.third > kNegligible * others.speed + (m.quantities ? 0 : kRoundingOfMotion * m.size / h_))) return;
                const double found = std::sqrt(2 * n.third / (n.first + (each_alone_ ? 0 : kShare * others.first)));
                out.value = std::fmax(out.value, found);
                if (!(found <= kStiff))
                    out.too_much = out.too_much || !m.is_body || found > kOverSpin * h_ * spin_of(system_, m.begin / 6, u0_);
            });
        return out;
    }

private:
    template <class Visit>
    void for_each(Visit visit)
    {
        const std::size_t n = u0_.size(), bodies = system_.body_count(), quantities = system_.quantity_count();
        for (std::size_t b = 0; b < bodies; ++b) visit(body(b));
        for (std::size_t i = 6 * bodies; i < n - quantities; ++i) visit(Member{i, i + 1});
        if (quantities > 0) visit(Member{n - quantities, n, 1, 1, false, true});
    }

    Member body(std::size_t b)
    {
        Member m{6 * b, 6 * b + 6, 1, 1, true};
        const RigidMember rigid = system_.rigid(b);
        const double most = std::max({rigid.inertia_B(0, 0), rigid.inertia_B(1, 1), rigid.inertia_B(2, 2)});
        m.size = std::sqrt(most / rigid.mass);
        m.unit = (rigid.needle ? 1 : most) / m.size;
        return m;
    }

    Norms norms(const Member& m) const
    {
        Norms speeds, places;
        for (std::size_t i = m.begin; i < m.end; ++i)
        {
            double unit = i >= m.begin + 3 ? m.unit : 1;
            // Quantities: relative to their values and changes.
            if (m.quantities) unit = std::fabs(u0_[i]) + std::fabs(h_ * k_.du[0][i]);
            if (!(unit > 0)) continue;
            add({of_first(k_.du, i) / unit, of_third(k_.du, i) / unit, (std::fabs(u0_[i]) + h_ * std::fabs(k_.du[0][i])) / unit}, speeds);
            const double lever = i >= m.begin + 3 ? m.size : 1;
            if (!m.quantities) add({of_first(k_.dx, i) * lever / h_, of_third(k_.dx, i) * lever / h_, 0}, places);
        }
        return {speeds.first + places.first, speeds.third + places.third, speeds.speed};
    }

    static void add(const Norms& n, Norms& to)
    {
        const auto take = [](double value, double& most)
        {
            if (!(value <= most)) most = value;  // keeps a NaN
        };
        take(n.first, to.first), take(n.third, to.third), take(n.speed, to.speed);
    }
    static double of_first(const std::array<std::span<double>, 4>& k, std::size_t i) { return std::fabs(k[1][i] - k[0][i]); }
    static double of_third(const std::array<std::span<double>, 4>& k, std::size_t i) { return std::fabs(k[3][i] - 2 * k[2][i] + k[0][i]); }

    DynamicSystem& system_;
    double h_;
    const StageSlopes& k_;
    std::span<const double> u0_;
    bool each_alone_;
};

}  // namespace

double fastest_spin(DynamicSystem& system)
{
    double most = 0;
    for (std::size_t b = 0; b < system.body_count(); ++b) most = std::fmax(most, spin_of(system, b, system.speeds()));
    return most;
}

namespace
{

constexpr std::size_t kProbes = 16;

/// Of the distances of rates from those at the start: whether they are near 0 or near the largest, and change between them both ways.
bool jump_to_and_fro(const std::array<double, kProbes>& away)
{
    constexpr int kFewestChanges = 3;
    constexpr double kClose = 0.1;  // of the jump
    const double jump = *std::ranges::max_element(away);
    int changes = 0;
    bool was_far = false;
    for (const double d : away)
    {
        if (!(std::min(d, jump - d) <= kClose * jump)) return false;
        const bool far = d > 0.5 * jump;
        changes += far != was_far ? 1 : 0, was_far = far;
    }
    return changes >= kFewestChanges;
}

/// Whether they grow for many steps on end; one that jumps does so once.
bool grow(const std::array<double, kProbes>& away)
{
    constexpr double kGrowth = 1.25;
    constexpr int kMany = 6;
    int run = 0, longest = 0;
    for (std::size_t k = 1; k < kProbes; ++k)
    {
        run = away[k] <= kGrowth * away[k - 1] ? 0 : run + 1;
        longest = std::max(longest, run);
    }
    return longest >= kMany;
}

}  // namespace

Probed probe(double from, std::span<const double> y, double length, ProbeMemory& m, DynamicSystem& system)
{
    FlatSystem flat(system);
    for (auto* v : {&m.first, &m.rates, &m.change, &m.units}) v->resize(flat.size());
    flat.units(m.units);
    m.y.assign(y.begin(), y.end());
    flat.evaluate(from, m.y, m.first);
    m.rates = m.first;
    std::array<double, kProbes> away{};
    for (std::size_t k = 0; k < kProbes; ++k)
    {
        for (std::size_t i = 0; i < m.y.size(); ++i) m.y[i] += length * m.rates[i];
        flat.evaluate(from + static_cast<double>(k + 1) * length, m.y, m.rates);
        for (std::size_t i = 0; i < m.y.size(); ++i) m.change[i] = i < flat.places() ? 0.0 : m.rates[i] - m.first[i];
        away[k] = FlatSystem::norm(m.change, m.units);
    }
    return {jump_to_and_fro(away), grow(away)};
}

Stiffness stiffness_of(DynamicSystem& system, double h, const StageSlopes& slopes, bool each_alone)
{
    return Judge(system, h, slopes, each_alone).find();
}

}  // namespace plab::solvers
