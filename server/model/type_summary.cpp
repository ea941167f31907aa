#include "model/type_summary.h"

#include <algorithm>
#include <limits>

#include "model/measured_costs.h"
#include "model/numbers.h"
#include "model/values.h"

namespace plab::model
{
namespace
{

std::string words_of(const Rule& rule)
{
    switch (rule.kind)
    {
        case Rule::Kind::AtLeast:
            return "at least " + format_real(rule.bound);
        case Rule::Kind::MoreThan:
            return rule.bound == 0 ? "positive" : "more than " + format_real(rule.bound);
        case Rule::Kind::AtMost:
            return "at most " + format_real(rule.bound);
        case Rule::Kind::NonZero:
            return "not zero";
        case Rule::Kind::UnitLength:
            return "a direction";
        case Rule::Kind::OneOf:
            break;
    }
    std::string out = "one of";
    for (const std::string& option : rule.options) out += (&option == &rule.options.front() ? " " : ", ") + option;
    return out;
}

FieldSummary summary_of(const Field& field)
{
    FieldSummary out;
    out.name = field.name, out.doc = field.doc;
    out.kind = name_of(field.kind), out.value_type = name_of(field.type), out.unit = field.unit.symbol;
    out.rule = rules_in_words(field);
    if (field.kind == FieldKind::Output) return out;
    out.required = field.required;
    if (!field.required) out.fallback = format_value(field.fallback);
    return out;
}

RoleSummary summary_of(const Role& role)
{
    constexpr std::size_t kAny = std::numeric_limits<std::uint32_t>::max();
    RoleSummary out;
    out.name = role.name, out.doc = role.doc;
    out.accepts = facets_in_words(role) + (role.family.empty() ? "" : " " + role.family);
    out.least = static_cast<std::uint32_t>(std::min(role.min, kAny));
    out.most = static_cast<std::uint32_t>(std::min(role.max, kAny));
    return out;
}

}  // namespace

std::string_view name_of(FieldKind kind)
{
    constexpr std::string_view names[] = {"param", "state", "output", "scratch"};
    return names[static_cast<std::size_t>(kind)];
}

std::string_view name_of(FieldType type)
{
    constexpr std::string_view names[] = {"none",   "boolean", "integer", "real",     "vector",  "rotation",
                                          "matrix", "text",    "reals",   "integers", "entries", "opaque"};
    return names[static_cast<std::size_t>(type)];
}

std::string rules_in_words(const Field& field)
{
    std::string out;
    for (const Rule& rule : field.rules) out += (out.empty() ? "" : ", ") + words_of(rule);
    if (field.may_be_infinite) out += std::string(out.empty() ? "" : ", ") + "may be infinite";
    return out;
}

std::string facets_in_words(const Role& role)
{
    constexpr std::string_view names[] = {"component", "body", "shaft", "shape", "quantities"};
    std::string out;
    for (const Facet f : role.facets) out += (out.empty() ? "" : " or ") + std::string(names[static_cast<std::size_t>(f)]);
    return out;
}

TypeSummary summary_of(const ComponentType& type)
{
    TypeSummary out;
    out.name = type.info.name, out.family = type.info.family, out.doc = type.info.doc, out.plugin = type.plugin;
    out.loaded = true, out.order = type.info.order;
    out.accuracy = type.info.accuracy, out.strengths = type.info.strengths;
    out.cost = type.info.cost;
    if (const std::string measured = measured_cost_of(type.info.name); !measured.empty())
        out.cost += (out.cost.empty() ? "" : "; ") + ("measured, a step: " + measured);
    out.limits = type.info.limits, out.source = type.info.source;
    for (const Role& role : type.schema.roles()) out.roles.push_back(summary_of(role));
    for (const Field& field : type.schema.fields())
        if (field.kind != FieldKind::Scratch) out.fields.push_back(summary_of(field));
    return out;
}

}  // namespace plab::model
