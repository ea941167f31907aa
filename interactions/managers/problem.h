/// An island in the form in which managers compute with it: movers, contact points and scalar rows, with impulses as unknowns.
///
/// Contact coordinates are (t1, t2, n), with n from a to b; u = velocity of b's point relative to a's, m/s:
///
///   u = E (v_b + w_b x r_b - v_a - w_a x r_a) + given,   du = K dj,   K = E (sum of (1/m) 1 - [r] I^-1 [r]) E^T
///
/// The impulse j (N s) acts on b, and -j on a. M and J are kept separate instead of forming the matrix J M^-1 J^T of all
/// contacts: no mass is ever divided by another one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "contact_packets.h"
#include "island_team.h"
#include "movers.h"
#include "plab/island.h"
#include "plab/tables.h"

namespace plab::managers
{

/// The points of an island with more of them are coloured and swept four pairs at a time (contact_packets.h).
inline constexpr std::size_t kSweptInOrder = 64;

/// A row of a joint, limit or motor: sum of linear . v + angular . w + given + compliance * impulse = target, or >= target if it is
/// one-sided. Only the change of a force is compliant (RowKind::ForceChange). Or what resists rolling or spinning between two bodies: then
/// its bounds follow the normal impulses of some points (Problem::bound_resistances).
struct Line
{
    std::uint32_t row = 0;    ///< index in Island::rows; kNoIndex: it resists rolling or spinning
    std::uint32_t count = 0;  ///< number of movers that take part
    std::array<std::uint32_t, ConstraintRow::kMostBlocks> mover{};
    std::array<Vec3, ConstraintRow::kMostBlocks> linear, angular;
    double given = 0;
    double turning = 0;     ///< m/s: what the rate at the end of the step differs from that with the Jacobian of its middle
    double mobility = 0;    ///< J M^-1 J^T
    double compliance = 0;  ///< like mobility, 1/kg or 1/(kg m^2)
    double target = 0;
    double before = 0;           ///< ForceChange: J v before the last kick
    double least = 0, most = 0;  ///< bounds of the impulse, N s or N m s
    double impulse = 0;
    double lever = 0;                              ///< m: of what resists, the bound per normal impulse
    std::uint32_t first_point = 0, end_point = 0;  ///< whose points these are
    bool a_moves = false;                          ///< likewise: the first mover is that of a

