#include "export/components.h"

namespace plab::exported
{
namespace
{

template <class T>
T value_of(const Value& value)
{
    const T* const held = std::get_if<T>(&value);
    return held ? *held : T{};
}

}  // namespace

double ComponentView::real(const std::string& field) const { return value_of<double>(world_->get(index_, field)); }
Vec3 ComponentView::vector(const std::string& field) const { return value_of<Vec3>(world_->get(index_, field)); }
Quat ComponentView::rotation(const std::string& field) const { return value_of<Quat>(world_->get(index_, field)); }
std::string ComponentView::text(const std::string& field) const { return value_of<std::string>(world_->get(index_, field)); }

std::vector<Ref> ComponentView::participants(std::string_view wanted) const
{
    for (const Role& role : world_->table_of(index_).schema().roles())
        if (role.name == wanted) return world_->participants(index_, role);
    return {};
}

Ref ComponentView::participant(std::string_view role) const
{
    const auto all = participants(role);
    return all.empty() ? Ref{} : all.front();
}

std::vector<ComponentView> components_of(const world::World& world)
{
    std::vector<ComponentView> out;
    for (const std::uint32_t i : world.in_id_order()) out.emplace_back(world, i);
    return out;
}

}  // namespace plab::exported
