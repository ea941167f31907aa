/// compile(): the passes in order, and the resulting scene.

#include "model/compile.h"

#include <algorithm>

#include "model/compile_internal.h"
#include "model/names.h"
#include "model/text.h"
#include "model/values.h"

namespace plab::model
{

namespace detail
{

namespace
{

/// Cells of a repeat move the components in them; shapes move with their bodies.
void move_to_cell(Compilation& c, std::size_t i)
{
    Draft& d = c.draft(i);
    if (!d.cell || !d.type || d.type->info.facet == Facet::Shape || d.cell->offset == Vec3{}) return;
    const std::deque<Field>& fields = d.type->schema.fields();
    for (std::size_t k = 0; k < fields.size(); ++k)
    {
        const Field& field = fields[k];
        const bool is_place = field.name == "position" && field.type == FieldType::Vector && field.unit == unit::metre;
        if (!is_place || field.kind == FieldKind::Output || field.kind == FieldKind::Scratch) continue;
        const auto given = std::find_if(d.fields.begin(), d.fields.end(), [&](const GivenField& g) { return g.index == k; });
        const Vec3* base = std::get_if<Vec3>(given != d.fields.end() ? &given->value : &field.fallback);
        if (!base) continue;
        Value moved(*base + d.cell->offset);
        if (Result<void> checked = check_value(moved, field); !checked) return c.complain(i, d.where, checked.error().reason);
        if (given != d.fields.end())
            given->value = std::move(moved);
        else
            d.fields.push_back({k, std::move(moved), d.where});
    }
}

ComponentSpec make_spec(Compilation& c, std::size_t i)
{
    Draft& d = c.draft(i);
    ComponentSpec spec;
    spec.id = d.id;
    spec.name = d.name;
    spec.type = d.type_name;
    spec.parent = d.parent == kNone ? std::string() : c.draft(d.parent).id;
    if (d.alias != kNone) spec.alias_of = c.draft(c.directory.follow(d.alias)).id;
    if (d.type_name.empty())
        for (const std::size_t member : d.group) spec.group.push_back(c.draft(member).id);
    spec.generated = d.generated;
    spec.where = d.where;
    if (!d.type) return spec;
    for (GivenField& f : d.fields) spec.fields.push_back({d.type->schema.fields()[f.index].name, std::move(f.value), f.where});
    for (std::size_t k = 0; k < d.roles.size(); ++k)
    {
        if (!d.roles[k].given) continue;
        RoleSpec& role = spec.roles.emplace_back();
        role.name = d.type->schema.roles()[k].name;
        role.everyone = d.roles[k].everyone;
        role.patterns = d.roles[k].patterns;
        role.where = d.roles[k].where;
        for (const std::size_t member : d.roles[k].members) role.members.push_back(c.draft(member).id);
    }
    spec.explicit_commands = d.explicit_commands;
    for (const int k : d.commands) spec.commands.push_back(d.type->info.commands[static_cast<std::size_t>(k)].name);
    return spec;
}

std::vector<std::string> all_ids(const Compilation& c)
{
    std::vector<std::string> ids;
    for (const Draft& d : c.directory.drafts) ids.push_back(d.id);
    return ids;
}

}  // namespace

SceneSpec assemble(Compilation& c)
{
    SceneSpec scene;
    scene.settings = c.settings;
    scene.file = c.blueprint->file;
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i)
        if (!c.draft(i).existing) scene.components.push_back(make_spec(c, i));
    return scene;
}

}  // namespace detail

Result<SceneSpec> compile(const Blueprint& blueprint, TypeSource& types, const SceneSpec* existing, const CompileLimits& limits)
{
    using namespace detail;
    Compilation c(blueprint, types, existing, limits);
    read_settings(c);
    declare_existing(c);
    declare_components(c);
    if (c.limit_reported) return c.report.finish(all_ids(c), blueprint.file);  // follow-up errors would be meaningless
    link_references(c);
    settle_solver(c);
    collect_commands(c);
    gather_fields(c);
    apply_command_parameters(c, false);
    form_parts(c);
    if (c.limit_reported) return c.report.finish(all_ids(c), blueprint.file);
    apply_command_parameters(c, true);
    resolve_roles(c);
    check_roles(c);
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i) move_to_cell(c, i);
    finish_fields(c);
    select_commands(c);
    if (!c.report.empty()) return c.report.finish(all_ids(c), blueprint.file);
    return assemble(c);
}

}  // namespace plab::model
