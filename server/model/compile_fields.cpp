/// What authors specify about a component: attributes, <param>, embedded values and cmdparams, assigned to fields and roles.

#include <algorithm>
#include <array>

#include "model/compile_internal.h"
#include "model/names.h"
#include "model/text.h"
#include "model/values.h"

namespace plab::model::detail
{

namespace
{

/// Names in the paper's listings that pLab's types declare under other names.
struct Alias
{
    std::string_view papers, ours;
};
constexpr std::array<Alias, 3> kPapersNames{{{"target_state", "driven"}, {"source_state", "driver"}, {"code", "code"}}};

std::size_t index_of_field(const Schema& schema, std::string_view name)
{
    for (std::size_t k = 0; k < schema.fields().size(); ++k)
        if (schema.fields()[k].name == name) return k;
    return kNone;
}

std::size_t index_of_role(const Schema& schema, std::string_view name)
{
    for (std::size_t k = 0; k < schema.roles().size(); ++k)
        if (schema.roles()[k].name == name) return k;
    return kNone;
}

bool is_settable(const Field& field)
{
    return (field.kind == FieldKind::Param || field.kind == FieldKind::State) && field.type != FieldType::Opaque;
}

std::vector<std::string> settable_names(const Schema& schema)
{
    std::vector<std::string> names;
    for (const Field& f : schema.fields())
        if (is_settable(f)) names.push_back(f.name);
    for (const Role& r : schema.roles()) names.push_back(r.name);
    return names;
}

/// Checks that the field may be set and is not set yet.
bool may_set(Compilation& c, std::size_t i, std::size_t field_index, const SourceLocation& where)
{
    const Draft& d = c.draft(i);
    const Field& field = d.type->schema.fields()[field_index];
    if (!is_settable(field))
    {
        const std::string what = field.kind == FieldKind::Output ? "an output" : "working memory";
        return c.complain(i, where, field.name + " is " + what + " of " + d.type_name + " and cannot be set"), false;
    }
    for (const GivenField& given : d.fields)
        if (given.index == field_index)
            return c.complain(i, where, field.name + " is given twice, here and at " + place_text(given.where)), false;
    return true;
}

void give_field(Compilation& c, std::size_t i, std::size_t field_index, const TextNode& text)
{
    if (!may_set(c, i, field_index, text.where)) return;
    Draft& d = c.draft(i);
    const Field& field = d.type->schema.fields()[field_index];
    GivenField& given = d.fields.emplace_back();  // added even if the value is bad, so that the field does not count as missing
    given.index = field_index;
    given.where = text.where;
    given.value = field.fallback;
    if (!text.component_references.empty() || !text.command_references.empty())
        return c.complain(i, text.where, field.name + " takes a value, not a reference");
    const bool has_entries = !text.entries.empty();
    if (has_entries && field.type != FieldType::EntryList) return c.complain(i, text.where, field.name + " takes a value, not entries");
    Value entries(text.entries);
    Result<Value> value = has_entries ? Result<Value>(std::move(entries)) : parse_value(text.text, field);
    if (value && has_entries)
        if (Result<void> checked = check_value(*value, field); !checked) value = checked.errors();
    if (!value) return c.complain(i, text.where, value.error().reason);
    given.value = value.take();
}

void give_embedded(Compilation& c, std::size_t i, const ValueNode& node)
{
    const Draft& d = c.draft(i);
    const std::size_t k = index_of_field(d.type->schema, node.name);
    if (k == kNone)
        return c.complain(i, node.where, "embedded XML gives " + quoted(node.name) + ", which " + d.type_name + " does not have");
    if (!may_set(c, i, k, node.where)) return;
    Value value = node.value;
    if (Result<void> checked = check_value(value, d.type->schema.fields()[k]); !checked) c.complain(i, node.where, checked.error().reason);
    c.draft(i).fields.push_back({k, std::move(value), node.where});
}

/// Takes a word as the id that it is; otherwise as a pattern of ids, if it looks like one. `*` stands for all only where it is alone.
void add_reference(const Compilation& c, GivenRole& given, std::string id, const SourceLocation& where)
{
    if (!is_pattern(id) || id == "*" || c.directory.find(id) != kNone) return (void)given.references.push_back({std::move(id), where});
    given.everyone = true;
    given.patterns.push_back(std::move(id));
}

/// Ids given by <compref> and <cmdref>; false after an error was reported.
bool read_references(Compilation& c, std::size_t i, const TextNode& text, const Cell* cell, GivenRole& given)
{
    if (!trimmed(text.text).empty())
        return c.complain(i, text.where, "give either ids or references, not both: " + quoted(trimmed(text.text))), false;
    for (const std::string& id : text.component_references) add_reference(c, given, component_id(cell, id), text.where);
    for (const std::string& written : text.command_references)
    {
        const std::string id = command_id(cell, written);
        const auto it = c.command_index.find(id);
        if (it == c.command_index.end()) return c.complain(i, text.where, "cmdref: no command has the id " + quoted(id)), false;
        const std::string subject = written_subject(c, c.commands[it->second]);
        if (subject.empty())
            return c.complain(i, text.where, "cmdref: command " + quoted(id) + " is a composite and has no subject"), false;
        given.references.push_back({subject, text.where});
    }
    return true;
}

void read_ids(Compilation& c, const TextNode& text, const Cell* cell, GivenRole& given)
{
    const std::string whole(trimmed(text.text));
    // An id may contain blanks.
    if (c.directory.find(component_id(cell, whole)) != kNone)
    {
        given.references.push_back({component_id(cell, whole), text.where});
        return;
    }
    const std::vector<std::string_view> words = split_words(whole);
    given.may_be_type = words.size() == 1 && !is_pattern(whole);
    for (const std::string_view word : words) add_reference(c, given, component_id(cell, std::string(word)), text.where);
}

void give_role(Compilation& c, std::size_t i, std::size_t role_index, const TextNode& text, const Cell* cell)
{
    Draft& d = c.draft(i);
    const Role& role = d.type->schema.roles()[role_index];
    GivenRole& given = d.roles[role_index];
    if (given.given) return c.complain(i, text.where, role.name + " is given twice, here and at " + place_text(given.where));
    given.given = true;
    given.where = text.where;
    if (!text.entries.empty())
    {
        given.unresolved = true;
        return c.complain(i, text.where, role.name + " takes ids, not entries");
    }
    if (!text.component_references.empty() || !text.command_references.empty())
        given.unresolved = !read_references(c, i, text, cell, given);
    else if (trimmed(text.text) == "*")
        given.everyone = true;
    else if (!trimmed(text.text).empty())
        read_ids(c, text, cell, given);
    else
    {
        given.unresolved = true;
        c.complain(i, text.where, role.name + " names no component: give ids, or leave it out");
    }
}

/// The only open role that the referenced component may take; otherwise kNone.
std::size_t only_fitting_role(Compilation& c, std::size_t i, const TextNode& text, const Cell* cell)
{
    GivenRole probe;
    if (text.component_references.empty() && text.command_references.empty())
        read_ids(c, text, cell, probe);
    else if (!read_references(c, i, text, cell, probe))
        return kNone;
    std::size_t found = kNone;
    const Draft& d = c.draft(i);
    for (std::size_t k = 0; k < d.roles.size(); ++k)
    {
        const Role& role = d.type->schema.roles()[k];
        const bool fits = !probe.references.empty() && !d.roles[k].given &&
                          !find_participants(c.directory, probe.references.front().id, role).members.empty();
        if (fits && found != kNone) return kNone;
        if (fits) found = k;
    }
    return found;
}

/// What a user may have meant whose field is one of a part that is created where none is given: "response.friction" for "friction".
std::string did_you_mean_of_part(Compilation& c, const Schema& schema, const std::string& name)
{
    for (const Role& role : schema.roles())
    {
        if (role.default_type.empty() || !role.one) continue;
        const Result<const ComponentType*>& type = c.require(role.default_type);
        if (type.ok() && index_of_field((*type)->schema, name) != kNone) return ", did you mean " + quoted(role.name + "." + name) + "?";
    }
    return {};
}

void unknown_name(Compilation& c, std::size_t i, const std::string& name, const SourceLocation& where)
{
    const Schema& schema = c.draft(i).type->schema;
    const std::vector<std::string> known = settable_names(schema);
    const std::string of_part = did_you_mean_of_part(c, schema, name);
    c.complain(i, where,
               "unknown attribute " + quoted(name) + (of_part.empty() ? did_you_mean(name, known) : of_part) +
                   (known.empty() ? " (the type has none)" : " (known are " + quoted_list(known) + ")"));
}

}  // namespace

void give(Compilation& c, std::size_t i, const std::string& name, const TextNode& text, const Cell* cell)
{
    Draft& d = c.draft(i);
    const Schema& schema = d.type->schema;
    if (const std::size_t k = index_of_field(schema, name); k != kNone) return give_field(c, i, k, text);
    if (const std::size_t k = index_of_role(schema, name); k != kNone) return give_role(c, i, k, text, cell);
    const std::size_t dot = name.find('.');
    const std::size_t part = dot == std::string::npos ? kNone : index_of_role(schema, name.substr(0, dot));
    if (part == kNone) return unknown_name(c, i, name, text.where);
    if (d.parts_formed) return c.complain(i, text.where, quoted(name) + " comes too late: set it on the part itself");
    d.parts.push_back({part, name.substr(dot + 1), &text});
}

void give_by_setter(Compilation& c, std::size_t i, const TextNode& text, const Cell* cell)
{
    const Schema& schema = c.draft(i).type->schema;
    const std::string name = field_name_of_setter(text.name);
    if (index_of_field(schema, name) != kNone || index_of_role(schema, name) != kNone) return give(c, i, name, text, cell);
    // "SetAxis2" loses the underscore of axis_2.
    for (const std::string& known : settable_names(schema))
        if (setter_of_field_name(known) == text.name) return give(c, i, known, text, cell);
    for (const Alias& alias : kPapersNames)
    {
        if (name != alias.papers) continue;
        if (index_of_role(schema, alias.ours) != kNone) return give(c, i, std::string(alias.ours), text, cell);
        const std::size_t role = only_fitting_role(c, i, text, cell);
        if (role != kNone) return give_role(c, i, role, text, cell);
    }
    std::vector<std::string> known;
    for (const std::string& n : settable_names(schema)) known.push_back(setter_of_field_name(n));
    c.complain(i, text.where,
               "unknown parameter " + quoted(text.name) + did_you_mean(text.name, known) +
                   (known.empty() ? " (the type has none)" : " (known are " + quoted_list(known) + ")"));
}

void gather_fields(Compilation& c)
{
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i)
    {
        const Draft& d = c.draft(i);
        if (!d.node) continue;
        if (d.type_name.empty())
        {
            for (const auto* texts : {&d.node->attributes, &d.node->parameters})
                for (const TextNode& text : *texts)
                    c.complain(i, text.where, "a component without type has no " + quoted(text.name) + ": give it a type, or leave it out");
            for (const ValueNode& value : d.node->values)
                c.complain(i, value.where, "a component without type has no " + quoted(value.name) + ": give it a type");
        }
        if (!d.type) continue;
        for (const TextNode& text : d.node->attributes) give(c, i, text.name, text, d.cell);
        for (const TextNode& text : d.node->parameters) give(c, i, text.name, text, d.cell);
        for (const ValueNode& value : d.node->values) give_embedded(c, i, value);
    }
}

void finish_fields(Compilation& c)
{
    for (std::size_t i = 0; i < c.directory.drafts.size(); ++i)
    {
        Draft& d = c.draft(i);
        if (!d.type || d.existing) continue;
        std::sort(d.fields.begin(), d.fields.end(), [](const GivenField& a, const GivenField& b) { return a.index < b.index; });
        const std::deque<Field>& fields = d.type->schema.fields();
        for (std::size_t k = 0; k < fields.size(); ++k)
        {
            const auto has = [&](const GivenField& g) { return g.index == k; };
            if (!fields[k].required || std::any_of(d.fields.begin(), d.fields.end(), has)) continue;
            c.complain(i, d.where,
                       fields[k].name + " is missing: " + (fields[k].doc.empty() ? std::string("it has no default") : fields[k].doc));
        }
    }
}

}  // namespace plab::model::detail
