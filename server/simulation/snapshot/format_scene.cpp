#include "simulation/snapshot/format_scene.h"

#include <algorithm>
#include <map>
#include <set>

#include "simulation/snapshot/records.h"

namespace plab::simulation
{
namespace
{

using namespace records;

/// Distributes the rows of a section of items to the lists to which they belong; `list_of` returns the list of the row that an item
/// names.
template <class ListOf>
Result<void> distribute(const Section& section, std::size_t owners, ListOf list_of)
{
    auto items = rows_of<Item>(section);
    if (!items) return items.errors();
    for (Item& item : *items)
    {
        if (item.of >= owners)
            return reason("the snapshot's section '" + section.name + "' names row " + std::to_string(item.of) + ", which is not there");
        list_of(item.of).push_back(std::move(item.text));
    }
    return {};
}

Result<void> read_fields(const Section& section, std::vector<model::ComponentSpec>& components)
{
    auto fields = rows_of<GivenField>(section);
    if (!fields) return fields.errors();
    for (GivenField& f : *fields)
    {
        if (f.component >= components.size()) return reason("the snapshot gives a field to a component that is not there");
        components[f.component].fields.push_back({std::move(f.name), std::move(f.value), {}});
    }
    return {};
}

Result<void> read_roles(const std::string& prefix, const std::vector<Section>& sections, std::vector<model::ComponentSpec>& components)
{
    auto roles = rows_of<GivenRole>(find_section(sections, prefix + "roles"));
    if (!roles) return roles.errors();
    std::vector<model::RoleSpec> specs(roles->size());
    if (auto done = distribute(
            find_section(sections, prefix + "role_members"), specs.size(), [&](std::uint32_t i) -> auto& { return specs[i].members; });
        !done)
        return done;
    if (auto done = distribute(
            find_section(sections, prefix + "role_patterns"), specs.size(), [&](std::uint32_t i) -> auto& { return specs[i].patterns; });
        !done)
        return done;
    for (std::size_t i = 0; i < specs.size(); ++i)
    {
        GivenRole& role = (*roles)[i];
        if (role.component >= components.size()) return reason("the snapshot gives a role to a component that is not there");
        specs[i].name = std::move(role.name), specs[i].everyone = role.everyone;
        components[role.component].roles.push_back(std::move(specs[i]));
    }
    return {};
}

// Checks -------------------------------------------------------------------------------------------------------------------

class Check
{
public:
    Check(const model::SceneSpec& scene, model::TypeSource& types) : scene_(scene), types_(types) {}

    Errors run()
    {
        if (const double dt = scene_.settings.dt.seconds; !(dt > 0 && dt <= 3600)) refuse("the scene", "has no usable step length");
        for (const model::ComponentSpec& c : scene_.components)
        {
            if (c.id.empty() || !index_.emplace(c.id, &c).second) refuse("'" + c.id + "'", "is not a valid id, or occurs twice");
            if (c.type.empty()) continue;
            auto type = types_.require(c.type);
            if (type)
                types_of_[c.id] = *type;
            else
                errors_.insert(errors_.end(), type.errors().begin(), type.errors().end());
        }
        if (!errors_.empty()) return errors_;
        for (const model::ComponentSpec& c : scene_.components)
        {
            parents(c);
            if (c.type.empty()) continue;
            const model::ComponentType& type = *types_of_.at(c.id);
            for (const model::FieldSpec& f : c.fields) field(c, f, type);
            for (const model::RoleSpec& r : c.roles) role(c, r, type);
            missing_roles(c, type);
        }
        return errors_;
    }

private:
    void refuse(const std::string& component, const std::string& why)
    {
        constexpr std::size_t kMost = 100;
        if (errors_.size() < kMost) errors_.push_back({{}, component, why});
    }

    void parents(const model::ComponentSpec& c)
    {
        std::size_t depth = 0;
        for (const model::ComponentSpec* at = &c; !at->parent.empty(); ++depth)
        {
            const auto up = index_.find(at->parent);
            if (up == index_.end() || depth > scene_.components.size()) return refuse(c.id, "has a parent that does not exist");
            at = up->second;
        }
    }

    void field(const model::ComponentSpec& c, const model::FieldSpec& given, const model::ComponentType& type)
    {
        const Field* field = type.schema.find_field(given.name);
        if (!field || (field->kind != FieldKind::Param && field->kind != FieldKind::State))
            return refuse(c.id, type.info.name + " has no field '" + given.name + "' that can be given");
        if (type_of(given.value) != field->type) refuse(c.id, "'" + given.name + "' has another type in this build");
    }