    bool resists() const { return row == kNoIndex; }
    /// Sets the bounds. Returns the change of a bound that an impulse reaches, unless it is rounding.
    double set_bound(double bound, double reached)
    {
        constexpr double kSame = 0x1p-40;
        const double change = std::fabs(bound - most);
        const bool matters = std::fabs(reached) >= std::min(most, bound) && change > kSame * bound;
        least = -bound, most = bound;
        return matters ? change : 0.0;
    }
    /// How much nearer to its target an impulse of 1 takes the row if nothing else acts, 1/kg or 1/(kg m^2).
    double admittance() const { return mobility + compliance; }
    /// The impulse per distance from the target of a row that acts with `kappa` times the stiffness that would close it alone if it had no
    /// compliance.
    double stiffness(double kappa) const { return compliance == 0 ? kappa / mobility : 1 / (mobility / kappa + compliance); }
};

/// Movers, or contact points, of which one thread computes so many at once: some microseconds of work.
inline constexpr std::size_t kMoverPart = 128;

class Problem
{
public:
    /// Sets geometry, masses and initial impulses (warm start). Targets and velocities are still to be set.
    void load(const Island& island, const Bodies& bodies, const Shafts& shafts);
    /// Sets memory apart for islands of this size without rows.
    void reserve(const IslandSize& size);
    /// Sets the movers and rows alone, without points. Until forget() is called, mover_of() knows the movers.
    void load_movers(const Island& island, const Bodies& bodies, const Shafts& shafts);
    /// The mover that a body or shaft is; kNoIndex: impulses do not move it.
    std::uint32_t mover_of(Ref participant) const;
    void forget(const Island& island);
    /// Updates inertias, mobilities and the spins without impulses to the present attitudes, after bodies have turned freely. Balls and
    /// cubes have the same inertia at all attitudes.
    /// Contact points stay where they were found, relative to the centres of mass: a round body that has turned touches with
    /// another of its points, so the point must not turn with it.
    void turn_with(const Bodies& bodies);
    /// Multiplies the inertias of all bodies, until they are set again. By powers of two this is exact.
    void weigh_turns(double factor);
    /// Puts contact points where they are in the middle of a step of h (s) at the present velocities, as far as their pivots are known; u
    /// becomes their velocity at its end. Otherwise a body that pivots or rolls would leave its path by O(h^2) in each step. With the
    /// lever r = f + arm of a body (f: to the point of it that the arm begins at) on the face of another one, o,
    ///
    ///   r_m = exp([w h / 2]) f + arm_m          n_m = exp([w_o h / 2]) n          r_o,m = r_o + (h / 2) passing
    ///   around = w x f + (arm_m - arm) / (h / 2)          passing = v + around - v_o
    ///   u = E (v + w x r_m - v_o - w_o x r_o,m + turning)          turning = (h / 2) (w x around - w_o x passing)
    ///
    /// With a move by the mean velocity this is the midpoint rule (Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), VII.1):
    /// turning is what the velocity of the point at the end differs from that with the levers of the middle, so u = 0 at both ends does
    /// no work. Along n_m, a point that slides on a face that tilts has (h / 2) (w_o x n) . u as well. Inertias are those of the middle,
    /// too, and w has changed by what free rotation does until the end (Anchor::swings). In a bowl w_o + (v_f x n) / R takes the place of
    /// w_o where normals turn, v_f the speed of f along the wall (Pivot::hollow). Where a step is cut at an end of sliding
    /// (slip_end.h), the levers stay those of the whole step.
    void put_pivots_midway(const Bodies& bodies, double h);
    /// The same for rows, which are those of the middle of the step by now: J = J_m, turning = -(h / 2) (bias - d(rate)/dt).
    void put_lines_midway(double h);
    /// Takes back what these two know of the turning of levers: the levers stay those of the middle.
    void forget_turning();
    /// The rows were found again after bodies had turned.
    void turn_lines();
    /// The row of a line; of one that resists rolling, one that has no rate.
    const ConstraintRow& row_of(const Line& line) const { return line.resists() ? kNoRate : rows_[line.row]; }
    bool has_rows() const { return !lines.empty() && !lines.front().resists(); }
    /// Whether rolling and spinning are resisted: not in an instant, and not in displacements.
    void let_resist(bool on) { resists_ = on; }
    bool has_resistances() const { return !lines.empty() && lines.back().resists(); }
    /// Lines that are rows; those that resist rolling come after them.
    std::size_t row_count() const
    {
        return static_cast<std::size_t>(std::ranges::partition_point(lines, [](const Line& line) { return !line.resists(); }) -
                                        lines.begin());
    }
    /// Points what resists rolling against the rolling that the velocities without impulses lead to. Its couples stay the same.
    /// `share`: what is to be made of the step to which the impulses of contacts refer.
    void aim_resistances(double share);
    /// Notes how the pairs roll before forces act. To be called before a kick.
    void note_rolling(const Bodies& bodies);
    /// Sets the bounds of what resists to its lever times the normal impulses, load(i) of point i, and its impulse within them; velocities
    /// follow. Returns by how much (rad/s) this may change the solution.
    template <class Load>
    double bound_resistances(const Load& load);
    /// The same for the movers and rows alone, after they have turned for h (s): sets Mover::turned. The velocities of the movers become
    /// those with the present sums of impulses; `moved` becomes what they were before.
    void turn_movers_and_apply(const Bodies& bodies, double h, std::span<MoverSpeeds> moved);
    /// The same after a move back by h, with the impulses of the move that is undone.
    void turn_movers_back(const Bodies& bodies, double h);
    /// Sets the sums to those with which turn_movers_and_apply() found the movers moved, and applies them.
    void apply_moved(std::span<const MoverSpeeds> moved);
    /// Reads the velocities without impulses, and the given parts of u, from the tables.
    void read_speeds(const Bodies& bodies, const Shafts& shafts);
    /// Reads the given parts of u alone.
    void read_given(const Bodies& bodies, const Shafts& shafts);
    /// Reads the velocities without impulses, and applies the present sums of impulses to them. Returns J: the kinetic energy without
    /// impulses.
    double read_speeds_and_apply(const Bodies& bodies, const Shafts& shafts);
    /// Sets all velocities and given parts to zero, for a solve in displacements instead of velocities.
    void rest();
    /// Sets the impulses of all points and lines to zero.
    void clear_impulses();
    void scale_impulses(double share);
    /// Sets the sums of the movers' impulses to zero, and to those of the lines alone.
    void clear_sums() { sums.assign(movers.size(), {}); }
    void sum_line_impulses();
    /// Sets the movers' velocities to those without impulses plus the effect of the present impulses, summed in a fixed order so
    /// that the result is reproducible.
    void apply_impulses();
    /// The same with the sums that there are: where no impulse and no point has changed since the last call of apply_impulses().
    void apply_same_impulses();
    /// Writes the velocities and the sums of the impulses to the tables.
    void write_speeds(Bodies& bodies, Shafts& shafts);
    /// Takes the sums from the movers' velocities, which sweeps have changed impulse by impulse: m (v - v0), I (w - w0). They equal those
    /// of apply_impulses() but for rounding, without a walk over all points.
    void sum_by_velocities();
    /// Does that, then writes. Returns J: the kinetic energy. The spins in the table have another rounding than Bodies::refresh_spin()
    /// gives them, until refresh_spins() is called.
    double write_swept_speeds(Bodies& bodies, Shafts& shafts);
    void refresh_spins(Bodies& bodies);

