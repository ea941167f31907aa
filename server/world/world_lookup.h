/// What a command may look up in its world.
#pragma once

#include <string>

#include "model/names.h"
#include "model/text.h"
#include "world/world.h"

namespace plab::world
{

class WorldLookup final : public Lookup
{
public:
    /// `structure`: counts the changes of components and parameters, for those who ask for it.
    explicit WorldLookup(const World& world, std::uint64_t structure = 0) : world_(world), structure_(structure) {}
    std::string_view id_of(Ref ref) const override { return ref.valid() ? std::string_view(world_.id_of(ref)) : std::string_view(); }
    Ref find(std::string_view id) const override
    {
        const std::uint32_t i = world_.find(std::string(id));
        return i == kNoIndex || world_.component(i).table == kNoIndex ? Ref{} : world_.component(i).ref(i);
    }
    Value value_of(Ref ref, std::string_view field) const override
    {
        return ref.valid() ? world_.get(world_.host().component_of(ref), std::string(field)) : Value();
    }
    std::span<const std::uint32_t> components() const override { return world_.in_id_order(); }
    std::uint64_t structure() const override { return structure_; }
    std::string_view id_of(std::uint32_t component) const override { return world_.id_of(component); }
    std::string_view type_of(std::uint32_t component) const override
    {
        const model::ComponentType* type = world_.type_of(component);
        return type ? std::string_view(type->info.name) : std::string_view();
    }
    Ref ref_of(std::uint32_t component) const override { return world_.component(component).ref(component); }
    std::uint32_t component_of(Ref ref) const override { return ref.valid() ? world_.host().component_of(ref) : kNoIndex; }
    bool exists(std::string_view id) const override { return world_.find(std::string(id)) != kNoIndex; }
    bool matches(std::string_view patterns, std::string_view text) const override
    {
        for (const std::string_view pattern : model::split_words(patterns))
            if (model::matches(pattern, text)) return true;
        return false;
    }
    Ref participant(std::uint32_t component, std::string_view role) const override
    {
        const model::ComponentType* type = world_.type_of(component);
        const Role* found = type ? world_.table_of(component).schema().find_role(role) : nullptr;
        Ref first;
        const auto take = [&](Ref r) { first = first.valid() ? first : r; };
        if (found) world_.for_each_participant(component, *found, take);
        return first;
    }

private:
    const World& world_;
    std::uint64_t structure_;
};

}  // namespace plab::world
