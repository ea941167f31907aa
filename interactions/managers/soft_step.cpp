#include "soft_step.h"

#include <algorithm>
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
        if (holds_)
            hold_rows(true, false);
        else
            sweep_lines(true);
        write();
        if (bounces_) count_travel();
        move();
        relax();
        write();
        out.iterations += 1 + choices_.relax_iterations + remove_gained_energy();
        for (std::size_t i = 0; i < problem_.lines.size(); ++i) memory_.line_sum[i] += problem_.lines[i].impulse;
    }
    give_back();
    if (bounces_)
        for (std::size_t i = 0; i < problem_.lines.size(); ++i) memory_.line_sum[i] += problem_.lines[i].impulse;
    problem_.refresh_spins(bodies_);
    finish(out);
    return out;
}

template <int W>
void SoftIsland<W>::start()
{
    problem_.load_movers(island_, bodies_, shafts_);
    for (Line& line : problem_.lines) line.impulse *= 1.0 / choices_.substeps;
    load_points();
    problem_.forget(island_);
    sort_marks();
    make_room(memory_.moved, problem_.movers.size());
    memory_.moved.resize(problem_.movers.size());
    memory_.line_sum.assign(problem_.lines.size(), 0.0);
    holds_ = holds_rows();
    note_limits();
    bounces_ = bounces_ || limits_bounce_;
    if (!bounces_) return;
    problem_.read_speeds(bodies_, shafts_);
    allowed_ = kinetic_energy_without(problem_);
    make_room(memory_.kicks, problem_.anchors.size());
    memory_.kicks.resize(problem_.anchors.size());
}

template <int W>
void SoftIsland<W>::load_points()
{
    // Many islands share this memory, and the number of points varies: there is room for the largest small island at once.
    if constexpr (W == 1)
    {
        contacts_.reserve(kSweptInOrder, problem_.movers.size());
        soft_.reserve(kSweptInOrder), memory_.marks.reserve(kSweptInOrder);
        memory_.meeting.reserve(kSweptInOrder), memory_.carried.reserve(kSweptInOrder);
    }
    contacts_.begin(problem_.workers);
    const Contact* last = nullptr;
    std::uint32_t a = kNoIndex, b = kNoIndex;
    for (const Contact& c : island_.contacts)
    {
        if (!last || last->a != c.a || last->b != c.b) a = problem_.mover_of(c.a), b = problem_.mover_of(c.b), last = &c;
        contacts_.add(a, b, c.normal);
    }
    contacts_.arrange(problem_.movers.size());
    make_room(soft_, contacts_.points().size()), make_room(memory_.marks, contacts_.size());
    soft_.resize(contacts_.points().size()), memory_.marks.resize(contacts_.size());
    const std::span<const Mover> movers(problem_.movers);
    contacts_.fill([&](Packet<W>& packet, std::uint32_t first, std::uint32_t count, int l) { load_pair(packet, first, count, l); },
                   [&](std::uint32_t contact) { fetch(island_.contacts[contact], false); },
                   [&](std::size_t begin, std::size_t end) { set_mobility(contacts_, movers, begin, end); });
}

template <int W>
void SoftIsland<W>::load_pair(Packet<W>& packet, std::uint32_t first, std::uint32_t count, int l)
{
    const auto side = static_cast<std::size_t>(l);
    const bool moves_a = packet.a[side] != kNoIndex, moves_b = packet.b[side] != kNoIndex;
    const double share = moves_a || moves_b ? 1.0 / choices_.substeps : 0.0;
    const Vec3 n = island_.contacts[first].normal, t1 = any_perpendicular(n), t2 = cross(n, t1);
    set_lane(packet.n, l, n), set_lane(packet.t1, l, t1);
    for (std::uint32_t k = 0; k < count; ++k)
    {
        const Contact& c = island_.contacts[first + k];
        PacketPoint<W>& p = contacts_.points()[packet.first + k];
        SoftPoint<W>& soft = soft_[packet.first + k];
        if (l == 0) soft = {};
        // The normal may have turned since, and the friction may have changed: the initial impulse is projected onto the cone.
        Vec3 j{dot(t1, c.impulse), dot(t2, c.impulse), std::max(0.0, dot(n, c.impulse))};
        j = within_disc(j, c.friction * j.z) * share;
        set_lane(p.r_a, l, c.point - bodies_.position[c.a.index]), set_lane(p.r_b, l, c.point - bodies_.position[c.b.index]);
        set_lane(p.impulse, l, j), set_lane(p.friction, l, c.friction), set_lane(p.least, l, 0);
        set_lane(soft.depth, l, c.depth);
        memory_.marks[first + k] = marks_of(c, moves_a, moves_b);
    }
}

