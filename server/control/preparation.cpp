#include "control/preparation.h"

#include <algorithm>
#include <set>
#include <string>

namespace plab::control
{
namespace
{

using simulation::AddBlueprintOperation;
using simulation::Operation;

/// Whether an operation makes another scene, against which a later addition has to be compiled.
bool changes_scene(const Operation& op)
{
    return std::holds_alternative<AddBlueprintOperation>(op) || std::holds_alternative<simulation::AddOperation>(op) ||
           std::holds_alternative<simulation::RemoveOperation>(op) || std::holds_alternative<simulation::SwapOperation>(op);
}

/// Loads a type, and those of the parts that are made for its required roles.
void load_with_parts(model::TypeSource& types, const std::string& name, std::set<std::string>& loaded)
{
    if (!loaded.insert(name).second) return;
    const auto type = types.require(name);
    if (!type) return;
    for (const Role& role : (*type)->schema.roles())
        if (role.min > 0 && !role.default_type.empty()) load_with_parts(types, role.default_type, loaded);
}

void collect_types(const std::vector<model::ComponentNode>& nodes, std::set<std::string>& out)
{
    for (const model::ComponentNode& node : nodes)
    {
        if (!node.type.empty()) out.insert(node.type);
        collect_types(node.children, out);
    }
}

world::Shared<model::SceneSpec> together(const model::SceneSpec& scene, const model::SceneSpec& fragment)
{
    world::Shared<model::SceneSpec> out;
    model::SceneSpec& whole = out.edit();
    whole.settings = scene.settings, whole.file = scene.file;
    whole.components.reserve(scene.components.size() + fragment.components.size());
    whole.components = scene.components;
    whole.components.append(fragment.components);
    return out;
}

}  // namespace

void load_types(const simulation::Request& request, model::TypeSource& types)
{
    std::set<std::string> written;
    for (const Operation& op : request.operations)
    {
        if (const auto* swap = std::get_if<simulation::SwapOperation>(&op)) written.insert(swap->type);
        const auto* add = std::get_if<AddBlueprintOperation>(&op);
        if (!add) continue;
        collect_types(add->blueprint->components, written);
        for (const model::RepeatNode& repeat : add->blueprint->repeats) collect_types(repeat.components, written);
    }
    if (written.empty()) return;
    // Often only the end of a name is written. Whether the type fits is checked when the request takes effect; an error here will occur
    // there again.
    std::set<std::string> loaded;
    const std::vector<std::string> known = types.names();
    for (const std::string& end : written)
        for (const std::string& name : known)
            if (name == end || name.ends_with("/" + end)) load_with_parts(types, name, loaded);
}

bool has_additions(const simulation::Request& request)
{
    const auto first = std::find_if(request.operations.begin(), request.operations.end(), changes_scene);
    return first != request.operations.end() && std::holds_alternative<AddBlueprintOperation>(*first);
}

void prepare_additions(simulation::Request& request, model::TypeSource& types, const std::shared_ptr<const model::SceneSpec>& scene,
                       const model::CompileLimits& limits)
{
    if (!scene || !has_additions(request)) return;
    auto& add = std::get<AddBlueprintOperation>(*std::find_if(request.operations.begin(), request.operations.end(), changes_scene));
    auto prepared = std::make_shared<simulation::PreparedAddition>();
    prepared->present = scene;
    if (auto fragment = model::compile(*add.blueprint, types, scene.get(), limits); fragment)
        prepared->whole = together(*scene, fragment.take());
    else
        prepared->whole = fragment.errors();
    add.prepared = std::move(prepared);
}

}  // namespace plab::control
