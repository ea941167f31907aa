#include "publish/happenings.h"

#include <string_view>

namespace plab::publish
{
namespace
{

/// "impact" of "contact.impact"; null if it is no collision.
const char* collision_kind(std::string_view kind)
{
    constexpr std::string_view kPrefix = "contact.";
    if (!kind.starts_with(kPrefix)) return nullptr;
    for (const char* word : {"begin", "impact", "rest", "end"})
        if (kind.substr(kPrefix.size()) == word) return word;
    return nullptr;
}

/// The i-th vector among an event's values; zero where the kind carries fewer.
Vec3 vector_in(const std::vector<double>& values, std::size_t i)
{
    return values.size() >= 3 * i + 3 ? Vec3{values[3 * i], values[3 * i + 1], values[3 * i + 2]} : Vec3{};
}

std::string id_of(const world::World& world, Ref ref) { return ref.valid() ? world.id_of(ref) : std::string(); }

CollisionRecord collision_of(const world::World& world, const Event& e, const char* kind)
{
    CollisionRecord out;
    out.kind = kind, out.time = e.time;
    out.detector = world.id_of(e.component), out.a = id_of(world, e.a), out.b = id_of(world, e.b);
    out.position = vector_in(e.values, 0), out.normal = vector_in(e.values, 1), out.impulse = vector_in(e.values, 2);
    if (e.values.size() >= 10) out.depth = e.values[9];
    return out;
}

EventRecord event_of(const world::World& world, const Event& e)
{
    EventRecord out;
    out.kind = e.kind, out.severity = e.severity, out.time = e.time;
    out.component = world.id_of(e.component), out.a = id_of(world, e.a), out.b = id_of(world, e.b);
    out.message = e.message, out.values = e.values;
    return out;
}

}  // namespace

Counts count(std::span<const Event> events)
{
    Counts out;
    for (const Event& e : events) ++(collision_kind(e.kind) ? out.collisions : out.others);
    return out;
}

Batch<CollisionRecord> collisions_of(const simulation::Simulation& s, Tick step, std::uint64_t first)
{
    Batch<CollisionRecord> out;
    out.run = s.run(), out.first = first, out.step = step;
    for (const Event& e : s.events())
        if (const char* kind = collision_kind(e.kind)) out.entries.push_back(collision_of(s.world(), e, kind));
    return out;
}

Batch<EventRecord> events_of(const simulation::Simulation& s, Tick step, std::uint64_t first)
{
    Batch<EventRecord> out;
    out.run = s.run(), out.first = first, out.step = step;
    for (const Event& e : s.events())
        if (!collision_kind(e.kind)) out.entries.push_back(event_of(s.world(), e));
    return out;
}

}  // namespace plab::publish
