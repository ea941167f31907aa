/// Contacts: what detection finds, resolution locates in time, and response answers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plab/ref.h"
#include "plab/vector.h"

namespace plab
{

/// One point where two bodies touch or overlap. a < b in the order of component ids.
struct Contact
{
    Ref a, b;
    std::uint32_t feature = 0;  ///< which shapes and corner; stable while the same features touch
    Vec3 point;                 ///< W, m
    Vec3 normal;                ///< W, unit, from a to b
    double depth = 0;           ///< m, > 0 when overlapping
    // Filled by the host:
    std::uint64_t id = 0;            ///< stable from begin to end of the contact
    double friction = 0;             ///< Coulomb coefficient
    double restitution = 0;          ///< Newton's coefficient
    double normal_acceleration = 0;  ///< m/s^2 of separation that the forces alone would give; < 0 presses together
    bool resting = false;            ///< persists; not an impact
    double approach = 0;             ///< m/s: closing speed at which it began, in the step in which it begins; else 0
    double turning = 0;              ///< m/s: normal speed that is square to the normal of the step's end, of who moves along a curve
    // Kept by the host from step to step, for responses that remember; changed in the last evaluation of a step only:
    Vec3 stretch;           ///< m, W: how far a stiction spring is stretched
    double rest_depth = 0;  ///< m: the depth at which a contact spring gives no force beyond its equilibrium
    double preload = 0;     ///< N: the force that it gives at rest_depth
    // Filled by the response:
    Vec3 impulse;     ///< N s on b, W
    double slip = 0;  ///< m/s, tangential speed after the response
};

/// A pair that touches since before: detection moves b by `shift` before looking, and takes |shift| off the depth, so
/// that a gap of a rounding error does not end a standing contact.
struct PersistentPair
{
    Ref a, b;
    Vec3 shift;
};

/// Phase::Detect adds what it finds, in any order; the host sorts, so no order of a library reaches the state.
class ContactSink
{
public:
    virtual ~ContactSink() = default;
    virtual std::span<const PersistentPair> persistent() const = 0;
    /// Only the standing pairs are asked for: no broad phase is needed (trial times of one pair).
    virtual bool only_persistent() const { return false; }
    /// m: contacts whose gap is up to this are wanted too, with depth < 0.
    virtual double margin() const { return 0; }
    /// m, by body: how far its surface may get from where it is now. Not empty: pairs of bodies whose bounds, grown by
    /// that, overlap are wanted by near(), and no contacts.
    virtual std::span<const double> motion_margin() const { return {}; }
    virtual void near(Ref /*a*/, Ref /*b*/) {}
    /// normal from a to b; a and b in the order in which `precedes` says they stand.
    virtual void add(const Contact& contact) = 0;
    /// What the look took beyond one pair of simple shapes for each pair of bodies, counted in such pairs: parts of a compound, triangles
    /// gone through, a hull's vertices. The host bounds the work of a step by it.
    virtual void took(double /*further_pairs*/) {}
    /// The order of two bodies by component id: pairs must be formed in it *before* a library computes contacts.
    virtual bool precedes(Ref a, Ref b) const = 0;
};

/// Phase::Gap: how far two bodies are apart at their present poses.
struct GapQuery
{
    Ref a, b;
    // out
    double gap = 0;            ///< m; < 0: depth of the overlap
    Vec3 point_a, point_b;     ///< W, m: the nearest points
    Vec3 normal;               ///< W, unit, from a to b
    double further_pairs = 0;  ///< what it took, as ContactSink::took has it
};

/// Phase::Locate: a step [0, h] is known to hold an event; the resolution picks the next time to try.
struct Trial
{
    // in
    double begin = 0;    ///< s, known to be clear
    double end = 0;      ///< s, known to overlap
    double depth = 0;    ///< m, deepest new overlap at `end`
    double closing = 0;  ///< m/s, closing speed there
    double step = 0;     ///< s, h
    int iteration = 0;   ///< trials so far
    // Signed gaps, m (depth is a negative gap), and their rates, m/s (closing is negative); NaN: not known
    double gap_begin = 0, gap_end = 0;
    double rate_begin = 0, rate_end = 0;
    double last = 0, last_gap = 0, last_rate = 0;  ///< of the last trial, at s
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

enum class ImpactMode : std::uint8_t
{
    Impact,  ///< bodies meet now: restitution and friction impulses; a contact that should not bounce on is set `resting`
    Rest,    ///< contacts persist over a step: impulses that keep them from closing, with friction, without restitution
};

/// Phase::Respond: the touching contacts of one group, all at one time.
struct Impact
{
    ImpactMode mode = ImpactMode::Impact;
    double dt = 0;  ///< s, Rest only: the step over which gaps may close
    std::span<Contact> contacts;
    int iterations = 0;       ///< out
    std::int64_t visits = 0;  ///< out: contacts gone through, those of each sweep anew: what the answer took
    double residual = 0;      ///< out: m/s, largest violation left in normal speed
    bool converged = true;    ///< out
};

}  // namespace plab
