#include "blueprint/tree.h"

#include <algorithm>

#include "blueprint/entry_text.h"
#include "model/names.h"
#include "model/text.h"

namespace plab::blueprint
{
namespace
{

using model::CommandNode;
using model::ComponentNode;
using model::RepeatNode;
using model::TextNode;

/// The elements of the language and where each is allowed; "" is the root.
struct Word
{
    std::string_view name;
    std::string_view parents;
};
constexpr Word kWords[] = {
    {"plab", ""},
    {"scene", "<plab>"},
    {"camera", "<scene>"},
    {"repeat", "<plab>"},
    {"component", "<plab>, <component> or <repeat>"},
    {"command", "<component> or <command>"},
    {"param", "<component>"},
    {"state", "<component>"},
    {"entry", "<param>"},
    {"compref", "<component>, <param> or <udata>"},
    {"cmdref", "<command> or <udata>"},
    {"cmdparam", "<command>, or right after one"},
    {"udata", "<cmdparam>"},
};

}  // namespace

void TreeReader::misplaced(const XmlElement& e, const std::string& parent)
{
    if (complaints_.full()) return complaints_.add(e.where, {}, {});
    for (const Word& w : kWords)
    {
        if (w.name != e.name) continue;
        const std::string right = w.parents.empty() ? "it is the root element" : "it belongs in " + std::string(w.parents);
        return complaints_.add(e.where, in_tags(e.name), "is not allowed in " + parent + "; " + right);
    }
    std::vector<std::string> known;
    for (const Word& w : kWords) known.emplace_back(w.name);
    for (const ForeignHandler& h : handlers_.all()) known.push_back(h.element);
    if (handlers_.find(e.name))
        return complaints_.add(e.where, in_tags(e.name), "is not allowed in " + parent + "; it belongs in <component>");
    complaints_.add(e.where, in_tags(e.name), "unknown element" + model::did_you_mean(e.name, known));
}

void TreeReader::check_attributes(const XmlElement& e, std::initializer_list<std::string_view> allowed)
{
    for (const XmlAttribute& a : e.attributes)
    {
        if (std::find(allowed.begin(), allowed.end(), a.name) != allowed.end()) continue;
        const std::vector<std::string> known(allowed.begin(), allowed.end());
        const std::string list = known.empty()
                                     ? " (the element has none)"
                                     : std::string(known.size() > 1 ? " (known are " : " (known is ") + model::quoted_list(known) + ")";
        complaints_.add(e.where, in_tags(e.name), "unknown attribute " + model::quoted(a.name) + model::did_you_mean(a.name, known) + list);
    }
}

void TreeReader::refuse_text(const XmlElement& e)
{
    if (e.text_where.line == 0) return;
    const std::string_view text = model::trimmed(e.text);
    complaints_.add(e.text_where, in_tags(e.name), "unexpected text " + model::quoted(text.substr(0, text.find('\n'))));
}

void TreeReader::refuse_children(const XmlElement& e)
{
    for (const XmlElement& c : e.children) misplaced(c, in_tags(e.name));
}

std::string TreeReader::name_attribute(const XmlElement& e, std::string_view name)
{
    const std::string* value = e.find_attribute(name);
    if (!value) return {};
    if (value->size() > kLongestName)
    {
        complaints_.add(e.where, in_tags(e.name),
                        std::string(name) + " has " + std::to_string(value->size()) + " characters; at most " +
                            std::to_string(kLongestName) + " are allowed");
        return value->substr(0, kLongestName);
    }
    const std::string out(model::trimmed(*value));
    if (out.empty()) complaints_.add(e.where, in_tags(e.name), std::string(name) + " must not be empty");
    return out;
}

std::string TreeReader::required_name(const XmlElement& e, std::string_view name)
{
    if (!e.find_attribute(name)) complaints_.add(e.where, in_tags(e.name), "needs an attribute " + model::quoted(name));
    return name_attribute(e, name);
}

std::string TreeReader::reference(const XmlElement& e)
{
    check_attributes(e, {});
    refuse_children(e);
    const std::string_view id = model::trimmed(e.text);
    if (id.empty()) complaints_.add(e.where, in_tags(e.name), "needs an id as its text");
    if (id.size() > kLongestName)
        complaints_.add(
            e.where, in_tags(e.name),
            "the id has " + std::to_string(id.size()) + " characters; at most " + std::to_string(kLongestName) + " are allowed");
    return std::string(id.substr(0, kLongestName));
}

bool TreeReader::begin(const XmlElement& root)
{
    blueprint_.where = at(root.where);
    known_root_ = root.name == "plab" || root.name == "component";
    if (!known_root_)
    {
        complaints_.add(root.where, in_tags(root.name), "the root element must be <plab version=\"1\">, or <component> in a fragment");
        return true;
    }
    if (root.name == "component") return false;
    check_attributes(root, {"version"});
    const std::string version = required_name(root, "version");
    if (!version.empty() && version != "1")
        complaints_.add(root.where, "<plab>", "version " + model::quoted(version) + " is not known; this pLab reads version '1'");
    return true;
}

void TreeReader::child(XmlElement e)
{
    if (!known_root_) return;
    if (e.name == "scene")
        scene(e);
    else if (e.name == "component")
        blueprint_.components.push_back(component(e));
    else if (e.name == "repeat")
        blueprint_.repeats.push_back(repeat(e));
    else
        misplaced(e, "<plab>");
}

void TreeReader::end(XmlElement root)
{
    if (!known_root_) return;
    if (root.name == "component")
        blueprint_.components.push_back(component(root));
    else
        refuse_text(root);
}

void TreeReader::scene(const XmlElement& e)
{
    if (scene_at_.line > 0)
        return complaints_.add(e.where, "<scene>", "a second <scene>; the first is on line " + std::to_string(scene_at_.line));
    scene_at_ = e.where;
    for (const XmlAttribute& a : e.attributes) blueprint_.settings.push_back({a.name, a.value, {}, {}, {}, at(e.where)});
    refuse_text(e);
    for (const XmlElement& c : e.children)
        if (c.name == "camera")
            blueprint_.cameras.push_back(camera(c));
        else
            misplaced(c, "<scene>");
}

ComponentNode TreeReader::camera(const XmlElement& e)
{
    ComponentNode out;
    out.where = at(e.where);
    out.id = name_attribute(e, "id"), out.name = name_attribute(e, "name");
    for (const XmlAttribute& a : e.attributes)
        if (a.name == "type")
            complaints_.add(e.where, "<camera>", "unknown attribute 'type'");
        else if (a.name != "id" && a.name != "name")
            out.attributes.push_back({a.name, a.value, {}, {}, {}, at(e.where)});
    refuse_text(e);
    refuse_children(e);
    return out;
}

RepeatNode TreeReader::repeat(const XmlElement& e)
{
    RepeatNode out;
    out.where = at(e.where);
    for (const XmlAttribute& a : e.attributes) out.attributes.push_back({a.name, a.value, {}, {}, {}, at(e.where)});
    refuse_text(e);
    for (const XmlElement& c : e.children)
        if (c.name == "component")
            out.components.push_back(component(c));
        else
            misplaced(c, "<repeat>");
    return out;
}

ComponentNode TreeReader::component(const XmlElement& e)
{
    ComponentNode out;
    out.where = at(e.where);
    out.id = name_attribute(e, "id"), out.name = name_attribute(e, "name"), out.type = name_attribute(e, "type");
    for (const XmlAttribute& a : e.attributes)
        if (a.name != "id" && a.name != "name" && a.name != "type") out.attributes.push_back({a.name, a.value, {}, {}, {}, at(e.where)});
    refuse_text(e);
    bool after_command = false;
    for (const XmlElement& c : e.children)
    {
        component_part(c, out, after_command);
        after_command = c.name == "command" || (after_command && c.name == "cmdparam");
    }
    return out;
}

void TreeReader::component_part(const XmlElement& e, ComponentNode& out, bool after_command)
{
    if (e.name == "component")
        out.children.push_back(component(e));
    else if (e.name == "command")
        out.commands.push_back(command(e));
    else if (e.name == "param")
        out.parameters.push_back(parameter(e));
    else if (e.name == "state")
        state(e, out);
    else if (e.name == "compref")
        out.references.push_back(reference(e)), out.reference_places.push_back(at(e.where));
    else if (e.name == "cmdparam" && after_command)
        out.commands.back().parameters.push_back(command_parameter(e));
    else if (const ForeignHandler* handler = handlers_.find(e.name))
        foreign(e, *handler, out);
    else
        misplaced(e, "<component>");
}

void TreeReader::foreign(const XmlElement& e, const ForeignHandler& handler, ComponentNode& out)
{
    Result<std::vector<model::ValueNode>> values = handler.read(e);
    if (!values)
    {
        for (const Error& error : values.errors()) complaints_.add(error);
        return;
    }
    for (model::ValueNode& v : *values)
    {
        const auto same = [&](const model::ValueNode& other) { return other.name == v.name; };
        if (std::any_of(out.values.begin(), out.values.end(), same))
            return complaints_.add(e.where, in_tags(e.name), "the component has its " + v.name + " already");
        v.where.file = blueprint_.file;
        out.values.push_back(std::move(v));
    }
    if (out.type.empty()) out.type = handler.implied_type;
}

void TreeReader::state(const XmlElement& e, ComponentNode& out)
{
    const auto is_state = [](const TextNode& p) { return p.name == "state"; };
    auto at_state = std::find_if(out.parameters.begin(), out.parameters.end(), is_state);
    if (at_state == out.parameters.end())
    {
        out.parameters.push_back({"state", {}, {}, {}, {}, at(e.where)});
        at_state = std::prev(out.parameters.end());
    }
    add_entry(e, *at_state);
}

void TreeReader::add_entry(const XmlElement& e, TextNode& out)
{
    check_attributes(e, {"name"});
    refuse_children(e);
    const std::string name = required_name(e, "name");
    if (name.empty()) return;
    for (const Entry& other : out.entries)
        if (other.name == name) return complaints_.add(e.where, in_tags(e.name), model::quoted(name) + " is given twice");
    auto value = parse_entry(e.text);
    if (!value) return complaints_.add(e.where, in_tags(e.name), model::quoted(name) + ": " + value.error().reason);
    out.entries.push_back({name, value.take()});
}

TextNode TreeReader::parameter(const XmlElement& e)
{
    check_attributes(e, {"name"});
    TextNode out;
    out.where = at(e.where), out.name = required_name(e, "name");
    for (const XmlElement& c : e.children)
        if (c.name == "entry")
            add_entry(c, out);
        else if (c.name == "compref")
            out.component_references.push_back(reference(c));
        else
            misplaced(c, "<param>");
    if (!out.entries.empty() && !out.component_references.empty())
        complaints_.add(e.where, "<param>", "holds either <entry> or <compref>, not both");
    if (e.children.empty())
        out.text = e.text;
    else
        refuse_text(e);
    return out;
}

CommandNode TreeReader::command(const XmlElement& e)
{
    check_attributes(e, {"id", "name", "subject", "type"});
    refuse_text(e);
    CommandNode out;
    out.where = at(e.where);
    out.id = name_attribute(e, "id"), out.name = name_attribute(e, "name");
    out.subject = name_attribute(e, "subject"), out.type = name_attribute(e, "type");
    for (const XmlElement& c : e.children)
    {
        if (c.name == "command")
            out.children.push_back(command(c));
        else if (c.name == "cmdref")
        {
            CommandNode& named = out.children.emplace_back();
            named.where = at(c.where), named.reference = reference(c);
        }
        else if (c.name == "cmdparam" && !out.children.empty() && !out.children.back().reference.empty())
            complaints_.add(c.where, "<cmdparam>", "cannot follow a <cmdref>; it belongs where the command is defined");
        else if (c.name == "cmdparam")  // figure 6 of the paper: right after a command, it belongs to that command
            (out.children.empty() ? out : out.children.back()).parameters.push_back(command_parameter(c));
        else
            misplaced(c, "<command>");
    }
    return out;
}

TextNode TreeReader::command_parameter(const XmlElement& e)
{
    check_attributes(e, {"type"});
    refuse_text(e);
    TextNode out;
    out.where = at(e.where), out.name = required_name(e, "type");
    std::size_t values = 0;
    for (const XmlElement& c : e.children)
        if (c.name != "udata")
            misplaced(c, "<cmdparam>");
        else if (++values == 1)
            command_value(c, out);
    if (values != 1) complaints_.add(e.where, "<cmdparam>", "needs one <udata>, not " + std::to_string(values));
    return out;
}

void TreeReader::command_value(const XmlElement& udata, TextNode& out)
{
    check_attributes(udata, {});
    for (const XmlElement& c : udata.children)
        if (c.name == "compref")
            out.component_references.push_back(reference(c));
        else if (c.name == "cmdref")
            out.command_references.push_back(reference(c));
        else
            misplaced(c, "<udata>");
    if (udata.children.empty())
        out.text = udata.text;
    else
        refuse_text(udata);
}

}  // namespace plab::blueprint
