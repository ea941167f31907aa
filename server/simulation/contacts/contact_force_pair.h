/// State of force contacts (springs and dampers) over time: what is stored from the first contact to the end of the contact.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "plab/collision.h"
#include "plab/context.h"

namespace plab::simulation
{

/// Squared frequencies and decay rate of one contact by itself, as sums over both of its bodies.
struct ContactRates
{
    double normal = 0;      ///< 1/s^2: stiffness times mobility along the normal
    double tangential = 0;  ///< 1/s^2: along the surface, the worse direction
    double damping = 0;     ///< 1/s: damping times mobility, the worst direction
    double mobility = 0;    ///< 1/kg along the normal
    double share_a = 0;     ///< a's fraction of the mobility, 0 to 1
};

/// One contact point that pushes.
struct ForceContact
{
    std::uint32_t feature = 0;
    std::uint64_t id = 0;
    Vec3 stretch;           ///< m, W: of the stiction spring, at the start of the present piece of the step
    double rest_depth = 0;  ///< m; and preload, N: see Contact. Nonzero if the spring took over from a hard contact
    double preload = 0;
    double open_depth = 0;        ///< m: depth at which the spring force is zero; below it the contact ends
    double approach = 0;          ///< m/s: closing speed at the first contact
    double begin = 0;             ///< s, time of the first contact
    double depth = 0;             ///< m, as detected last
    double peak = 0;              ///< m: largest depth that is expected
    double half_period = 0;       ///< s: pi over the fastest rate of this contact by itself
    ContactRates rates;           ///< at `peak`
    double swing_speed = 0;       ///< m/s: estimated speed amplitude of its oscillation
    double peak_swing_speed = 0;  ///< m/s: the largest value of it so far
    Vec3 impulse;                 ///< N s on b, since it began
    Vec3 force;                   ///< N on b, as of the last finished piece
    Tick asked = -1;              ///< step in which `peak` was estimated last
    bool slack = false;           ///< overlaps, but the law gives no force: a damper that would have to pull
    bool reported = false;        ///< its impact event has been emitted
    /// Its force has ended while a swap had left some overlap: no force until the bodies have separated or close again.
    bool dormant = false;
};

/// A pair of bodies with contact points that push: everything but the points.
struct ForcePairHead
{
    std::uint32_t detector = kNoIndex;  ///< component
    Ref a, b;
    Tick since = 0;
    std::uint64_t law_type = 0;  ///< hash of the type of the force law that the state belongs to
    std::uint64_t law = 0;       ///< hash of its type and parameters
    Vec3 normal;
    std::uint32_t count = 0;  ///< number of its contacts
    /// J, of springs whose points have vanished while others pushed: points that appear in their place take it over, and no more.
    double released = 0;
};

struct ForcePair : ForcePairHead
{
    static constexpr std::size_t kMostContacts = 16;

    std::array<ForceContact, kMostContacts> contacts;

    ForcePair() = default;
    // Pairs are copied in each piece of a step, so only the points that there are.
    ForcePair(const ForcePair& other) { *this = other; }
    ForcePair& operator=(const ForcePair& other)
    {
        if (this == &other) return *this;
        ForcePairHead::operator=(other);
        std::copy_n(other.contacts.begin(), other.count, contacts.begin());
        return *this;
    }

    std::span<ForceContact> all() { return {contacts.data(), count}; }
    std::span<const ForceContact> all() const { return {contacts.data(), count}; }
    ForceContact* find(std::uint32_t feature)
    {
        for (ForceContact& c : all())
            if (c.feature == feature) return &c;
        return nullptr;
    }
};

/// An event to be emitted when the step is over, unless its time is rewound.
struct ContactForceEvent
{
    enum class Kind : std::uint8_t
    {
        Begin,
        Impact,
        End,
    };
    Kind kind = Kind::Begin;
    double time = 0;                    ///< s
    std::uint32_t detector = kNoIndex;  ///< component
    Ref a, b;
    Vec3 point, normal, impulse;  ///< m, unit, N s on b
    double depth = 0;             ///< m
};

/// The state of force contacts that changes while groups advance; it is rewound with them.
struct ForceState
{
    std::vector<ForcePair> pairs;  ///< by detector, a and b in id order
    std::vector<ContactForceEvent> events;
};

}  // namespace plab::simulation
