// Swaps: what a new component takes over from the old one, and its taking the place.
#include <algorithm>

#include "model/names.h"
#include "model/values.h"
#include "simulation/requests/field_change.h"
#include "simulation/requests/transaction.h"

namespace plab::simulation
{
namespace
{

bool carries_over(FieldKind kind) { return kind == FieldKind::Param || kind == FieldKind::State; }

struct Carried
{
    Value value;  ///< none: the new type's default
    FieldTransfer transfer = FieldTransfer::Fresh;
};

/// The value of one field of the new type: given by the request, else the old component's live one, else the default.
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
    // A value that is kept keeps its bits; it is checked all the same, the new type's rules may be stricter.
    Value checked = out.value;
    if (auto fits = model::check_value(checked, field); !fits) return reason(field.name + ": " + fits.error().reason);
    if (out.transfer != FieldTransfer::Kept) out.value = checked;
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
        // Whoever names no solver has the scene's, also after a swap from a type that needed none.
        if (!given && role.family == "Solver/" && s_->world_->find(s_->world_->scene().settings.solver) != kNoIndex)
            spec.roles.push_back({role.name, {s_->world_->scene().settings.solver}, false, {}});
    }
}

/// A required role that the old type did not have is filled as the short form of a blueprint would: by a part of its
/// default type. It stays when the component is exchanged back, and serves again.
Result<void> Transaction::make_missing(model::ComponentSpec& spec, const Schema& schema, SwapReport& report)
{
    for (const Role& role : schema.roles())
    {
        const bool given = std::any_of(spec.roles.begin(), spec.roles.end(), [&](const model::RoleSpec& r) { return r.name == role.name; });
        if (given || role.min == 0) continue;
        if (role.default_type.empty())
            return reason(spec.type + " needs somebody in the role '" + role.name + "', which the old type does not have");
        model::ComponentSpec part;
        part.id = spec.id + "." + role.name, part.type = role.default_type, part.generated = true;
        if (s_->world_->find(part.id) == kNoIndex)
        {
            model::SceneSpec fragment;
            fragment.components.push_back(part);
            if (auto added = s_->world_->add(fragment); !added) return added;
            touched_.push_back(part.id);
        }
        spec.roles.push_back({role.name, {part.id}, false, {}});
        report.fields.push_back({role.name, FieldTransfer::Fresh});
    }
    return {};
}

Result<model::ComponentSpec> Transaction::spec_for_swap(std::uint32_t component, const SwapOperation& op, SwapReport& report)
{
    world::World& world = *s_->world_;
    const model::ComponentType& old = *world.type_of(component);
    const std::string element = op.id + " (" + old.info.name + ")";
    auto found = world.types().require(op.type);
    if (!found) return found.errors();
    const model::ComponentType& type = **found;
    if (const std::string why = type.why_not_exchangeable(old); !why.empty())
        return Error{{}, element, "cannot be exchanged for " + op.type + ": " + why};

    model::ComponentSpec spec = *world.scene().find(world.id_of(component));
    spec.type = op.type;
    spec.fields.clear();
    std::vector<std::string> names;
    Errors errors;
    for (const Field& field : type.schema.fields())
    {
        if (!carries_over(field.kind)) continue;
        names.push_back(field.name);
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
        if (std::find(names.begin(), names.end(), v.name) == names.end())
            errors.push_back({{}, element, op.type + " has no parameter '" + v.name + "'" + model::did_you_mean(v.name, names)});
    if (!errors.empty()) return errors;
    fit_roles(spec, type.schema, report);
    if (auto done = make_missing(spec, type.schema, report); !done) return done.errors();
    // A scene that selects commands keeps selecting the same ones where the new type has them.
    if (spec.explicit_commands) std::erase_if(spec.commands, [&](const std::string& c) { return type.find_command(c) < 0; });
    return spec;
}

Result<void> Transaction::exchange(std::uint32_t component, const model::ComponentSpec& spec, const SwapReport& report)
{
    world::World& world = *s_->world_;
    const BodyMotion before = motion_of(world, component);
    if (auto done = world.exchange(component, spec); !done) return done;
    keep_motion(world, component, before);
    // The host keeps the motion of objects; what the request gives of it is set there.
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
    report.id = s_->world_->id_of(*component), report.from = s_->world_->type_of(*component)->info.name;
    auto name = model::full_type_name(asked.type, s_->world_->types().names(), report.from.substr(0, report.from.rfind('/') + 1));
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
