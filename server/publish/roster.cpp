#include "publish/roster.h"

namespace plab::publish
{
namespace
{

Roster::Kind kind_of(Facet facet)
{
    if (facet == Facet::Shape) return Roster::Kind::Shape;
    // Quantities have no pose in space: they are published with their fields, like interactions.
    return facet == Facet::Body || facet == Facet::Shaft ? Roster::Kind::Object : Roster::Kind::Interaction;
}

}  // namespace

void Roster::restart()
{
    members_.clear();
    next_handle_ = 1;
}

void Roster::welcome(const world::Component& c, Member& member, Tick boundary)
{
    member.kind = kind_of(c.facet), member.since = boundary;
    if (member.kind == Kind::Object) member.handle = next_handle_++;
}

Roster::Differences Roster::update(const world::World& world, Tick boundary)
{
    Differences out;
    bodies_.clear(), shafts_.clear();
    for (std::size_t& n : counts_) n = 0;
    auto known = members_.begin();
    const auto drop_until = [&](const std::string* id)
    {
        for (; known != members_.end() && (!id || known->first < *id); known = members_.erase(known)) out.gone.push_back(known->first);
    };
    // Both lists are sorted by id: one pass finds which components were added and removed.
    for (const std::uint32_t i : world.in_id_order())
    {
        const world::Component& c = world.component(i);
        if (c.table == kNoIndex) continue;
        drop_until(&c.id);
        const bool is_new = known == members_.end() || known->first != c.id;
        if (is_new) known = members_.emplace_hint(known, c.id, Member{});
        Member& member = known->second;
        const model::ComponentType* type = world.type_of(i);
        const bool other_kind = !is_new && member.kind != kind_of(c.facet);
        if (is_new || other_kind)
            welcome(c, member, boundary);
        else if (member.type != type)
            member.since = boundary, out.retyped.push_back(c.id);
        if (is_new) out.came.push_back(c.id);
        out.other_kind = out.other_kind || other_kind;
        member.index = i, member.type = type;
        ++counts_[static_cast<std::size_t>(member.kind)];
        if (member.kind == Kind::Object) (c.facet == Facet::Body ? bodies_ : shafts_).push_back({member.handle, c.host_index});
        ++known;
    }
    drop_until(nullptr);
    return out;
}

const Roster::Member* Roster::find(const std::string& id) const
{
    const auto found = members_.find(id);
    return found == members_.end() ? nullptr : &found->second;
}

}  // namespace plab::publish
