#include "daemon/frozen.h"

#include <algorithm>
#include <set>

namespace plab::daemon
{
namespace
{

bool is_rule(const world::World& world, const std::string& id)
{
    const model::ComponentType* type = world.type_of(world.find(id));
    return type && type->info.family == "Rule";
}

void give(model::ComponentSpec& spec, const std::string& name, Value value)
{
    const auto given = std::find_if(spec.fields.begin(), spec.fields.end(), [&](const model::FieldSpec& f) { return f.name == name; });
    if (given != spec.fields.end())
        given->value = std::move(value);
    else
        spec.fields.push_back({name, std::move(value), {}});
}

}  // namespace

model::SceneSpec frozen_scene(const simulation::Simulation& simulation)
{
    const world::World& world = simulation.world();
    model::SceneSpec out = world.scene();
    std::set<std::string> rules;
    for (const model::ComponentSpec& spec : out.components)
        if (!spec.type.empty() && is_rule(world, spec.id)) rules.insert(spec.id);
    out.components.remove_if([&](const model::ComponentSpec& spec) { return rules.contains(spec.id); });
    for (std::size_t k = 0; k < out.components.size(); ++k)
    {
        if (out.components[k].type.empty()) continue;
        model::ComponentSpec spec = out.components[k];
        const std::uint32_t component = world.find(spec.id);
        for (const Field& field : world.table_of(component).schema().fields())
            if (field.kind == FieldKind::State && field.type != FieldType::Opaque) give(spec, field.name, world.get(component, field.name));
        spec.made_by.clear();
        out.components.replace(k, std::move(spec));
    }
    return out;
}

}  // namespace plab::daemon
