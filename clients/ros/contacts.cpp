#include "ros/contacts.h"

namespace plab::ros
{
namespace
{

constexpr std::uint8_t kLink = 3;  // ros_gz_interfaces/Entity: a body

}  // namespace

void ContactMessage::fill(const plab_v2_CollisionInfo& from, double dt, const SceneFrames& frames, msg::Contact& to)
{
    const SceneFrame* const a = frames.find_id(text_of(from.a));
    const SceneFrame* const b = frames.find_id(text_of(from.b));
    const auto entity_of = [](const SceneFrame* frame)
    {
        ros_gz_interfaces_msg_dds__Entity_ out{};
        if (frame != nullptr) out.id = frame->handle, out.name = wire::text(frame->name);
        out.type = kLink;
        return out;
    };
    to.collision1 = entity_of(a), to.collision2 = entity_of(b);
    const Vec3 normal = vec(from.normal), impulse = vec(from.impulse);
    if (length_squared(normal) == 0) return;
    make_sequence(to.positions, 1, memory_)[0] = vector_of(vec(from.position));
    make_sequence(to.normals, 1, memory_)[0] = vector_of(normal);
    make_sequence(to.depths, 1, memory_)[0] = from.depth;
    auto& wrench = make_sequence(to.wrenches, 1, memory_)[0];
    wrench.header = {time_of(from.time), wire::text(kWorldFrame)};
    wrench.body_1_name.data = to.collision1.name, wrench.body_2_name.data = to.collision2.name;
    wrench.body_1_id.data = static_cast<std::uint32_t>(to.collision1.id),
    wrench.body_2_id.data = static_cast<std::uint32_t>(to.collision2.id);
    // The mean force over the step that has the same effect as the impulse.
    const Vec3 force = dt > 0 ? impulse / dt : Vec3{};
    wrench.body_1_wrench.force = vector_of(-force), wrench.body_2_wrench.force = vector_of(force);
}

const msg::Contacts& ContactMessage::of(const plab_v2_Collisions& collisions, double dt, const SceneFrames& frames)
{
    contacts_.clear(), memory_.clear();
    const auto entries = wire::items(collisions.entries);
    contacts_.resize(entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) fill(entries[i], dt, frames, contacts_[i]);
    message_.header = {time_of(entries.empty() ? 0 : entries.back().time), wire::text(kWorldFrame)};
    show(message_.contacts, contacts_);
    return message_;
}

}  // namespace plab::ros
