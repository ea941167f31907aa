/// Contacts: found by a detection, located in time by a resolution, resolved by a response.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "plab/ref.h"
#include "plab/vector.h"

namespace plab
{

/// The curvature of a hollow face, as a vector: 1 / R (1/m, W) along the contact normal inside a sphere, along the axis inside a cylinder;
/// zero if the face is flat. R is that of the sphere or cylinder on which the fixed point of a pivot is while the two touch.
struct Hollow
{
    std::array<float, 3> bend{};  // float keeps contacts small; seven digits of a curvature are enough

    bool is_flat() const { return bend[0] == 0 && bend[1] == 0 && bend[2] == 0; }
    Vec3 vector() const { return {bend[0], bend[1], bend[2]}; }
    static Hollow of(const Vec3& v) { return {{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}}; }
};

/// Where a contact point goes while a body turns and slides on a face of the other: it stays at an arm from a point that is fixed in the
/// body.
struct Pivot
{
    enum class Of : std::uint8_t
    {
        Neither,  ///< the other body has no face there, edges cross, or it is not known
        A,
        B,
    };
    enum class Arm : std::uint8_t
    {
        Constant,  ///< of balls and round ends; zero at corners, which are fixed in the body themselves
        OnRim,     ///< the radius, of a circle that is fixed in the body, that reaches furthest towards the other body
    };
    Of of = Of::Neither;
    Arm kind = Arm::Constant;
    Hollow hollow{};
    Vec3 arm{};  ///< W, m: from the point that is fixed in the body to the contact point
};

/// One contact point of two bodies. a < b in the order of component ids.
struct Contact
{
    Ref a, b;
    std::uint32_t feature = 0;  ///< identifies shapes and corner; stable while the same features touch
    Vec3 point;                 ///< W, m
    Vec3 normal;                ///< W, unit, from a to b
    double depth = 0;           ///< m, penetration depth; > 0 when overlapping
    Pivot pivot;
    // Filled by the host:
    std::uint64_t id = 0;            ///< stable from the beginning to the end of the contact
    double friction = 0;             ///< Coulomb coefficient
    double restitution = 0;          ///< Newton's coefficient
    double normal_acceleration = 0;  ///< m/s^2 of separation under the applied forces alone; < 0 presses the bodies together
    bool resting = false;            ///< persistent contact, not an impact
    double approach = 0;             ///< m/s: closing speed at which the contact began; only in the step in which it begins, else 0
    double turning = 0;              ///< m/s: part of the normal speed that is due to the curved path of a body, not to separation
    // Kept by the host from step to step, for responses with memory; changed only in the last evaluation of a step:
    Vec3 stretch;           ///< m, W: elongation of the stiction spring
    double rest_depth = 0;  ///< m: the depth at which the contact spring exerts exactly its equilibrium force
    double preload = 0;     ///< N: the equilibrium force at rest_depth
    // Filled by the response:
    Vec3 impulse;     ///< N s on b, W
    double slip = 0;  ///< m/s, tangential speed after the response
};

/// A pair that has been in contact since before: the detection displaces b by `shift` before it tests, and subtracts |shift| from the
/// depth, so that a gap of rounding size does not end a persistent contact.
struct PersistentPair
{
    Ref a, b;
    Vec3 shift;
};

/// Receives the contacts of Phase::Detect in any order. The host sorts them, so the order in which a library finds them does not reach
/// the state.
class ContactSink
{
public:
    virtual ~ContactSink() = default;
    virtual std::span<const PersistentPair> persistent() const = 0;
    /// Only persistent pairs are requested (trial times of one pair), so no broad phase is needed.
    virtual bool only_persistent() const { return false; }
    /// m: contacts with a gap up to this are also wanted, with depth < 0.
    virtual double margin() const { return 0; }
    /// Motion margin, m, by body: how far its surface may move from its present place. If not empty, the caller wants pairs whose
    /// bounding boxes overlap when expanded by this margin, by near(), and no contacts.
    virtual std::span<const double> motion_margin() const { return {}; }
    /// Of an end of a cylinder that is level, which has no furthest point, one of its rim is wanted as that (Pivot::Arm::OnRim), too: springs
    /// move it to the middle, and would otherwise lose and gain one wherever the end passes through level.
    virtual bool level_rims() const { return false; }
    virtual void near(Ref /*a*/, Ref /*b*/) {}
    /// The normal points from a to b; a and b in the order given by precedes().
    virtual void add(const Contact& contact) = 0;
    /// Cost of the detection beyond one pair of simple shapes per pair of bodies, in units of such a pair: parts of a compound, triangles
    /// tested, vertices of a hull. The host limits the work of a step by it.
    virtual void took(double /*further_pairs*/) {}
    /// The order of two bodies by component id. Pairs must be put in this order *before* a library computes contacts.
    virtual bool precedes(Ref a, Ref b) const = 0;
};

/// Phase::Gap: the distance of two bodies at their present poses.
struct GapQuery
{
    Ref a, b;
    // out
    double gap = 0;            ///< m; < 0: penetration depth
    Vec3 point_a, point_b;     ///< W, m: the closest points
    Vec3 normal;               ///< W, unit, from a to b
    double further_pairs = 0;  ///< cost, as in ContactSink::took()
};

/// How the impacts of a step are found.
enum class ImpactSearch : std::uint8_t
{
    Locate,     ///< inside the step, each at its time
    Speculate,  ///< not at all: gaps that may close within the step are contacts of a manager
    AtEnd,      ///< where the step ends, with the overlap that has developed
};

/// Phase::Choose: the contacts of one detection at the start of a step, for a resolution that adapts to them. The choice must follow from
/// these facts alone, so that a rewound or restored run makes the same one.
struct ContactLoad
{
    // in
    std::uint32_t bodies = 0;  ///< dynamic bodies of the scene
    /// Of these, the ones in islands beyond the limits that the resolution has as parameters `max_bodies` and `max_points`, or that have
    /// been in one within its `dwell` (s), and those that sleep; all of them for the dwell after locating impacts has cost too much. All
    /// bodies of an island are crowded, or none is.
    std::uint32_t crowded = 0;
    std::uint32_t island_bodies = 0;  ///< dynamic bodies of the largest island that persistent contacts hold together
    std::uint32_t island_points = 0;  ///< contact points of the island that has most of them
    double travel = 0;                ///< largest distance that a body moves in the step, in radii (a thin one: in halves of its thickness)
    bool has_manager = false;         ///< the response leaves contacts to a manager; without one, speculation is not possible
    // out
    ImpactSearch search = ImpactSearch::AtEnd;          ///< of pairs without a crowded body
    ImpactSearch crowded_search = ImpactSearch::AtEnd;  ///< of the others
};

/// Phase::Locate: a step [0, h] is known to contain an event; the resolution chooses the next time to try.
struct EventBracket
{
    // in
    double begin = 0;    ///< s, known to be free of the event
    double end = 0;      ///< s, known to be after the event (overlapping)
    double depth = 0;    ///< m, deepest new penetration at `end`
    double closing = 0;  ///< m/s, closing speed at `end`
    double step = 0;     ///< s, h
    int iteration = 0;   ///< trials so far
    // Signed gaps, m (a depth is a negative gap), and their rates, m/s (negative when closing); NaN: unknown
    double gap_begin = 0, gap_end = 0;
    double rate_begin = 0, rate_end = 0;
    double last = 0, last_gap = 0, last_rate = 0;  ///< of the last trial, at time `last` (s)
    // out
    enum class Decision : std::uint8_t
    {
        Try,
        Accept,
        GiveUp
    };
    Decision decision = Decision::Accept;
    double next = 0;  ///< s, in (begin, end); for Try
};

/// What touched a body in a step: a point of a contact that persists, or an impact inside the step.
struct TouchPoint
{
    Ref other;      ///< the other body
    Vec3 point;     ///< W, m; of an impact: where it happened
    Vec3 normal;    ///< W, unit, from the body that is asked about to the other one
    Vec3 impulse;   ///< W, N s in this step, on the body that is asked about
    bool persists;  ///< it touches at the end of the step
    Vec3 couple;    ///< W, N m s: an angular impulse besides
};

/// Phase::Finish: the touching points of bodies in the step that ends.
class Touches
{
public:
    virtual ~Touches() = default;
    /// In the order of the pairs, which is that of ids; then the impacts, in their order of time, then what was added. Valid until the next
    /// call.
    virtual std::span<const TouchPoint> of(Ref body) const = 0;
    /// A component that holds a body in another way adds its impulse here, so that the body's own type, and others whose names come later
    /// in the alphabet, can tell the load of the body.
    virtual void add(Ref body, const TouchPoint& point) = 0;
};

enum class ImpactMode : std::uint8_t
{
    Impact,  ///< bodies meet now: restitution and friction impulses; a contact that should not bounce any more is set `resting`
    Rest,    ///< contacts persist over a step: impulses with friction, without restitution, that keep the gaps from closing
};

/// Phase::Respond: the contacts of one group at one time.
struct Impact
{
    ImpactMode mode = ImpactMode::Impact;
    double dt = 0;  ///< s, Rest only: the step during which gaps may close
    std::span<Contact> contacts;
    /// 1/kg, W: where joints hold bodies of these n contacts, n x n blocks by rows. Block (i, j) times an impulse at contact j (on b) is
    /// the change of the velocity of b's point relative to a's at contact i, joints included. Of a contact without friction, column j is
    /// known for impulses along its normal only. The host applies the impulses (Contact::impulse) then, and the response leaves the
    /// velocities of the bodies as they are. Empty: bodies are free, and the response applies its impulses itself.
    std::span<const Mat3> mobility;
    int iterations = 0;       ///< out
    std::int64_t visits = 0;  ///< out: number of contacts processed, counted anew in each sweep: the work of the response
    double residual = 0;      ///< out: m/s, largest remaining violation of normal speed
    bool converged = true;    ///< out
};

}  // namespace plab