    Vec3 relative_velocity(const Point& p) const;  ///< u, m/s
    double rate(const Line& line) const;           ///< J v + given + turning
    /// How far a row is from its target, m/s or rad/s.
    double gap(const Line& line) const
    {
        return line.compliance == 0 ? rate(line) - line.target : rate(line) + line.compliance * line.impulse - line.target;
    }
    void push(const Point& p, const Vec3& j);
    void push(const Line& line, double j);
    /// m/s: how far from the contact law rounding may leave the result: a fraction of the largest speed, or of the speed that
    /// the largest impulse alone would give. The rounding errors of `terms` summands are taken to add up like a random walk.
    double rounding(double terms = 1) const;
    /// Whether the step has been interrupted; sweeps and factorisations then end early.
    bool interrupted() const { return interruption && interruption->due(); }

    std::vector<Mover> movers;
    std::vector<Anchor> anchors;  ///< parallel to movers
    std::vector<Momentum> sums;   ///< parallel to movers: of the impulses that have been applied
    std::vector<Point> points;    ///< parallel to Island::contacts
    std::vector<Line> lines;      ///< parallel to Island::rows, where rows without movers have count 0; then those that resist rolling
    const Interruption* interruption = nullptr;
    Workers* workers = nullptr;             ///< threads that the host lends; null: none
    mutable std::vector<double> part_sums;  ///< working memory of sum_parts()
    /// Working memory of sweeps over the points.
    PacketList<1> single;
    PacketList<4> fours;

    /// Calls one(i) for each i < count, in parts that threads share.
    template <class One>
    void for_each(std::size_t count, const One& one)
    {
        for_parts(workers, count, kMoverPart,
                  [&](std::size_t begin, std::size_t end)
                  {
                      for (std::size_t i = begin; i < end; ++i) one(i);
                  });
    }
    /// The sum of what term(i) is for each mover, in parts.
    template <class Term>
    double sum_over_movers(const Term& term) const
    {
        return sum_parts(workers, movers.size(), kMoverPart, part_sums,
                         [&](std::size_t begin, std::size_t end)
                         {
                             double sum = 0;
                             for (std::size_t i = begin; i < end; ++i) sum += term(i);
                             return sum;
                         });
    }

private:
    void add_bodies(const Island& island, const Bodies& bodies);
    void add_shafts(const Island& island, const Shafts& shafts);
    void set_point(Point& point, const Contact& contact, const Bodies& bodies) const;
    void read_speed(std::size_t mover, const Bodies& bodies, const Shafts& shafts);
    /// Sets the inertias of a body at its present attitude.
    static void set_inertia(Mover& mover, Anchor& anchor, const Bodies& bodies);
    void turn_mover(std::size_t mover, const Bodies& bodies);
    void note_turn(std::size_t mover, double h);
    void apply_sums(std::size_t mover);
    void sum_by_velocity(std::size_t mover);
    void write_speed(std::size_t mover, Bodies& bodies, Shafts& shafts, bool swept = false);
    void put_inertia_midway(std::size_t mover, const Bodies& bodies, double h);
    void take_midway_inertias(Point& p) const;
    /// `w` (rad/s): of the body, or of one that is no mover; `half`: s, half of the step.
    Quat half_turn_of(std::uint32_t mover, const Vec3& w, double half) const;
    void turn_inertia(std::size_t mover, const Quat& by);
    void put_midway(Point& p, const Contact& c, const Bodies& bodies, double half) const;
    void carry_midway(Point& p, const Contact& c, const Bodies& bodies, double half) const;
    void set_mobility(Point& p) const;
    void set_mobility(Line& line) const;
    void add_line(const ConstraintRow& row, std::uint32_t index);
    void add_resistances(const Island& island, const Bodies& bodies);
    bool add_resistance(const RollingResistance& pair, const Vec3& axis, double lever);
    /// A pair whose rolling is resisted, by two lines.
    struct Roller
    {
        Point at;         ///< in the middle of its points
        Vec3 given_spin;  ///< rad/s, of b relative to a: of those that are no movers
        Ref a, b;
        Vec3 rolled;              ///< rad/s, of b relative to a, along the surface, before forces act
        double pressed = 0;       ///< N s: the normal impulses of the last step
        double lever = 0;         ///< m
        std::uint32_t first = 0;  ///< of its lines
    };
    void add_roller(const RollingResistance& pair, const Contact& middle, const Bodies& bodies);
    Vec3 rolling_without(const Roller& roller, double share, double& load) const;
    void turn_resistance(Line& line, const Vec3& axis);
    bool moves(const Line& line, Ref participant) const;
    /// m/s or rad/s: the rate that those have who are no movers.
    double given_of(const Line& line, const Bodies& bodies, const Shafts& shafts) const;
    double given_of_resistance(const Line& line, const Bodies& bodies) const;
    bool is_isotropic_at(std::uint32_t mover) const { return mover == kNoIndex || movers[mover].isotropic; }

