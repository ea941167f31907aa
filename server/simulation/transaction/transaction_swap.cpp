// Swaps: what a new component takes over from the old one, and how it takes its place.
#include <algorithm>

#include "model/names.h"
#include "model/values.h"
#include "simulation/run/field_change.h"
#include "simulation/transaction/transaction.h"

namespace plab::simulation
{
namespace
{

bool carries_over(FieldKind kind) { return kind == FieldKind::Param || kind == FieldKind::State; }

struct Carried
{
    Value value;  ///< empty: the default of the new type
    FieldTransfer transfer = FieldTransfer::Fresh;
};

/// The value of one field of the new type: from the request if given there, else the present value of the old component, else the
/// default.
Result<Carried> carry_over(const world::World& world, std::uint32_t component, const Field& field, const SwapOperation& op)
{
    Carried out;
    const Field* before = world.type_of(component)->schema.find_field(field.name);
    if (before && carries_over(before->kind)) out = {world.get(component, field.name), FieldTransfer::Kept};
    if (const auto* integer = std::get_if<std::int64_t>(&out.value); integer && field.type == FieldType::Real)
        out = {static_cast<double>(*integer), FieldTransfer::Converted};
    const auto given = std::find_if(op.values.begin(), op.values.end(), [&](const NamedValue& v) { return v.name == field.name; });
    if (given != op.values.end())
    {
        const auto* text = std::get_if<std::string>(&given->value);
        auto parsed = text ? model::parse_value(*text, field) : Result<Value>(std::get<Value>(given->value));
        if (!parsed) return reason(field.name + ": " + parsed.error().reason);
        out = {*parsed, FieldTransfer::Given};
    }
    if (type_of(out.value) != field.type)
    {
        if (field.required)
            return reason(op.type + " needs " + field.name + ", which " + world.type_of(component)->info.name + " does not have");
        return Carried{};
    }
    // A kept value keeps its bits. It is checked all the same, because the rules of the new type may be stricter.
    Value checked = out.value;
    if (auto fits = model::check_value(checked, field); !fits) return reason(field.name + ": " + fits.error().reason);
    if (out.transfer != FieldTransfer::Kept) out.value = checked;
    return out;
}

/// Of the fields that a swap may give.
std::vector<std::string> names_in(const model::ComponentType& type)
{
    std::vector<std::string> out;
    for (const Field& field : type.schema.fields())
        if (carries_over(field.kind)) out.push_back(field.name);
    return out;
}

}  // namespace

void Transaction::fit_roles(model::ComponentSpec& spec, const Schema& schema, SwapReport& report) const
{
    for (const model::RoleSpec& role : spec.roles)
        if (!schema.find_role(role.name)) report.fields.push_back({role.name, FieldTransfer::Lost});
    std::erase_if(spec.roles, [&](const model::RoleSpec& r) { return !schema.find_role(r.name); });
    for (const Role& role : schema.roles())
    {
        const bool given = std::any_of(spec.roles.begin(), spec.roles.end(), [&](const model::RoleSpec& r) { return r.name == role.name; });
        // A component that names no solver uses the scene's, also after a swap from a type that needs none.
        if (!given && role.family == "Solver/" && run_->world().find(run_->world().scene().settings.solver) != kNoIndex)
            spec.roles.push_back({role.name, {run_->world().scene().settings.solver}, false, {}});
    }
}

/// A required role that the old type did not have is filled as in the short form of a blueprint: with a part of the role's default type.
/// The part remains when the component is swapped back, and is used again by the next swap.
Result<void> Transaction::make_missing(model::ComponentSpec& spec, const Schema& schema, SwapReport& report)
{
    for (const Role& role : schema.roles())
    {
        const bool given = std::any_of(spec.roles.begin(), spec.roles.end(), [&](const model::RoleSpec& r) { return r.name == role.name; });
        if (given || role.min == 0) continue;
        if (role.default_type.empty())
            return reason(spec.type + " needs a participant in the role '" + role.name + "', which the old type does not have");
        model::ComponentSpec part;
        part.id = spec.id + "." + role.name, part.type = role.default_type, part.generated = true;
        if (run_->world().find(part.id) == kNoIndex)
        {
            model::SceneSpec fragment;
            fragment.components.push_back(part);
            saved_.add_backup();
            if (auto added = run_->world().add(fragment); !added) return added;
            touched_.push_back(part.id);
        }
        spec.roles.push_back({role.name, {part.id}, false, {}});
        report.fields.push_back({role.name, FieldTransfer::Fresh});
    }
    return {};
}

Result<model::ComponentSpec> Transaction::spec_for_swap(std::uint32_t component, const SwapOperation& op, SwapReport& report)
{
    world::World& world = run_->world();
    const model::ComponentType& old = *world.type_of(component);
    const std::string element = op.id + " (" + old.info.name + ")";
    auto found = world.types().require(op.type);
    if (!found) return found.errors();
    const model::ComponentType& type = **found;
    if (const std::string why = type.why_not_exchangeable(old); !why.empty())
        return Error{{}, element, "cannot be exchanged for " + op.type + ": " + why};

    const model::SceneSpec& scene = world.scene();
    model::ComponentSpec spec = scene.components[scene.position_of(world.id_of(component), component)];
    spec.type = op.type;
    spec.fields.clear();
    Errors errors;
    for (const Field& field : type.schema.fields())
    {
        if (!carries_over(field.kind)) continue;
        auto carried = carry_over(world, component, field, op);
        if (!carried)
        {
            errors.push_back({{}, element, carried.error().reason});
            continue;
        }
        if (carried->transfer != FieldTransfer::Fresh) spec.fields.push_back({field.name, carried->value, {}});
        report.fields.push_back({field.name, carried->transfer});
    }
    for (const Field& field : old.schema.fields())
        if (carries_over(field.kind) && !type.schema.find_field(field.name)) report.fields.push_back({field.name, FieldTransfer::Lost});
    for (const NamedValue& v : op.values)
        if (const Field* field = type.schema.find_field(v.name); !field || !carries_over(field->kind))
            errors.push_back({{}, element, op.type + " has no parameter '" + v.name + "'" + model::did_you_mean(v.name, names_in(type))});
    if (!errors.empty()) return errors;
    fit_roles(spec, type.schema, report);
    if (auto done = make_missing(spec, type.schema, report); !done) return done.errors();
    // If the scene selects commands explicitly, the selection is kept as far as the new type has these commands.
    if (spec.explicit_commands) std::erase_if(spec.commands, [&](const std::string& c) { return type.find_command(c) < 0; });
    return spec;
}

Result<void> Transaction::exchange(std::uint32_t component, const model::ComponentSpec& spec, const SwapReport& report)
{
    world::World& world = run_->world();
    const BodyMotion before = motion_of(world, component);
    if (auto done = world.exchange(component, spec); !done) return done;
    keep_motion(world, component, before);
    // The host tables keep the motion of objects; values that the request gives for it are set there.
    for (const TransferredField& f : report.fields)
    {
        const Field* field = world.type_of(component)->schema.find_field(f.field);
        if (f.transfer != FieldTransfer::Given || !field || !field->hosted) continue;
        const auto given =
            std::find_if(spec.fields.begin(), spec.fields.end(), [&](const model::FieldSpec& v) { return v.name == f.field; });
        if (auto done = world.set(component, f.field, given->value); !done) return done;
    }
    return prepare_dependents(world, component, prepared_);
}

Result<void> Transaction::apply_one(const SwapOperation& asked)
{
    structural_ = true;
    auto component = find_typed(asked.id);
    if (!component) return component.errors();
    SwapReport report;
    report.id = run_->world().id_of(*component), report.from = run_->world().type_of(*component)->info.name;
    if (known_types_.empty()) known_types_ = run_->world().types().names();
    auto name = model::full_type_name(asked.type, known_types_, report.from.substr(0, report.from.rfind('/') + 1));
    if (!name) return Error{{}, report.id + " (" + report.from + ")", name.error().reason};
    SwapOperation op = asked;
    op.type = report.to = name.take();
    auto spec = spec_for_swap(*component, op, report);
    if (!spec) return spec.errors();
    held_before_.push_back(held_points(*component));
    if (auto done = exchange(*component, *spec, report); !done) return done;
    touched_.push_back(report.id);
    reply_.swaps.push_back(std::move(report));
    return {};
}

}  // namespace plab::simulation
