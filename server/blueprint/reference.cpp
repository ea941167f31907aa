#include <algorithm>

#include "blueprint/writer.h"
#include "model/measured_costs.h"
#include "model/names.h"
#include "model/text.h"
#include "model/type_summary.h"
#include "model/values.h"

namespace plab::blueprint
{
namespace
{

constexpr std::string_view kTypeNames[] = {
    "",     "truth value",     "whole number",          "number",  "vector", "rotation", "symmetric matrix",
    "text", "list of numbers", "list of whole numbers", "entries", "opaque"};

/// A table cell: one line, without vertical bars.
std::string cell(std::string_view text)
{
    std::string out;
    for (const char c : text)
        if (c == '|')
            out += "\\|";
        else
            out += c == '\n' ? ' ' : c;
    return out;
}

std::string row(std::initializer_list<std::string> cells)
{
    std::string out = "|";
    for (const std::string& c : cells) out += " " + cell(c) + " |";
    return out + "\n";
}

std::string default_of(const Field& field)
{
    if (field.kind == FieldKind::Output) return "";
    if (field.required) return "required";
    const std::string text = model::format_value(field.fallback);
    return text.empty() ? "empty" : "`" + text + "`";
}

std::string fields_of(const Schema& schema)
{
    std::string rows;
    for (const Field& f : schema.fields())
        if (f.kind != FieldKind::Scratch)
            rows += row({"`" + f.name + "`", std::string(model::name_of(f.kind)), std::string(kTypeNames[static_cast<std::size_t>(f.type)]),
                         std::string(f.unit.symbol), default_of(f), model::rules_in_words(f), f.doc});
    if (rows.empty()) return {};
    return "\n| field | kind | type | unit | default | rule | meaning |\n|---|---|---|---|---|---|---|\n" + rows;
}

std::string takers_of(const Role& role) { return model::facets_in_words(role) + (role.family.empty() ? "" : " `" + role.family + "...`"); }

std::string arity_of(const Role& role)
{
    if (role.many) return role.min == 0 ? "any number" : std::to_string(role.min) + " or more";
    return role.min == 0 ? "0 or 1" : "1";
}

std::string roles_of(const Schema& schema)
{
    std::string rows;
    for (const Role& r : schema.roles())
    {
        std::string meaning = r.doc;
        if (!r.default_type.empty()) meaning += "; by default a `" + r.default_type + "`";
        if (r.exclusive) meaning += "; no other component may act on it in this role";
        rows += row({"`" + r.name + "`", takers_of(r), arity_of(r), r.writes ? "acts on it" : "reads it", meaning});
    }
    if (rows.empty()) return {};
    return "\n| role | takes | how many | access | meaning |\n|---|---|---|---|---|\n" + rows;
}

std::string commands_of(const TypeInfo& info)
{
    std::string rows;
    for (const CommandInfo& c : info.commands)
        rows += row({"`" + c.name + "`", std::string(name_of(stage_of(c.phase))), std::string(name_of(c.phase)), c.doc});
    if (rows.empty()) return {};
    return "\n| command | stage | phase | meaning |\n|---|---|---|---|\n" + rows;
}

std::string facts_of(const TypeInfo& info)
{
    std::string out;
    const auto fact = [&](std::string_view name, const std::string& value)
    {
        if (!value.empty()) out += "- " + std::string(name) + ": " + value + "\n";
    };
    fact("exchangeable within", "`" + info.family + "`");
    // For a resolution, the order of convergence is not that of the motion: it is how its trials approach the time of impact.
    const bool searches = info.name.starts_with("Resolution/");
    fact(searches ? "order of its search for the time of impact" : "order of convergence",
         info.order > 0 ? std::to_string(info.order) : "");
    fact("accuracy", info.accuracy);
    fact("good for", info.strengths);
    fact("cost", info.cost);
    fact("measured, a step", model::measured_cost_of(info.name));
    fact("limits", info.limits);
    fact("source", info.source);
    return out;
}

/// The interface of a type's opaque part (no field, role or command), if the declaration describes it in a section of its own.
std::string manual_of(const Schema& schema)
{
    std::string out;
    for (const Field& f : schema.fields())
        if (f.kind == FieldKind::Scratch && f.doc.starts_with("\n#### ")) out += f.doc;
    return out;
}

/// Compares the costs of the types whose names begin with these prefixes; `names`: the existing types.
std::string ladders_of(std::string_view prefix, const std::vector<std::string>& names)
{
    std::string rows;
    for (model::MeasuredLadder& ladder : model::measured_ladders(prefix))
    {
        std::erase_if(ladder.algorithms,
                      [&](const auto& algorithm) { return std::find(names.begin(), names.end(), algorithm.type) == names.end(); });
        if (ladder.algorithms.size() > 1) rows += row({"`" + std::string(ladder.family) + "`", std::string(ladder.scene), ladder.text()});
    }
    if (rows.empty()) return {};
    return "Measured: microseconds per step of 1/240 s, one thread, cheapest first; `~`: within a tenth of the previous one. A type that "
           "is "
           "missing cannot be used there.\n\n| of | scene | types by cost |\n|---|---|---|\n" +
           rows;
}

std::string reference_of(model::TypeSource& types, const std::string& name)
{
    const std::string title = "### " + name + "\n\n";
    const auto type = types.require(name);
    if (!type) return title + "Cannot be loaded: " + type.error().text() + "\n";
    const model::ComponentType& t = **type;
    return title + t.info.doc + "\n\n" + facts_of(t.info) + roles_of(t.schema) + fields_of(t.schema) + commands_of(t.info) +
           manual_of(t.schema);
}

}  // namespace

std::string write_reference(model::TypeSource& types)
{
    std::string out = "# Component types\n\nGenerated from the types' own declarations. Values are in SI units and radians.\n";
    std::string kind;
    const std::vector<std::string> names = types.names();
    for (const std::string& name : names)
    {
        if (const std::string its = name.substr(0, name.find('/')); its != kind)
        {
            out += "\n## " + (kind = its) + "\n";
            if (const std::string ladders = ladders_of(kind + "/", names); !ladders.empty()) out += "\n" + ladders;
        }
        out += "\n" + reference_of(types, name);
    }
    return out;
}

Result<std::string> write_reference(model::TypeSource& types, const std::string& which)
{
    const std::vector<std::string> names = types.names();
    const std::string kind = which.ends_with('/') ? which : which + "/";
    std::string out = ladders_of(kind, names);
    for (const std::string& name : names)
        if (name.starts_with(kind)) out += (out.empty() ? "" : "\n") + reference_of(types, name);
    if (!out.empty()) return out;
    auto name = model::full_type_name(which, names, {});
    if (!name) return name.errors();
    if (std::find(names.begin(), names.end(), *name) == names.end())
        return reason("unknown type " + model::quoted(which) + model::did_you_mean(which, names));
    return reference_of(types, *name);
}

}  // namespace plab::blueprint