    std::vector<std::uint32_t> mover_of_body_, mover_of_shaft_;  ///< by row in Bodies or Shafts
    std::vector<std::uint32_t> carried_;  ///< points that touch a body which is not a mover and may move all the same (kinematic)
    std::span<const Contact> contacts_;
    std::span<const ConstraintRow> rows_;
    std::vector<Roller> rollers_;
    bool resists_ = false;
    static const ConstraintRow kNoRate;
};

/// How far the impulse of a point is from the contact law, as a speed in m/s: the residual of the fixed-point equations
///   j_n = max(0, j_n - (u_n - least) / K_nn),   j_t = projection of j_t - u_t / k_t onto the disc of radius mu j_n.
/// It is 0 exactly where Signorini's condition and Coulomb's law (a true cone, with friction opposing the slip) hold.
double violation(const Point& p, const Vec3& u);
double violation(const Line& line, double gap);
/// The largest violation over all points and lines.
double violation(const Problem& problem);

/// Largest eigenvalue of the tangential 2 x 2 part of K.
inline double slip_mobility(const Mat3& K)
{
    const double mean = 0.5 * (K(0, 0) + K(1, 1)), half = 0.5 * (K(0, 0) - K(1, 1));
    return mean + std::sqrt(half * half + K(0, 1) * K(0, 1));
}

/// J, of the movers at their present velocities, and at those without impulses.
double kinetic_energy(const Problem& problem);
double kinetic_energy_without(const Problem& problem);

/// The point of the disc of radius `radius` that is nearest to (x, y); z is passed through unchanged.
inline Vec3 within_disc(Vec3 j, double radius)
{
    const double squared = j.x * j.x + j.y * j.y;
    if (squared <= radius * radius) return j;
    const double share = radius / std::sqrt(squared);
    return {j.x * share, j.y * share, j.z};
}

template <class Load>
double Problem::bound_resistances(const Load& load)
{
    double largest = 0;
    for (Line& line : std::span(lines).subspan(row_count()))
    {
        double sum = 0;
        for (std::uint32_t k = line.first_point; resists_ && k < line.end_point; ++k) sum += load(k);
        const double before = line.impulse;
        largest = std::max(largest, line.set_bound(line.lever * sum, before) * line.mobility);
        line.impulse = std::clamp(before, line.least, line.most);
        if (line.impulse != before) push(line, line.impulse - before);
    }
    return largest;
}

inline Vec3 to_contact(const Point& p, const Vec3& v) { return {dot(p.t1, v), dot(p.t2, v), dot(p.n, v)}; }
inline Vec3 to_world(const Point& p, const Vec3& v) { return p.t1 * v.x + p.t2 * v.y + p.n * v.z; }

inline Vec3 Problem::relative_velocity(const Point& p) const
{
    Vec3 u;
    if (p.b != kNoIndex) u += movers[p.b].v + cross(movers[p.b].w, p.r_b);
    if (p.a != kNoIndex) u -= movers[p.a].v + cross(movers[p.a].w, p.r_a);
    return to_contact(p, u) + p.given + p.turning;
}

inline void Problem::push(const Point& p, const Vec3& j)
{
    const Vec3 j_W = to_world(p, j);
    if (p.b != kNoIndex)
    {
        Mover& m = movers[p.b];
        m.v += j_W * m.inverse_mass;
        m.w += m.inverse_inertia * cross(p.r_b, j_W);
    }
    if (p.a != kNoIndex)
    {
        Mover& m = movers[p.a];
        m.v -= j_W * m.inverse_mass;
        m.w -= m.inverse_inertia * cross(p.r_a, j_W);
    }
}

}  // namespace plab::managers
