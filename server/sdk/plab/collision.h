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
    // Filled by the response:
    Vec3 impulse;     ///< N s on b, W
    double slip = 0;  ///< m/s, tangential speed after the response
};

/// A pair that touches since before: detection moves b by `shift` before looking, and takes |shift| off the depth, so
/// that a gap of a rounding error does not end a standing contact.
struct StandingPair
{
    Ref a, b;
    Vec3 shift;
};

/// Phase::Detect adds what it finds, in any order; the host sorts, so no order of a library reaches the state.
class ContactSink
{
public:
    virtual ~ContactSink() = default;
    virtual std::span<const StandingPair> standing() const = 0;
    /// Only the standing pairs are asked for: no broad phase is needed (trial times of one pair).
    virtual bool only_standing() const { return false; }
    /// normal from a to b; a and b in the order in which `precedes` says they stand.
    virtual void add(const Contact& contact) = 0;
    /// The order of two bodies by component id: pairs must be formed in it *before* a library computes contacts.
    virtual bool precedes(Ref a, Ref b) const = 0;
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
    int iterations = 0;     ///< out
    double residual = 0;    ///< out: m/s, largest violation left in normal speed
    bool converged = true;  ///< out
};

}  // namespace plab
