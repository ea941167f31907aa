#include "soft_step.h"

#include <algorithm>
#include <cmath>

#include "plab/rotation.h"
#include "sequential.h"

namespace plab::managers
{
namespace
{

struct Softness
{
    double bias_rate = 0, mass_scale = 1, impulse_scale = 0;
};

Softness soften(double hertz, double damping_ratio, double h)
{
    constexpr double kTwoPi = 6.283185307179586;
    if (hertz <= 0) return {};
    const double omega = kTwoPi * hertz, a = 2 * damping_ratio + h * omega, c = h * omega * a;
    return {omega / a, c / (1 + c), 1 / (1 + c)};
}

class SoftIsland
{
public:
    SoftIsland(Island& island, Bodies& bodies, Shafts& shafts, const SoftChoices& choices, SoftMemory& memory)
        : island_(island),
          bodies_(bodies),
          shafts_(shafts),
          choices_(choices),
          memory_(memory),
          problem_(memory.step.problem),
          h_(island.h / choices.substeps),
          rate_(1 / h_),
          soft_(soften(std::min(choices.hertz, 0.25 * rate_), choices.damping_ratio, h_)),
          against_fixed_(soften(std::min(2 * choices.hertz, 0.25 * rate_), choices.damping_ratio, h_))
    {
    }

    Verdict run()
    {
        start();
        Verdict out;
        for (int s = 0; s < choices_.substeps && !island_.interrupted(); ++s)
        {
            kick();
            most_ = kinetic_energy_without(problem_);
            sweep_points(true), sweep_lines(true);
            write();
            if (bounces_) count_travel();
            move();
            for (int i = 0; i < choices_.relax_iterations; ++i) sweep_lines(false), sweep_points(false);
            write();
            out.iterations += 1 + choices_.relax_iterations + remove_gained_energy();
            gather();
        }
        give_back();
        finish(out);
        return out;
    }

private:
    void start();
    void kick();
    void write();
    void move();
    bool gains() const;
    int step_hard();
    bool scale_down();
    void sweep_points(bool soft);
    void sweep_lines(bool soft);
    int remove_gained_energy();
    void gather();
    void note_kicks(bool before);
    void count_travel();
    void note_limits();
    double bounce(double share);
    void bounce_points(double share);
    void bounce_with_limits(double share);
    void give_back();
    void finish(Verdict& out);