template <int W>
std::uint8_t SoftIsland<W>::marks_of(const Contact& c, bool moves_a, bool moves_b) const
{
    const auto is_carried = [&](bool moves, Ref r) { return !moves && bodies_.motion[r.index] != Motion::Static; };
    int out = 0;
    if (c.approach > 0) out |= c.restitution > 0 ? SoftMemory::kMeets | SoftMemory::kBounces : SoftMemory::kMeets;
    if (c.turning > 0) out |= SoftMemory::kTurns;
    if (is_carried(moves_a, c.a) || is_carried(moves_b, c.b)) out |= SoftMemory::kCarried;
    return static_cast<std::uint8_t>(out);
}

template <int W>
void SoftIsland<W>::sort_marks()
{
    memory_.meeting.clear(), memory_.carried.clear();
    for (std::uint32_t i = 0; i < memory_.marks.size(); ++i)
    {
        const std::uint8_t marks = memory_.marks[i];
        if (marks == 0) continue;
        if ((marks & SoftMemory::kMeets) != 0) memory_.meeting.push_back(i);
        if ((marks & SoftMemory::kCarried) != 0) memory_.carried.push_back(i);
        driven_ = driven_ || (marks & SoftMemory::kTurns) != 0;
        bounces_ = bounces_ || (marks & SoftMemory::kBounces) != 0;
    }
}

/// The velocities that bodies contribute which are not movers.
template <int W>
void SoftIsland<W>::read_given()
{
    problem_.read_given(bodies_, shafts_);  // of the rows
    for (const std::uint32_t i : memory_.carried)
    {
        const Contact& c = island_.contacts[i];
        const auto place = contacts_.place(i);
        const Packet<W>& packet = contacts_.packets()[place.packet];
        const auto side = static_cast<std::size_t>(place.lane);
        Vec3 given;
        if (packet.b[side] == kNoIndex && bodies_.motion[c.b.index] != Motion::Static) given += bodies_.velocity_at(c.b.index, c.point);
        if (packet.a[side] == kNoIndex && bodies_.motion[c.a.index] != Motion::Static) given -= bodies_.velocity_at(c.a.index, c.point);
        const Vec3 n = lane(packet.n, place.lane), t1 = lane(packet.t1, place.lane);
        contacts_.set_given(i, {dot(t1, given), dot(cross(n, t1), given), dot(n, given)});
        driven_ = driven_ || given != Vec3{};
    }
}

