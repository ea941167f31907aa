#include "runge_kutta4_parts.h"

#include <algorithm>

#include "stiffness.h"

namespace plab::solvers
{
namespace
{

class PartOfStep
{
public:
    /// From t on; `share` of the whole step.
    PartOfStep(double t, double length, double share, DynamicSystem& system)
        : t_(t), length_(length), share_(share), system_(system), slopes_(system), x0_(system.workspace(11)), u0_(system.workspace(0))
    {
        std::copy(system.coordinates().begin(), system.coordinates().end(), x0_.begin());
        std::copy(system.speeds().begin(), system.speeds().end(), u0_.begin());
    }

    void find_slopes()
    {
        for (std::size_t s = 0; s < kRungeKutta4Stages.size(); ++s)
        {
            evaluate(s, 1);
            std::copy(system_.coordinate_rates().begin(), system_.coordinate_rates().end(), slopes_.dx[s].begin());
            std::copy(system_.speed_rates().begin(), system_.speed_rates().end(), slopes_.du[s].begin());
        }
    }
    bool is_too_long() { return stiffness_of(system_, length_, slopes_).too_much; }

    void take_back()
    {
        for (std::size_t s = 0; s < kRungeKutta4Stages.size(); ++s) evaluate(s, -1);
        go_to_stage(0);
    }

    void finish()
    {
        const auto x = system_.coordinates(), u = system_.speeds();
        for (std::size_t i = 0; i < u.size(); ++i) x[i] = x0_[i] + sum(slopes_.dx, i), u[i] = u0_[i] + sum(slopes_.du, i);
    }

private:
    void go_to_stage(std::size_t s)
    {
        const auto x = system_.coordinates(), u = system_.speeds();
        const double length = s == 0 ? 0.0 : length_ * kRungeKutta4Stages[s - 1].next;
        for (std::size_t i = 0; i < u.size(); ++i)
        {
            x[i] = s == 0 ? x0_[i] : x0_[i] + length * slopes_.dx[s - 1][i];
            u[i] = s == 0 ? u0_[i] : u0_[i] + length * slopes_.du[s - 1][i];
        }
    }
    void evaluate(std::size_t s, double sign)
    {
        go_to_stage(s);
        system_.evaluate(t_ + kRungeKutta4Stages[s].time * length_, sign * share_ * kRungeKutta4Stages[s].weight);
    }
    double sum(const std::array<std::span<double>, 4>& k, std::size_t i) const
    {
        double out = 0;
        for (std::size_t s = 0; s < kRungeKutta4Stages.size(); ++s) out += kRungeKutta4Stages[s].sum_weight * k[s][i];
        return length_ / 6 * out;
    }

    double t_, length_, share_;
    DynamicSystem& system_;
    StageSlopes slopes_;
    std::span<double> x0_, u0_;
};

}  // namespace

SubstepCounts advance_by_runge_kutta4_parts(double h, std::int64_t parts, DynamicSystem& system)
{
    SubstepCounts counts;
    const std::int64_t most = 4 * parts;
    std::int64_t done = 0;  // of `parts`
    while (done < parts && !system.interrupted())
    {
        const double whole = static_cast<double>(parts), t = h * (static_cast<double>(done) / whole);
        PartOfStep part(t, h / whole, 1 / whole, system);
        part.find_slopes(), counts.evaluations += 4;
        if (part.is_too_long())
        {
            part.take_back(), counts.evaluations += 4, ++counts.refused;
            if (parts == most) break;
            parts *= 2, done *= 2;
            continue;
        }
        part.finish();
        ++done, ++counts.accepted;
    }
    counts.reached = done == parts ? h : h * (static_cast<double>(done) / static_cast<double>(parts));
    return counts;
}

void finish_by_runge_kutta4(double h, double from, std::int64_t parts, DynamicSystem& system)
{
    const double length = (h - from) / static_cast<double>(parts);
    for (std::int64_t k = 0; k < parts && !system.interrupted(); ++k)
    {
        PartOfStep part(from + static_cast<double>(k) * length, length, length / h, system);
        part.find_slopes();
        part.finish();
    }
}

}  // namespace plab::solvers
