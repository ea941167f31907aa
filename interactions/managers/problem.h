/// An island as managers compute with it: movers, contact points and scalar rows, with impulses as unknowns.
///
/// Contact coordinates are (t1, t2, n), n from a to b; u = velocity of b's point less that of a's, m/s:
///
///   u = E (v_b + w_b x r_b - v_a - w_a x r_a) + given,   du = K dj,   K = E (sum of (1/m) 1 - [r] I^-1 [r]) E^T
///
/// j acts on b, -j on a, N s. M and J stay apart: nothing here divides one mass by another.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "plab/island.h"
#include "plab/tables.h"

namespace plab::managers
{

/// What the innermost loops touch of a body, or of a shaft (angular.x alone).
struct Mover
{
    Vec3 v;  ///< m/s
    Vec3 w;  ///< rad/s, W; a shaft: x
    double inverse_mass = 0;
    Mat3 inverse_inertia;  ///< W; a shaft: (0,0)
};

/// The rest of it.
struct Anchor
{
    std::uint32_t host = kNoIndex;  ///< row of Bodies or Shafts
    bool shaft = false;
    double mass = 1;
    Mat3 inertia;     ///< W
    Vec3 v, w;        ///< speeds without impulses
    Vec3 push, turn;  ///< N s, N m s: what the impulses come to
    Vec3 written;     ///< N m s: how much of `turn` the table has already
};

struct Point
{
    std::uint32_t a = kNoIndex, b = kNoIndex;  ///< movers; kNoIndex: does not move by impulses
    Vec3 n, t1, t2;                            ///< W
    Vec3 r_a, r_b;                             ///< m, from the centres of mass, W
    Vec3 given;                                ///< m/s: what bodies that are no movers add to u
    Mat3 K;                                    ///< 1/kg
    double slip_mobility = 0;                  ///< 1/kg, largest eigenvalue of K's tangential part
    double friction = 0;
    double least = 0;  ///< m/s: u_n >= least
    Vec3 impulse;      ///< N s

    bool frictional() const { return friction > 0; }
};

/// A joint's, limit's or motor's row: sum of linear . v + angular . w + given >= or = target.
struct Line
{
    std::uint32_t row = 0;    ///< in Island::rows
    std::uint32_t count = 0;  ///< of movers that take part
    std::array<std::uint32_t, ConstraintRow::kMostBlocks> mover{};
    std::array<Vec3, ConstraintRow::kMostBlocks> linear, angular;
    double given = 0;
    double mobility = 0;  ///< J M^-1 J^T
    double target = 0;
    double least = 0, most = 0;  ///< N s or N m s
    double impulse = 0;
};

class Problem
{
public:
    /// Geometry, masses and warm starts. `targets` and speeds are still to be set.
    void load(const Island& island, const Bodies& bodies, const Shafts& shafts);
    /// Inertias, mobilities and spins without impulses at the present attitudes, after bodies have turned freely. Contact points stay where
    /// they were found, seen from the centres of mass: what is round touches with another point of it when it has turned.
    void turn_with(const Bodies& bodies);
    /// Speeds without impulses from the tables; given parts of u with them.
    void read_speeds(const Bodies& bodies, const Shafts& shafts);
    /// Speeds at rest, and none given: for displacements instead of speeds.
    void rest();
    /// Impulses of all points and lines to nothing.
    void clear_impulses();
    void scale_impulses(double share);
    /// Movers' speeds = speeds without impulses + what the present impulses do, summed in a fixed order.
    void apply_impulses();
    /// To the tables; after apply_impulses.
    void write_speeds(Bodies& bodies, Shafts& shafts);

    Vec3 relative_velocity(const Point& p) const;  ///< u, m/s
    double rate(const Line& line) const;           ///< J v + given
    void push(const Point& p, const Vec3& j);
    void push(const Line& line, double j);
    /// m/s: what rounding may leave of a contact law: a share of the largest speed, and of what the largest impulse alone
    /// would give; of sums of that many terms, like a random walk.
    double rounding(double terms = 1) const;
    /// The step is given up: sweeps and factorisations end.
    bool interrupted() const { return interruption && interruption->due(); }

    std::vector<Mover> movers;
    std::vector<Anchor> anchors;  ///< beside movers
    std::vector<Point> points;    ///< beside Island::contacts
    std::vector<Line> lines;      ///< beside Island::rows; those without movers have count 0
    const Interruption* interruption = nullptr;

private:
    void add_bodies(const Island& island, const Bodies& bodies);
    void add_shafts(const Island& island, const Shafts& shafts);
    void add_point(const Contact& contact, const Bodies& bodies);
    void set_mobility(Point& p) const;
    void set_mobility(Line& line) const;
    void add_line(const ConstraintRow& row, std::uint32_t index);
    std::uint32_t mover_of(Ref who) const;

    std::vector<std::uint32_t> mover_of_body_, mover_of_shaft_;  ///< by host row
    std::vector<Vec3> contact_points_;
    std::span<const Contact> contacts_;
    std::span<const ConstraintRow> rows_;
};

/// How far a point's impulse is from what the law asks of it, m/s: the fixed point residual of
///   j_n = max(0, j_n - (u_n - least) / K_nn),   j_t = that within mu j_n nearest to j_t - u_t / k_t,
/// which is 0 exactly where Signorini's condition and Coulomb's law (a true cone, slip against friction) hold.
double violation(const Point& p, const Vec3& u);
double violation(const Line& line, double rate);
/// The largest of all.
double violation(const Problem& problem);

/// J, of the movers at their present speeds; and without any impulse.
double kinetic_energy(const Problem& problem);
double kinetic_energy_without(const Problem& problem);

/// The point of the disc of radius `radius` that is nearest to (x, y); z is passed through.
inline Vec3 within_disc(Vec3 j, double radius)
{
    const double squared = j.x * j.x + j.y * j.y;
    if (squared <= radius * radius) return j;
    const double share = radius / std::sqrt(squared);
    return {j.x * share, j.y * share, j.z};
}

inline Vec3 to_contact(const Point& p, const Vec3& v) { return {dot(p.t1, v), dot(p.t2, v), dot(p.n, v)}; }
inline Vec3 to_world(const Point& p, const Vec3& v) { return p.t1 * v.x + p.t2 * v.y + p.n * v.z; }

inline Vec3 Problem::relative_velocity(const Point& p) const
{
    Vec3 u;
    if (p.b != kNoIndex) u += movers[p.b].v + cross(movers[p.b].w, p.r_b);
    if (p.a != kNoIndex) u -= movers[p.a].v + cross(movers[p.a].w, p.r_a);
    return to_contact(p, u) + p.given;
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