template <int W>
void SoftIsland<W>::kick()
{
    if (bounces_) note_kicks(true);
    managers::kick(problem_, island_, bodies_, shafts_, h_);
    if (!island_.rows.empty()) island_.motion->refresh_rows(), problem_.turn_lines();
    read_given();
    meet();
    set_line_targets(problem_, island_, h_, Moving::ByEnd);
    if (!applied_ || !problem_.lines.empty()) sum();  // targets limit the impulses of lines
    applied_ = true;
    most_ = problem_.read_speeds_and_apply(bodies_, shafts_);
    problem_.aim_resistances(1.0 / choices_.substeps);
    bound_resistances();
    if (bounces_) note_kicks(false);
    hold_rows(true, true);
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
/// of its points, and a point that turned with the body would appear to rise. The packets have to follow (follow_move).
template <int W>
void SoftIsland<W>::move()
{
    note_move(problem_, island_, h_, Moving::ByEnd);
    island_.motion->move(h_);
    // Inertias of the new attitudes, and the velocities with the impulses that write() applied.
    problem_.turn_movers_and_apply(bodies_, h_, memory_.moved);
}

/// The sweeps after a move.
template <int W>
void SoftIsland<W>::relax()
{
    const std::span<SoftPoint<W>> soft(soft_);
    const std::span<Mover> movers(problem_.movers);
    if (choices_.relax_iterations == 0) follow_move(contacts_, std::span<const Mover>(movers), moved(h_), soft);
    for (int i = 0; i < choices_.relax_iterations; ++i)
    {
        if (i == 0) hold_rows(false, false);
        if (i > 0 || !holds_) sweep_lines(false);
        if (i == 0)
            follow_move_and_sweep(contacts_, movers, moved(h_), soft);
        else
            (void)sweep_hard(contacts_, movers, {.measures = false});
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
    const std::span<SoftPoint<W>> soft(soft_);
    const std::span<const Mover> movers(problem_.movers);
    // Moves back with the impulses of the move.
    problem_.apply_moved(memory_.moved);
    problem_.write_speeds(bodies_, shafts_);
    note_move(problem_, island_, -h_, Moving::ByEnd);
    island_.motion->move(-h_);
    problem_.turn_movers_back(bodies_, -h_);
    follow_move(contacts_, movers, moved(-h_), soft);
    clear_impulses();
    apply();
    const Swept done = sweep(problem_, contacts_, {kSweeps});
    apply();
    if (gains() && !scale_down()) clear_impulses(), apply();
    write();
    move();
    follow_move(contacts_, movers, moved(h_), soft);
    return done.sweeps;
}

/// If the sub-step has gained energy: hard sweeps, then all impulses are scaled down until the gain is gone; if that is
/// impossible, the sub-step is repeated.
template <int W>
int SoftIsland<W>::remove_gained_energy()
{
    // In an island of few contacts two sweeps cost little, and mostly leave nothing to scale down.
    constexpr int kSweeps = W == 1 ? 2 : 1;
    if (!gains(energy_)) return 0;
    const Swept done = sweep(problem_, contacts_, {kSweeps});  // with the targets that move() has set
    if (gains())
    {
        apply();
        if (gains() && !scale_down()) return done.sweeps + step_hard();
    }
    write();
    return done.sweeps;
}

template <int W>
void SoftIsland<W>::finish(Verdict& out)
{
    const double closing = report_contacts(contacts_, std::span<Mover>(problem_.movers), std::span<const SoftPoint<W>>(soft_), bounces_,
                                           island_.h, std::span<Contact>(island_.contacts));
    out.residual = std::max(out.residual, closing);
    for (std::size_t i = 0; i < problem_.lines.size(); ++i)
    {
        const Line& line = problem_.lines[i];
        if (line.resists()) break;
        island_.rows[line.row].impulse = memory_.line_sum[i];
        if (line.count > 0 && (island_.rows[line.row].kind == RowKind::Equality || island_.rows[line.row].kind == RowKind::Rate))
            out.residual = std::max(out.residual, std::fabs(problem_.rate(line) - island_.rows[line.row].rate));
    }
    out.converged = out.residual <= choices_.tolerance;
}

// What restitution needs (soft_bounce.cpp).
template void SoftIsland<1>::read_given();
template void SoftIsland<4>::read_given();
template void SoftIsland<1>::clear_impulses();
template void SoftIsland<4>::clear_impulses();
template void SoftIsland<1>::apply();
template void SoftIsland<4>::apply();
template void SoftIsland<1>::write();
template void SoftIsland<4>::write();

Verdict advance_softly(Island& island, Bodies& bodies, Shafts& shafts, const SoftChoices& choices, SoftMemory& memory)
{
    Problem& problem = memory.step.problem;
    if (island.contacts.size() > kSweptInOrder)
        return SoftIsland<4>(island, bodies, shafts, choices, memory, problem.fours, memory.fours).run();
    return SoftIsland<1>(island, bodies, shafts, choices, memory, problem.single, memory.single).run();
}

}  // namespace plab::managers
