#include "publish/scene_events.h"

#include <string_view>

namespace plab::publish
{
namespace
{

/// "impact" of "contact.impact"; null if it is not a collision.
const char* collision_kind(std::string_view kind)
{
    constexpr std::string_view kPrefix = "contact.";
    if (!kind.starts_with(kPrefix)) return nullptr;
    for (const char* word : {"begin", "impact", "rest", "end"})
        if (kind.substr(kPrefix.size()) == word) return word;
    return nullptr;
}

std::string id_of(const world::World& world, Ref ref) { return ref.valid() ? world.id_of(ref) : std::string(); }

const char* word(Severity severity)
{
    constexpr const char* kWords[] = {"info", "warning", "failure"};
    return kWords[static_cast<std::size_t>(severity)];
}

wire::CollisionInfo collision_of(const world::World& world, const Event& e, const char* kind)
{
    wire::CollisionInfo out;
    out.kind = kind, out.time = e.time;
    out.detector = world.id_of(e.component), out.a = id_of(world, e.a), out.b = id_of(world, e.b);
    if (e.contact)
        out.position = e.contact->point, out.normal = e.contact->normal, out.impulse = e.contact->impulse, out.depth = e.contact->depth;
    return out;
}

wire::EventInfo event_of(const world::World& world, const Event& e)
{
    wire::EventInfo out;
    out.kind = e.kind, out.severity = word(e.severity), out.time = e.time;
    out.component_id = world.id_of(e.component), out.a = id_of(world, e.a), out.b = id_of(world, e.b);
    out.message = e.message, out.values = e.values;
    // The wire gives the place of such a contact as six values: point and normal.
    if (e.contact)
        for (const Vec3& v : {e.contact->point, e.contact->normal}) out.values.insert(out.values.end(), {v.x, v.y, v.z});
    return out;
}

}  // namespace

Counts count(std::span<const Event> events)
{
    Counts out;
    for (const Event& e : events) ++(collision_kind(e.kind) ? out.collisions : out.others);
    return out;
}

wire::Collisions collisions_of(const simulation::Simulation& s, Tick step, std::uint64_t first)
{
    wire::Collisions out;
    out.run = s.run(), out.sequence_number = first, out.step = step;
    for (const Event& e : s.events())
        if (const char* kind = collision_kind(e.kind)) out.entries.push_back(collision_of(s.world(), e, kind));
    return out;
}

wire::Events events_of(const simulation::Simulation& s, Tick step, std::uint64_t first)
{
    wire::Events out;
    out.run = s.run(), out.sequence_number = first, out.step = step;
    for (const Event& e : s.events())
        if (!collision_kind(e.kind)) out.entries.push_back(event_of(s.world(), e));
    return out;
}

}  // namespace plab::publish