    void role(const model::ComponentSpec& c, const model::RoleSpec& given, const model::ComponentType& type)
    {
        const Role* role = type.schema.find_role(given.name);
        if (!role) return refuse(c.id, type.info.name + " has no role '" + given.name + "'");
        if (given.everyone) return;  // the names were valid when the role was resolved, even if a component is gone now
        if (given.members.size() > role->max || given.members.size() < role->min)
            refuse(c.id, "has " + std::to_string(given.members.size()) + " participants in the role '" + role->name + "'");
        for (const std::string& member : given.members)
        {
            const auto at = types_of_.find(member);
            if (at == types_of_.end() || !fits(*role, at->second->info))
                refuse(c.id, "'" + member + "' does not fit the role '" + role->name + "'");
        }
    }

    static bool fits(const Role& role, const TypeInfo& type)
    {
        const bool facet = std::find(role.facets.begin(), role.facets.end(), type.facet) != role.facets.end();
        return facet && (type.facet != Facet::Component || type.name.rfind(role.family, 0) == 0);
    }

    void missing_roles(const model::ComponentSpec& c, const model::ComponentType& type)
    {
        for (const Role& role : type.schema.roles())
            if (role.min > 0 && std::none_of(c.roles.begin(), c.roles.end(), [&](const model::RoleSpec& r) { return r.name == role.name; }))
                refuse(c.id, "has no participant in the role '" + role.name + "'");
    }

    const model::SceneSpec& scene_;
    model::TypeSource& types_;
    std::map<std::string, const model::ComponentSpec*> index_;
    std::map<std::string, const model::ComponentType*> types_of_;
    Errors errors_;
};

}  // namespace

const Section& find_section(const std::vector<Section>& sections, const std::string& name)
{
    static const Section none;
    const auto at = std::find_if(sections.begin(), sections.end(), [&](const Section& s) { return s.name == name; });
    return at == sections.end() ? none : *at;
}

std::vector<Section> write_scene(const std::string& prefix, const model::SceneSpec& scene)
{
    std::vector<Settings> settings{{scene.settings, scene.file}};
    std::vector<model::Camera> cameras = scene.settings.cameras;
    std::vector<model::ComponentSpec> components;
    std::vector<Item> groups, commands, members, patterns;
    std::vector<GivenField> fields;
    std::vector<GivenRole> roles;
    for (const model::ComponentSpec& c : scene.components)
    {
        const auto row = static_cast<std::uint32_t>(components.size());
        components.push_back(c);
        for (const std::string& id : c.group) groups.push_back({row, id});
        for (const std::string& name : c.commands) commands.push_back({row, name});
        for (const model::FieldSpec& f : c.fields) fields.push_back({row, f.name, f.value});
        for (const model::RoleSpec& r : c.roles)
        {
            for (const std::string& id : r.members) members.push_back({static_cast<std::uint32_t>(roles.size()), id});
            for (const std::string& id : r.patterns) patterns.push_back({static_cast<std::uint32_t>(roles.size()), id});
            roles.push_back({row, r.name, r.everyone});
        }
    }
    std::vector<Section> out;
    out.push_back(section_of(prefix + "settings", settings)), out.push_back(section_of(prefix + "cameras", cameras));
    out.push_back(section_of(prefix + "components", components)), out.push_back(section_of(prefix + "groups", groups));
    out.push_back(section_of(prefix + "commands", commands)), out.push_back(section_of(prefix + "fields", fields));
    out.push_back(section_of(prefix + "roles", roles)), out.push_back(section_of(prefix + "role_members", members));
    // Only where there are any: then older versions can read the others.
    if (!patterns.empty()) out.push_back(section_of(prefix + "role_patterns", patterns));
    return out;
}

Result<model::SceneSpec> read_scene(const std::string& prefix, const std::vector<Section>& sections)
{
    const auto section = [&](const char* name) -> const Section& { return find_section(sections, prefix + name); };
    auto settings = rows_of<Settings>(section("settings"));
    if (!settings) return settings.errors();
    if (settings->size() != 1) return reason("the snapshot has no section '" + prefix + "settings' of one row");
    model::SceneSpec out;
    out.settings = std::move(settings->front().settings), out.file = std::move(settings->front().file);
    auto cameras = rows_of<model::Camera>(section("cameras"));
    if (!cameras) return cameras.errors();
    out.settings.cameras = cameras.take();
    auto components = rows_of<model::ComponentSpec>(section("components"));
    if (!components) return components.errors();
    std::vector<model::ComponentSpec> list = components.take();
    for (auto done : {distribute(
                          section("groups"), list.size(), [&](std::uint32_t i) -> auto& { return list[i].group; }),
                      distribute(
                          section("commands"), list.size(), [&](std::uint32_t i) -> auto& { return list[i].commands; }),
                      read_fields(section("fields"), list), read_roles(prefix, sections, list)})
        if (!done) return done.errors();
    out.components = std::move(list);
    return out;
}

Errors check_scene(const model::SceneSpec& scene, model::TypeSource& types) { return Check(scene, types).run(); }

}  // namespace plab::simulation
