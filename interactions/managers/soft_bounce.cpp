// Restitution of a step with soft contacts: what the impacts of the step give back after the last sub-step.
#include <algorithm>
#include <cmath>

#include "sequential.h"
#include "soft_island.h"

namespace plab::managers
{

/// Notes the closing speeds at limits with restitution.
template <int W>
void SoftIsland<W>::note_limits()
{
    memory_.line_closing.assign(problem_.lines.size(), 0.0), memory_.line_greatest.assign(problem_.lines.size(), 0.0);
    const auto may_bounce = [&](const Line& line)
    { return line.count > 0 && problem_.row_of(line).kind == RowKind::OneSided && problem_.row_of(line).restitution > 0; };
    if (std::none_of(problem_.lines.begin(), problem_.lines.end(), may_bounce)) return;
    problem_.read_speeds(bodies_, shafts_);
    for (std::size_t i = 0; i < problem_.lines.size(); ++i)
    {
        const Line& line = problem_.lines[i];
        if (!may_bounce(line)) continue;
        double rate = line.given;  // without impulses: those stored in the problem are an estimate for the sub-step
        for (std::uint32_t k = 0; k < line.count; ++k)
            rate += dot(line.linear[k], problem_.anchors[line.mover[k]].v) + dot(line.angular[k], problem_.anchors[line.mover[k]].w);
        memory_.line_closing[i] = std::max(0.0, problem_.row_of(line).rate - rate);
        limits_bounce_ = limits_bounce_ || memory_.line_closing[i] > 0;
    }
}

/// Called before a kick, and after it when the speeds have been read: notes the change of the momenta.
template <int W>
void SoftIsland<W>::note_kicks(bool before)
{
    if (before) problem_.read_speeds(bodies_, shafts_);
    for (std::size_t i = 0; i < problem_.anchors.size(); ++i)
    {
        const Anchor& m = problem_.anchors[i];
        SoftMemory::Kick& k = memory_.kicks[i];
        const SoftMemory::Kick now{m.v * m.mass, m.inertia * m.w};
        if (before)
            k = now;
        else
            k = {now.push - k.push, now.turn - k.turn};
    }
}

/// Forces do work along the path that the bodies take, including the part due to position correction.
template <int W>
void SoftIsland<W>::count_travel()
{
    for (std::size_t i = 0; i < problem_.movers.size(); ++i)
        allowed_ += dot(memory_.kicks[i].push, problem_.movers[i].v) + dot(memory_.kicks[i].turn, problem_.movers[i].w);
}

/// Sets the impulses that return `share` of the restitution; returns the kinetic energy with them, J.
template <int W>
double SoftIsland<W>::bounce(double share)
{
    clear_impulses();
    apply();
    for (std::size_t i = 0; i < contacts_.size(); ++i)
    {
        const Contact& c = island_.contacts[i];
        const auto place = contacts_.place(i);
        const bool pressed = lane(soft_[place.point].greatest, place.lane) > 0, meets = c.approach > 0 && c.restitution > 0;
        const double returned = share * c.restitution * std::max(0.0, c.approach);
        contacts_.set_least(i, pressed && (meets || limits_bounce_) ? returned : kFar);
    }
    if (limits_bounce_)
        bounce_with_limits(share);
    else
        (void)sweep_hard(contacts_, std::span<Mover>(problem_.movers), {.measures = false, .friction_scale = 0});
    return kinetic_energy(problem_);
}

/// Uses sweeps, as joints pass on the impulse that a limit returns.
template <int W>
void SoftIsland<W>::bounce_with_limits(double share)
{
    constexpr int kMostSweeps = 1000;
    double fastest = 0;
    for (const double closing : memory_.line_closing) fastest = std::max(fastest, closing);
    for (std::size_t i = 0; i < problem_.lines.size(); ++i)
    {
        Line& line = problem_.lines[i];
        const ConstraintRow& row = problem_.row_of(line);
        const bool one_sided = row.kind == RowKind::OneSided, pressed = memory_.line_greatest[i] > 0;
        line.target = row.rate + (one_sided ? share * row.restitution * memory_.line_closing[i] : 0.0);
        line.least = one_sided ? 0.0 : -HUGE_VAL, line.most = HUGE_VAL;
        // Nor has a limit an impulse that was not reached.
        if (!acts_at_once(row) || (one_sided && !pressed)) line.least = line.most = 0;
    }
    (void)sweep(problem_, contacts_, {kMostSweeps, 1e-6 * fastest, 1, 0});
}

/// Returns all of the restitution, or else the largest share of it, to 2^-24, that the energy allows.
template <int W>
void SoftIsland<W>::give_back()
{
    constexpr int kHalvings = 24;
    // Relative. An elastic impact ends with the energy that it began with, but the sums differ by rounding, and a share would be missing.
    constexpr double kSameEnergy = 0x1p-46;
    if (!bounces_) return;
    problem_.let_resist(false);
    gather_and_clear(contacts_, std::span<SoftPoint<W>>(soft_));
    for (Line& line : problem_.lines) line.impulse = 0;
    problem_.clear_sums();
    read_given();
    const double most = std::max(allowed_, problem_.read_speeds_and_apply(bodies_, shafts_)) * (1 + kSameEnergy);
    double low = 0, high = 1;
    if (bounce(1) > most)
    {
        for (int i = 0; i < kHalvings; ++i)
        {
            const double share = 0.5 * (low + high);
            (bounce(share) > most ? high : low) = share;
        }
        (void)bounce(low);
    }
    write();
}

template void SoftIsland<1>::note_limits();
template void SoftIsland<4>::note_limits();
template void SoftIsland<1>::note_kicks(bool);
template void SoftIsland<4>::note_kicks(bool);
template void SoftIsland<1>::count_travel();
template void SoftIsland<4>::count_travel();
template void SoftIsland<1>::give_back();
template void SoftIsland<4>::give_back();

}  // namespace plab::managers
