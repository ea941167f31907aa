#include <doctest/doctest.h>

#include "model/values.h"
#include "scene_types.h"

namespace plab::test
{

SourceLocation at(std::uint32_t line, std::uint32_t column) { return {"scene.xml", line, column}; }

model::TextNode text(std::string name, std::string value, std::uint32_t line)
{
    model::TextNode node;
    node.name = std::move(name);
    node.text = std::move(value);
    node.where = at(line);
    return node;
}

model::TextNode reference(std::string name, std::vector<std::string> components, std::uint32_t line)
{
    model::TextNode node = text(std::move(name), "", line);
    node.component_references = std::move(components);
    return node;
}

model::TextNode command_reference(std::string name, std::vector<std::string> commands, std::uint32_t line)
{
    model::TextNode node = text(std::move(name), "", line);
    node.command_references = std::move(commands);
    return node;
}

model::ComponentNode component(std::string id, std::string type, const Texts& attributes, std::uint32_t line)
{
    model::ComponentNode node;
    node.id = std::move(id);
    node.type = std::move(type);
    node.where = at(line);
    for (const auto& [name, value] : attributes) node.attributes.push_back(text(name, value, line));
    return node;
}

model::ComponentNode body(const std::string& id, Texts more)
{
    more.emplace_back("mass", "1");
    return component(id, "State/RigidBody", more, 5);
}

model::ComponentNode shaft(const std::string& id) { return component(id, "State/Shaft"); }

model::ComponentNode group(std::string id, std::vector<model::ComponentNode> children, std::uint32_t line)
{
    model::ComponentNode node = component(std::move(id), "", {}, line);
    node.children = std::move(children);
    return node;
}

model::ComponentNode shares(std::string id, std::vector<std::string> ids, std::uint32_t line)
{
    model::ComponentNode node = component(std::move(id), "", {}, line);
    node.reference_places.assign(ids.size(), at(line));
    node.references = std::move(ids);
    return node;
}

model::CommandNode command(std::string subject, std::string type, std::uint32_t line)
{
    model::CommandNode node;
    node.subject = std::move(subject);
    node.type = std::move(type);
    node.where = at(line);
    return node;
}

model::CommandNode composite(std::string id, std::string name, std::vector<model::CommandNode> children, std::uint32_t line)
{
    model::CommandNode node;
    node.id = std::move(id);
    node.name = std::move(name);
    node.children = std::move(children);
    node.where = at(line);
    return node;
}

model::CommandNode see_command(std::string id, std::uint32_t line)
{
    model::CommandNode node;
    node.reference = std::move(id);
    node.where = at(line);
    return node;
}

model::RepeatNode repeat(const Texts& attributes, std::vector<model::ComponentNode> components, std::uint32_t line)
{
    model::RepeatNode node;
    for (const auto& [name, value] : attributes) node.attributes.push_back(text(name, value, line));
    node.components = std::move(components);
    node.where = at(line);
    return node;
}

model::Blueprint scene(std::vector<model::ComponentNode> components)
{
    model::Blueprint blueprint;
    blueprint.file = "scene.xml";
    blueprint.components = std::move(components);
    return blueprint;
}

model::SceneSpec compiled(const model::Blueprint& blueprint, const model::SceneSpec* existing)
{
    FixedTypes types;
    Result<model::SceneSpec> result = model::compile(blueprint, types, existing);
    if (result) return result.take();
    std::string all;
    for (const Error& e : result.errors()) all += e.text() + "\n";
    FAIL(all);
    return {};
}

std::string errors_of(const model::Blueprint& blueprint, const model::SceneSpec* existing)
{
    FixedTypes types;
    const Result<model::SceneSpec> result = model::compile(blueprint, types, existing);
    std::string all;
    if (!result)
        for (const Error& e : result.errors()) all += (all.empty() ? "" : "\n") + e.text();
    return all;
}

std::string errors_of(std::vector<model::ComponentNode> components) { return errors_of(scene(std::move(components))); }

namespace
{

std::string join(const std::vector<std::string>& words)
{
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
    return out;
}

const model::ComponentSpec& get(const model::SceneSpec& scene, const std::string& id)
{
    const model::ComponentSpec* found = scene.find(id);
    REQUIRE_MESSAGE(found, id);
    return *found;
}

}  // namespace

std::string role_of(const model::SceneSpec& scene, const std::string& id, const std::string& role)
{
    for (const model::RoleSpec& r : get(scene, id).roles)
        if (r.name == role) return (r.everyone ? "* " : "") + join(r.members);
    return "-";
}

std::string field_of(const model::SceneSpec& scene, const std::string& id, const std::string& field)
{
    for (const model::FieldSpec& f : get(scene, id).fields)
        if (f.name == field) return model::format_value(f.value);
    return "-";
}

std::string ids_of(const model::SceneSpec& scene)
{
    std::vector<std::string> ids;
    for (const model::ComponentSpec& c : scene.components) ids.push_back(c.id);
    return join(ids);
}

std::string commands_of(const model::SceneSpec& scene, const std::string& id)
{
    const model::ComponentSpec& c = get(scene, id);
    return c.explicit_commands ? join(c.commands) : "defaults";
}

std::string dump(const model::SceneSpec& scene)
{
    std::string out;
    for (const model::ComponentSpec& c : scene.components)
    {
        out += c.id + "|" + c.type + "|" + c.parent + "|" + c.alias_of + "|" + join(c.group) + (c.generated ? "|generated" : "|");
        for (const model::FieldSpec& f : c.fields) out += " " + f.name + "=" + model::format_value(f.value);
        for (const model::RoleSpec& r : c.roles) out += " " + r.name + "=" + role_of(scene, c.id, r.name);
        out += " " + commands_of(scene, c.id) + "\n";
    }
    return out;
}

}  // namespace plab::test
