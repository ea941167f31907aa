#include "rule.h"

#include "expression.h"
#include "template_text.h"

namespace plab::rules
{

void SideColumns::describe(Schema& schema, const std::string& side)
{
    schema.param(ids, side, unit::one, "patterns of ids of the objects that can be " + side).or_else("*");
    schema.param(type, side + "_type", unit::one, "patterns of their types; empty: any").or_else("");
    schema.param(shape, side + "_shape", unit::one, "patterns of the type of their shape; empty: any, or none").or_else("");
    schema
        .param(connector, side + "_connector", unit::one,
               "patterns of the kind of a connector on them; empty: the object itself is looked at")
        .or_else("");
    schema.param(most, side + "_most", unit::one, "for how many pairs at once it can be " + side + "; 0: any number")
        .or_else(0)
        .at_least(0);
}

void RuleRows::describe(Schema& schema)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    a.describe(schema, "a"), b.describe(schema, "b");
    schema.param(relation, "relation", unit::one, "how the frames must lie to one another").or_else("near").one_of(relation_names());
    schema.param(reach, "reach", unit::metre, "largest distance between the origins of the two frames").positive();
    schema.param(tolerance, "tolerance", unit::metre, "of the relation").or_else(0.01).not_negative();
    schema.param(along, "along", unit::metre, "largest distance along the z axis of a").or_else(kInfinity).not_negative().may_be_infinite();
    schema.param(angle, "angle", unit::radian, "largest angle between the z axes, in either direction")
        .or_else(kInfinity)
        .not_negative()
        .may_be_infinite();
    schema.param(hold, "hold", unit::one, "the two have parted when the bounds times this are exceeded").or_else(1.5).at_least(1);
    schema.param(text, "template", unit::one,
                 "blueprint of what is added; a dollar sign with braces stands for values of the two, see server/docs/rules.md");
    schema.param(removes, "removes", unit::one, "what was added is removed when the two part").or_else(false);
    schema.param(priority, "priority", unit::one, "the higher one of two rules gets a pair").or_else(0);
    schema.param(slot, "slot", unit::one, "rules with the same slot exclude one another for a pair of objects").or_else("");
    schema.param(code, "code", unit::one, "Lua text that defines applies(); empty: no further condition").or_else("");
    schema.param(values, "values", unit::one, "further values for the template: numbers, or expressions as text").or_else({});
    schema.param(draw, "draw", unit::one, "w / 2 pi with which the two are drawn together first, Hz; 0: they are not")
        .or_else(0)
        .not_negative();
    schema.param(draw_by, "draw_by", unit::one, "what draws them")
        .or_else("Constraint/Snap/Acceleration")
        .one_of({"Constraint/Snap/Acceleration", "Constraint/Snap/Force"});
    schema.param(turns, "turns", unit::one, "drawing turns all axes into one another, not only the z axes").or_else(false);
    schema.param(latch, "latch", unit::metre, "distance at which what was drawn together is latched").or_else(1e-4).positive();
    schema.param(latch_angle, "latch_angle", unit::radian, "angle at which it is").or_else(1e-3).positive();
    schema.param(latch_speed, "latch_speed", unit::metre_per_second, "relative speed at which it is").or_else(1e-3).positive();
    schema.param(couples, "couples", unit::one, "turns of b per turn of a that the template forces; empty: it does not couple turns")
        .or_else("");
    schema.state(links, "links", unit::one, "what it made or is about to make, by id: progress, a and b");
    schema.state(made, "made", unit::one, "how many times it has asked for the template");
    schema.scratch(memory, "memory", "the objects that match, and those that are near one another");
}

namespace
{

/// Of values that are given as expressions.
Result<void> check_values(const Entries& values)
{
    for (const Entry& entry : values)
        if (const auto* text = std::get_if<std::string>(&entry.value))
            if (auto fine = check_expression(*text); !fine) return reason("values: " + entry.name + ": " + fine.error().reason);
    return {};
}

/// As the script sees them: numbers.
Entries as_numbers(Entries values)
{
    for (Entry& entry : values)
        if (std::holds_alternative<std::string>(entry.value)) entry.value = 0.0;
    return values;
}

}  // namespace

Result<void> prepare_rule(const StepContext& context, Row row, RuleRows& rules)
{
    if (auto fine = check_template(rules.text[row]); !fine) return fine;
    if (auto fine = check_values(rules.values[row]); !fine) return fine;
    if (!rules.couples[row].empty())
        if (auto fine = check_expression(rules.couples[row]); !fine) return reason("couples: " + fine.error().reason);
    auto memory = std::make_unique<Memory>();
    if (!rules.code[row].empty())
    {
        memory->condition = std::make_unique<Condition>();
        if (auto loaded = memory->condition->load(rules.code[row], as_numbers(rules.values[row]), context, row); !loaded)
            return reason("code: " + loaded.error().reason);
    }
    rules.memory[row] = std::move(memory);
    return {};
}

}  // namespace plab::rules
