/// Contacts that are forces, over time: what a spring remembers from the touch to the end of the contact.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "plab/collision.h"
#include "plab/context.h"

namespace plab::simulation
{

/// How fast one contact by itself would swing or settle, as sums over both of its bodies.
struct ContactRates
{
    double normal = 0;      ///< 1/s^2: stiffness times mobility along the normal
    double tangential = 0;  ///< 1/s^2: along the surface, the worse direction
    double damping = 0;     ///< 1/s: damping times mobility, the worst direction
    double mobility = 0;    ///< 1/kg along the normal
    double share_a = 0;     ///< how much of it is a's
};

/// One contact point that pushes.
struct ForceContact
{
    std::uint32_t feature = 0;
    std::uint64_t id = 0;
    Vec3 stretch;           ///< m, W: of the stiction spring, where the present piece of the step began
    double rest_depth = 0;  ///< m, N: see Contact; other than 0 where the spring took over from a hard contact
    double preload = 0;
    double open_depth = 0;        ///< m: the spring gives no force there; below it the contact ends
    double approach = 0;          ///< m/s: closing speed at the touch
    double begin = 0;             ///< s, time of the touch
    double depth = 0;             ///< m, as seen last
    double peak = 0;              ///< m: how deep it is expected to get
    double half_period = 0;       ///< s: pi over the fastest rate of this contact by itself
    ContactRates rates;           ///< at `peak`
    double swing_speed = 0;       ///< m/s: about the speed with which it swings
    double peak_swing_speed = 0;  ///< m/s: the most that this has been
    Vec3 impulse;                 ///< N s on b, since it began
    Vec3 force;                   ///< N on b, as of the last finished piece
    Tick asked = -1;              ///< step in which `peak` was estimated last
    bool slack = false;           ///< overlaps, and the law gives no force: a damper that would have to pull
    bool reported = false;        ///< its impact is an event already
    /// Has let go where a swap had let an overlap be: no force until the bodies have parted, or close again.
    bool dormant = false;
};

/// A pair of bodies with contact points that push, without those.
struct ForcePairHead
{
    std::uint32_t detector = kNoIndex;  ///< component
    Ref a, b;
    Tick since = 0;
    std::uint64_t law_type = 0;  ///< which law made it what it is: the type
    std::uint64_t law = 0;       ///< type and parameters
    Vec3 normal;
    std::uint32_t count = 0;  ///< of its contacts
};

struct ForcePair : ForcePairHead
{
    static constexpr std::size_t kMostContacts = 16;

    std::array<ForceContact, kMostContacts> contacts;

    std::span<ForceContact> all() { return {contacts.data(), count}; }
    std::span<const ForceContact> all() const { return {contacts.data(), count}; }
    ForceContact* find(std::uint32_t feature)
    {
        for (ForceContact& c : all())
            if (c.feature == feature) return &c;
        return nullptr;
    }
};

/// Something to tell when the step is over, unless its time is rewound.
struct ForceHappening
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

/// All that changes with contacts that are forces while groups advance: it goes back when they do.
struct ForceState
{
    std::vector<ForcePair> pairs;  ///< by detector, a and b in id order
    std::vector<ForceHappening> happenings;
};

}  // namespace plab::simulation