    Island& island_;
    Bodies& bodies_;
    Shafts& shafts_;
    const SoftChoices& choices_;
    SoftMemory& memory_;
    Problem& problem_;
    double h_, rate_;
    Softness soft_, against_fixed_;
    bool bounces_ = false;
    bool applied_ = false;  ///< the impulses have been applied in an earlier sub-step of this step
    double most_ = 0;       ///< J: kinetic energy after the sub-step's kick, which contacts must not exceed
    bool limits_bounce_ = false;
    double allowed_ = 0;  ///< J: kinetic energy at the start of the step plus the work of the forces since
};

void SoftIsland::start()
{
    problem_.load(island_, bodies_, shafts_);
    problem_.scale_impulses(1.0 / choices_.substeps);
    memory_.depth.clear();
    for (std::size_t i = 0; i < problem_.points.size(); ++i) memory_.depth.push_back(island_.contacts[i].depth);
    memory_.greatest.assign(problem_.points.size(), 0.0);
    memory_.sum.assign(problem_.points.size(), Vec3{});
    memory_.line_sum.assign(problem_.lines.size(), 0.0);
    bounces_ =
        std::any_of(island_.contacts.begin(), island_.contacts.end(), [](const Contact& c) { return c.approach > 0 && c.restitution > 0; });
    note_limits();
    bounces_ = bounces_ || limits_bounce_;
    if (!bounces_) return;
    problem_.read_speeds(bodies_, shafts_);
    allowed_ = kinetic_energy_without(problem_);
    memory_.kicks.resize(problem_.anchors.size());
}

/// Notes the closing speeds at limits with restitution.
void SoftIsland::note_limits()
{
    memory_.line_closing.assign(problem_.lines.size(), 0.0), memory_.line_greatest.assign(problem_.lines.size(), 0.0);
    const auto may_bounce = [&](const Line& line)
    { return line.count > 0 && island_.rows[line.row].kind == RowKind::OneSided && island_.rows[line.row].restitution > 0; };
    if (std::none_of(problem_.lines.begin(), problem_.lines.end(), may_bounce)) return;
    problem_.read_speeds(bodies_, shafts_);
    for (std::size_t i = 0; i < problem_.lines.size(); ++i)
    {
        const Line& line = problem_.lines[i];
        if (!may_bounce(line)) continue;
        double rate = line.given;  // without impulses: those stored in the problem are an estimate for the sub-step
        for (std::uint32_t k = 0; k < line.count; ++k)
            rate += dot(line.linear[k], problem_.anchors[line.mover[k]].v) + dot(line.angular[k], problem_.anchors[line.mover[k]].w);
        memory_.line_closing[i] = std::max(0.0, island_.rows[line.row].rate - rate);
        limits_bounce_ = limits_bounce_ || memory_.line_closing[i] > 0;
    }
}

/// Called before and after a kick: notes the change of the momenta.
void SoftIsland::note_kicks(bool before)
{
    problem_.read_speeds(bodies_, shafts_);
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
void SoftIsland::count_travel()
{
    for (std::size_t i = 0; i < problem_.movers.size(); ++i)
        allowed_ += dot(memory_.kicks[i].push, problem_.movers[i].v) + dot(memory_.kicks[i].turn, problem_.movers[i].w);
}

void SoftIsland::kick()
{
    if (bounces_) note_kicks(true);
    island_.motion->kick(h_);
    if (!island_.rows.empty()) island_.motion->refresh_rows();
    problem_.read_speeds(bodies_, shafts_);
    if (bounces_) note_kicks(false);
    // The impulse that stopped an impact is no estimate for the impulses after it.
    bool changes = !applied_ || !problem_.lines.empty();  // targets limit the impulses of lines
    for (std::size_t i = 0; i < problem_.points.size(); ++i)
        if (island_.contacts[i].approach > 0 && problem_.points[i].impulse != Vec3{}) problem_.points[i].impulse = {}, changes = true;
    set_targets(problem_, island_, h_, 0);
    if (changes)
        problem_.apply_impulses();
    else
        problem_.apply_same_impulses();
    applied_ = true;
}

void SoftIsland::write()
{
    problem_.apply_impulses();
    problem_.write_speeds(bodies_, shafts_);
}

/// Contact points stay where they were found, relative to the centres of mass: a round body that has turned touches with another
/// of its points, and a point that turned with the body would appear to rise.
void SoftIsland::move()
{
    memory_.depth_before = memory_.depth;
    memory_.moved_with.clear(), memory_.lines_moved_with.clear();
    for (const Point& p : problem_.points) memory_.moved_with.push_back(p.impulse);
    for (const Line& line : problem_.lines) memory_.lines_moved_with.push_back(line.impulse);
    for (std::size_t i = 0; i < problem_.points.size(); ++i) memory_.depth[i] -= h_ * problem_.relative_velocity(problem_.points[i]).z;
    island_.motion->move(h_);
    problem_.turn_with(bodies_);
    problem_.apply_same_impulses();  // those that write() applied
}

void SoftIsland::sweep_points(bool soft)
{
    for (std::size_t i = 0; i < problem_.points.size(); ++i)
    {
        Point& p = problem_.points[i];
        if (!(p.K(2, 2) > 0)) continue;
        const Softness& how = p.a == kNoIndex || p.b == kNoIndex ? against_fixed_ : soft_;
        const double depth = memory_.depth[i];
        double bias = 0, mass_scale = 1, impulse_scale = 0;
        if (depth < 0)
            bias = -depth * rate_;
        else if (soft)
            bias = -std::min(how.bias_rate * depth, choices_.push_speed), mass_scale = how.mass_scale, impulse_scale = how.impulse_scale;
        const Vec3 u = problem_.relative_velocity(p), before = p.impulse;
        p.impulse.z = std::max(0.0, before.z - mass_scale * (u.z + bias) / p.K(2, 2) - impulse_scale * before.z);
        if (p.frictional())
        {
            const double change = p.impulse.z - before.z, k = 1 / p.slip_mobility;
            const Vec3 held = within_disc({before.x - k * (u.x + p.K(0, 2) * change), before.y - k * (u.y + p.K(1, 2) * change), 0},
                                          p.friction * p.impulse.z);
            p.impulse.x = held.x, p.impulse.y = held.y;
        }
        memory_.greatest[i] = std::max(memory_.greatest[i], p.impulse.z);
        if (p.impulse != before) problem_.push(p, p.impulse - before);
    }
}

void SoftIsland::sweep_lines(bool soft)
{
    for (std::size_t i = 0; i < problem_.lines.size(); ++i)
    {
        Line& line = problem_.lines[i];
        if (line.count == 0) continue;
        const ConstraintRow& row = island_.rows[line.row];
        const bool pulled = soft && row.kind != RowKind::Rate && (row.kind == RowKind::Equality || row.error < 0);
        const double bias = pulled ? soft_.bias_rate * row.error : 0.0, before = line.impulse;
        const double share = pulled ? soft_.mass_scale : 1.0, leak = pulled ? soft_.impulse_scale : 0.0;
        line.impulse =
            std::clamp(before - share * (problem_.rate(line) - line.target + bias) / line.mobility - leak * before, line.least, line.most);
        problem_.push(line, line.impulse - before);
        memory_.line_greatest[i] = std::max(memory_.line_greatest[i], line.impulse);
    }
}

void SoftIsland::gather()
{
    for (std::size_t i = 0; i < problem_.points.size(); ++i) memory_.sum[i] += problem_.points[i].impulse;
    for (std::size_t i = 0; i < problem_.lines.size(); ++i) memory_.line_sum[i] += problem_.lines[i].impulse;
}

bool SoftIsland::gains() const { return !is_driven(problem_) && kinetic_energy(problem_) > most_ * (1 + 1e-9); }

/// Scales the impulses to remove a gain of energy. If v0 are the velocities without impulses and dv their change, the fraction s
/// of the impulses gives the energy 1/2 |v0 + s dv|^2. Keeps the largest s without a gain. Returns false if even s = 0 has too
/// much energy, as the bodies have turned since the kick.
bool SoftIsland::scale_down()
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
    problem_.scale_impulses(std::min(share, 1.0));
    problem_.apply_impulses();
    return true;
}

/// Repeats the sub-step from its start without position correction: sweeps that only remove energy, and a motion that conserves
/// it.
int SoftIsland::step_hard()
{
    constexpr int kSweeps = 4;
    // Moves back with the velocities of the move.
    for (std::size_t i = 0; i < problem_.points.size(); ++i) problem_.points[i].impulse = memory_.moved_with[i];
    for (std::size_t i = 0; i < problem_.lines.size(); ++i) problem_.lines[i].impulse = memory_.lines_moved_with[i];
    write();
    island_.motion->move(-h_);
    memory_.depth = memory_.depth_before;
    problem_.turn_with(bodies_);
    problem_.clear_impulses();
    problem_.apply_impulses();
    for (std::size_t i = 0; i < problem_.points.size(); ++i) problem_.points[i].least = std::min(0.0, memory_.depth[i]) * rate_;
    const Swept done = sweep(problem_, {kSweeps, 0, 1});
    problem_.apply_impulses();
    if (gains() && !scale_down()) problem_.clear_impulses();
    write();
    move();
    return done.sweeps;
}

/// If the sub-step has gained energy: hard sweeps, then all impulses are scaled down until the gain is gone; if that is
/// impossible, the sub-step is repeated.
int SoftIsland::remove_gained_energy()
{
    constexpr int kSweeps = 2;
    if (!gains()) return 0;
    for (std::size_t i = 0; i < problem_.points.size(); ++i) problem_.points[i].least = std::min(0.0, memory_.depth[i]) * rate_;
    const Swept done = sweep(problem_, {kSweeps, 0, 1});
    problem_.apply_impulses();
    if (gains() && !scale_down()) return done.sweeps + step_hard();
    write();
    return done.sweeps;
}

/// Sets the impulses that return `share` of the restitution; returns the kinetic energy with them, J.
double SoftIsland::bounce(double share)
{
    problem_.clear_impulses();
    problem_.apply_impulses();
    if (limits_bounce_)
        bounce_with_limits(share);
    else
        bounce_points(share);
    return kinetic_energy(problem_);
}

/// Uses sweeps, as joints pass on the impulse that a limit returns.
void SoftIsland::bounce_with_limits(double share)
{
    constexpr int kMostSweeps = 1000;
    double fastest = 0;
    for (const double closing : memory_.line_closing) fastest = std::max(fastest, closing);
    for (std::size_t i = 0; i < problem_.points.size(); ++i)
    {
        Point& p = problem_.points[i];
        const Contact& c = island_.contacts[i];
        p.friction = 0;
        p.least = !(memory_.greatest[i] > 0) ? kFar : share * c.restitution * std::max(0.0, c.approach);
    }
    for (std::size_t i = 0; i < problem_.lines.size(); ++i)
    {
        Line& line = problem_.lines[i];
        const ConstraintRow& row = island_.rows[line.row];
        const bool one_sided = row.kind == RowKind::OneSided, pressed = memory_.line_greatest[i] > 0;
        line.target = row.rate + (one_sided ? share * row.restitution * memory_.line_closing[i] : 0.0);
        line.least = one_sided ? 0.0 : -HUGE_VAL, line.most = HUGE_VAL;
        // Motors have no impulse at an instant; nor has a limit that was not reached.
        if (row.kind == RowKind::Rate || (one_sided && !pressed)) line.least = line.most = 0;
    }
    (void)sweep(problem_, {kMostSweeps, 1e-6 * fastest, 1});
}

void SoftIsland::bounce_points(double share)
{
    for (std::size_t i = 0; i < problem_.points.size(); ++i)
    {
        Point& p = problem_.points[i];
        const Contact& c = island_.contacts[i];
        if (!(c.approach > 0) || !(memory_.greatest[i] > 0) || c.restitution == 0) continue;
        const double missing = share * c.restitution * c.approach - problem_.relative_velocity(p).z;
        if (missing <= 0) continue;
        p.impulse.z = missing / p.K(2, 2);
        problem_.push(p, {0, 0, p.impulse.z});
    }
}

void SoftIsland::give_back()
{
    constexpr int kHalvings = 24;
    problem_.read_speeds(bodies_, shafts_);
    problem_.clear_impulses();
    problem_.apply_impulses();
    if (!bounces_) return;
    const double most = std::max(allowed_, kinetic_energy_without(problem_));
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
    problem_.apply_impulses();
    problem_.write_speeds(bodies_, shafts_);
}

void SoftIsland::finish(Verdict& out)
{
    for (std::size_t i = 0; i < problem_.points.size(); ++i)
    {
        const Point& p = problem_.points[i];
        Contact& c = island_.contacts[i];
        const Vec3 u = problem_.relative_velocity(p), j = memory_.sum[i] + p.impulse;  // p holds the impulse of restitution

        c.impulse = p.t1 * j.x + p.t2 * j.y + p.n * j.z;
        c.slip = std::hypot(u.x, u.y);
        if (p.impulse.z == 0 && p.K(2, 2) > 0 && memory_.depth[i] >= 0) out.residual = std::max(out.residual, -u.z);
    }
    for (std::size_t i = 0; i < problem_.lines.size(); ++i)
    {
        const Line& line = problem_.lines[i];
        island_.rows[line.row].impulse = memory_.line_sum[i] + line.impulse;  // line.impulse is that of restitution
        if (line.count > 0 && island_.rows[line.row].kind != RowKind::OneSided)
            out.residual = std::max(out.residual, std::fabs(problem_.rate(line) - island_.rows[line.row].rate));
    }
    out.converged = out.residual <= choices_.tolerance;
}

}  // namespace

Verdict advance_softly(Island& island, Bodies& bodies, Shafts& shafts, const SoftChoices& choices, SoftMemory& memory)
{
    return SoftIsland(island, bodies, shafts, choices, memory).run();
}

}  // namespace plab::managers
