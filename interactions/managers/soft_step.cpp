#include "soft_step.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "sequential.h"

namespace plab::managers
{
namespace
{

Softness soften(double hertz, double damping_ratio, double h)
{
    constexpr double kTwoPi = 6.283185307179586;
    if (hertz <= 0) return {};
    const double omega = kTwoPi * hertz, a = 2 * damping_ratio + h * omega, c = h * omega * a;
    return {omega / a, c / (1 + c), 1 / (1 + c)};
}

}  // namespace

template <int W>
SoftIsland<W>::SoftIsland(Island& island, Bodies& bodies, Shafts& shafts, const SoftChoices& choices, SoftMemory& memory,
                          PacketList<W>& contacts, std::vector<SoftPoint<W>>& soft)
    : island_(island),
      bodies_(bodies),
      shafts_(shafts),
      choices_(choices),
      memory_(memory),
      problem_(memory.step.problem),
      contacts_(contacts),
      soft_(soft),
      h_(island.h / choices.substeps),
      sweep_{soften(std::min(choices.hertz, 0.25 / h_), choices.damping_ratio, h_),
             soften(std::min(2 * choices.hertz, 0.25 / h_), choices.damping_ratio, h_), choices.push_speed, 1 / h_}
{
}

template <int W>
Verdict SoftIsland<W>::run()
{
    start();
    Verdict out;
    for (int s = 0; s < choices_.substeps && !island_.interrupted(); ++s)
    {
        kick();
        sweep_.gathers = s > 0;
        sweep_soft(contacts_, std::span<Mover>(problem_.movers), sweep_, std::span<SoftPoint<W>>(soft_));
        sweep_lines(true);
        write();
        if (bounces_) count_travel();
        move();
        for (int i = 0; i < choices_.relax_iterations; ++i) relax();
        write();
        out.iterations += 1 + choices_.relax_iterations + remove_gained_energy();
        for (std::size_t i = 0; i < problem_.lines.size(); ++i) memory_.line_sum[i] += problem_.lines[i].impulse;
    }
    give_back();
    finish(out);
    return out;
}

template <int W>
void SoftIsland<W>::start()
{
    problem_.load_geometry(island_, bodies_, shafts_);
    problem_.scale_impulses(1.0 / choices_.substeps);
    contacts_.load(problem_.points, problem_.movers.size(), problem_.workers);
    set_mobility(contacts_, std::span<const Mover>(problem_.movers));
    soft_.resize(contacts_.points().size());
    contacts_.in_parts(
        [&](std::size_t begin, std::size_t end)
        {
            for (std::size_t k = begin; k < end; ++k)
            {
                const Packet<W>& packet = contacts_.packets()[k];
                for (std::uint32_t i = packet.first; i < packet.first + packet.count; ++i) soft_[i] = {};
                contacts_.visit(k, [&](std::uint32_t contact, std::uint32_t point, int l)
                                { set_lane(soft_[point].depth, l, island_.contacts[contact].depth); });
            }
        });
    memory_.meeting.clear();
    for (std::uint32_t i = 0; i < contacts_.size(); ++i)
    {
        const std::uint8_t marks = problem_.marks[i];
        if ((marks & Problem::kMeets) != 0) memory_.meeting.push_back(i);
        driven_ = driven_ || (marks & Problem::kTurns) != 0;
        bounces_ = bounces_ || (marks & Problem::kBounces) != 0;
    }
    memory_.line_sum.assign(problem_.lines.size(), 0.0);
    note_limits();
    bounces_ = bounces_ || limits_bounce_;
    if (!bounces_) return;
    problem_.read_speeds(bodies_, shafts_);
    allowed_ = kinetic_energy_without(problem_);
    memory_.kicks.resize(problem_.anchors.size());
}

template <int W>
void SoftIsland<W>::kick()
{
    if (bounces_) note_kicks(true);
    island_.motion->kick(h_);
    if (!island_.rows.empty()) island_.motion->refresh_rows();
    problem_.read_given(bodies_, shafts_);
    for (const std::uint32_t i : problem_.carried())
    {
        contacts_.set_given(i, problem_.points[i].given);
        driven_ = driven_ || problem_.points[i].given != Vec3{};
    }
    meet();
    set_line_targets(problem_, island_, h_);
    if (!applied_ || !problem_.lines.empty()) sum();  // targets limit the impulses of lines
    applied_ = true;
    most_ = problem_.read_speeds_and_apply(bodies_, shafts_);
    if (bounces_) note_kicks(false);
}

/// The impulse that stopped an impact is no estimate for the impulses after it.
template <int W>
void SoftIsland<W>::meet()
{
    bool changes = false;
    for (const std::uint32_t i : memory_.meeting)
    {
        const Vec3 j = contacts_.impulse(i);
        if (j == Vec3{}) continue;
        changes = true;
        const auto place = contacts_.place(i);
        SoftPoint<W>& soft = soft_[place.point];
        if (applied_)
        {
            set_lane(soft.sum.x, place.lane, lane(soft.sum.x, place.lane) + j.x);
            set_lane(soft.sum.y, place.lane, lane(soft.sum.y, place.lane) + j.y);
            set_lane(soft.sum.z, place.lane, lane(soft.sum.z, place.lane) + j.z);
            set_lane(soft.greatest, place.lane, std::max(lane(soft.greatest, place.lane), j.z));
        }
        contacts_.set_impulse(i, {});
    }
    applied_ = applied_ && !changes;
}

template <int W>
void SoftIsland<W>::sum()
{
    problem_.sum_line_impulses();
    sum_impulses(contacts_, std::span<Momentum>(problem_.sums));
}

template <int W>
void SoftIsland<W>::apply()
{
    sum();
    problem_.apply_same_impulses();
}

template <int W>
void SoftIsland<W>::write()
{
    energy_ = problem_.write_swept_speeds(bodies_, shafts_);
}

/// Contact points stay where they were found, relative to the centres of mass: a round body that has turned touches with another
/// of its points, and a point that turned with the body would appear to rise.
template <int W>
void SoftIsland<W>::move()
{
    memory_.lines_moved_with.clear();
    for (const Line& line : problem_.lines) memory_.lines_moved_with.push_back(line.impulse);
    advance_depths(contacts_, std::span<Mover>(problem_.movers), h_, std::span<SoftPoint<W>>(soft_));
    island_.motion->move(h_);
    turn();
}

/// After a move: the inertias and mobilities of the present attitudes, and the velocities with the impulses that write() applied.
template <int W>
void SoftIsland<W>::turn()
{
    problem_.turn_movers_and_apply(bodies_);
    refresh_mobility(contacts_, std::span<const Mover>(problem_.movers));
}

template <int W>
void SoftIsland<W>::relax()
{
    sweep_lines(false);
    (void)sweep_hard(contacts_, std::span<Mover>(problem_.movers), {.measures = false});
}

template <int W>
void SoftIsland<W>::sweep_lines(bool soft)
{
    for (std::size_t i = 0; i < problem_.lines.size(); ++i)
    {
        Line& line = problem_.lines[i];
        if (line.count == 0) continue;
        const ConstraintRow& row = island_.rows[line.row];
        const bool pulled = soft && row.kind != RowKind::Rate && (row.kind == RowKind::Equality || row.error < 0);
        const double bias = pulled ? sweep_.between.bias_rate * row.error : 0.0, before = line.impulse;
        const double share = pulled ? sweep_.between.mass_scale : 1.0, leak = pulled ? sweep_.between.impulse_scale : 0.0;
        line.impulse =
            std::clamp(before - share * (problem_.rate(line) - line.target + bias) / line.mobility - leak * before, line.least, line.most);
        problem_.push(line, line.impulse - before);
        memory_.line_greatest[i] = std::max(memory_.line_greatest[i], line.impulse);
    }
}

template <int W>
bool SoftIsland<W>::gains(double energy) const
{
    if (driven_ || std::any_of(problem_.lines.begin(), problem_.lines.end(), [](const Line& line) { return is_driven(line); }))
        return false;
    return energy > most_ * (1 + 1e-9);
}

template <int W>
bool SoftIsland<W>::gains() const
{
    return gains(kinetic_energy(problem_));
}

template <int W>
void SoftIsland<W>::clear_impulses()
{
    contacts_.clear_impulses();
    for (Line& line : problem_.lines) line.impulse = 0;
}

template <int W>
void SoftIsland<W>::scale_impulses(double share)
{
    contacts_.scale_impulses(share);
    for (Line& line : problem_.lines) line.impulse *= share;
}

/// Scales the impulses to remove a gain of energy. If v0 are the velocities without impulses and dv their change, the fraction s
/// of the impulses gives the energy 1/2 |v0 + s dv|^2. Keeps the largest s without a gain. Returns false if even s = 0 has too
/// much energy, as the bodies have turned since the kick.
template <int W>
bool SoftIsland<W>::scale_down()
{
    double linear = 0, square = 0;
    for (std::size_t i = 0; i < problem_.movers.size(); ++i)
    {
        const Anchor& m = problem_.anchors[i];
        const Vec3 dv = problem_.movers[i].v - m.v, dw = m.inertia * (problem_.movers[i].w - m.w);
        linear += m.mass * dot(m.v, dv) + dot(m.w, dw);
        square += m.mass * length_squared(dv) + dot(problem_.movers[i].w - m.w, dw);
    }
    const double room = most_ - kinetic_energy_without(problem_), discriminant = linear * linear + 2 * square * room;
    const double share = (-linear + std::sqrt(discriminant)) / square;
    if (!(share >= 0)) return false;
    scale_impulses(std::min(share, 1.0));
    apply();
    return true;
}

/// Repeats the sub-step from its start without position correction: sweeps that only remove energy, and a motion that conserves
/// it.
template <int W>
int SoftIsland<W>::step_hard()
{
    constexpr int kSweeps = 4;
    // Moves back with the velocities of the move.
    for (std::size_t i = 0; i < soft_.size(); ++i) contacts_.points()[i].impulse = soft_[i].moved_with;
    for (std::size_t i = 0; i < problem_.lines.size(); ++i) problem_.lines[i].impulse = memory_.lines_moved_with[i];
    apply();
    write();
    island_.motion->move(-h_);
    turn();
    for (std::size_t i = 0; i < soft_.size(); ++i)
    {
        soft_[i].depth = soft_[i].depth_before;
        contacts_.points()[i].least = smaller(soft_[i].depth, Lanes<W>{}) / h_;
    }
    clear_impulses();
    apply();
    const Swept done = sweep(problem_, contacts_, {kSweeps});
    apply();
    if (gains() && !scale_down()) clear_impulses(), apply();
    write();
    move();
    return done.sweeps;
}

/// If the sub-step has gained energy: hard sweeps, then all impulses are scaled down until the gain is gone; if that is
/// impossible, the sub-step is repeated.
template <int W>
int SoftIsland<W>::remove_gained_energy()
{
    constexpr int kSweeps = 2;
    if (!gains(energy_)) return 0;
    const Swept done = sweep(problem_, contacts_, {kSweeps});  // with the targets that move() has set
    apply();
    if (gains() && !scale_down()) return done.sweeps + step_hard();
    write();
    return done.sweeps;
}

/// Reports the impulse and the slip of a contact. Returns the speed at which its overlap grows although it may act, m/s.
template <int W>
double SoftIsland<W>::finish_point(std::size_t i)
{
    const Point& p = problem_.points[i];
    Contact& c = island_.contacts[i];
    const auto place = contacts_.place(i);
    const SoftPoint<W>& soft = soft_[place.point];
    const Vec3 u = problem_.relative_velocity(p), returned = contacts_.impulse(i);
    const Vec3 j = returned + Vec3{lane(soft.sum.x, place.lane), lane(soft.sum.y, place.lane), lane(soft.sum.z, place.lane)};
    c.impulse = to_world(p, j);
    c.slip = std::sqrt(u.x * u.x + u.y * u.y);
    return returned.z == 0 && p.mobile() && lane(soft.depth, place.lane) >= 0 ? -u.z : 0.0;
}

template <int W>
void SoftIsland<W>::finish(Verdict& out)
{
    std::atomic<double> residual{out.residual};
    for_parts(problem_.workers, problem_.points.size(), kMoverPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t i = begin; i < end; ++i) raise_to(residual, finish_point(i));
              });
    out.residual = residual;
    for (std::size_t i = 0; i < problem_.lines.size(); ++i)
    {
        const Line& line = problem_.lines[i];
        island_.rows[line.row].impulse = memory_.line_sum[i] + line.impulse;  // line.impulse is that of restitution
        if (line.count > 0 && island_.rows[line.row].kind != RowKind::OneSided)
            out.residual = std::max(out.residual, std::fabs(problem_.rate(line) - island_.rows[line.row].rate));
    }
    out.converged = out.residual <= choices_.tolerance;
}

Verdict advance_softly(Island& island, Bodies& bodies, Shafts& shafts, const SoftChoices& choices, SoftMemory& memory)
{
    Problem& problem = memory.step.problem;
    if (island.contacts.size() > kSweptInOrder)
        return SoftIsland<4>(island, bodies, shafts, choices, memory, problem.fours, memory.fours).run();
    return SoftIsland<1>(island, bodies, shafts, choices, memory, problem.single, memory.single).run();
}

}  // namespace plab::managers
