/// The components of a loaded scene by type, with their fields and participants as plain values.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "world/world.h"

namespace plab::exported
{

/// A view of one component; the world must outlive it.
class ComponentView
{
public:
    ComponentView(const world::World& world, std::uint32_t index) : world_(&world), index_(index) {}
    std::uint32_t index() const { return index_; }
    const std::string& id() const { return world_->id_of(index_); }
    const std::string& type() const { return world_->type_of(index_)->info.name; }
    Facet facet() const { return world_->component(index_).facet; }
    std::uint32_t host() const { return world_->component(index_).host_index; }
    /// 0, {} and "" for fields that the type does not have.
    double real(const std::string& field) const;
    Vec3 vector(const std::string& field) const;
    Quat rotation(const std::string& field) const;
    std::string text(const std::string& field) const;
    /// Participants of a role; none if the type has no such role.
    std::vector<Ref> participants(std::string_view role) const;
    /// The only one; invalid if there is none.
    Ref participant(std::string_view role) const;

private:
    const world::World* world_;
    std::uint32_t index_;
};

/// All components in the order of their ids.
std::vector<ComponentView> components_of(const world::World& world);

}  // namespace plab::exported
