#include "simulation/transaction/transaction.h"

#include <algorithm>
#include <cmath>

#include "model/compile.h"
#include "model/names.h"
#include "model/values.h"
#include "simulation/run/field_change.h"

namespace plab::simulation
{

std::vector<std::string> subtree_of(const model::SceneSpec& scene, const std::string& id)
{
    std::vector<std::string> out;
    for (const model::ComponentSpec& c : scene.components)
        if (c.parent == id)
            for (std::string& inner : subtree_of(scene, c.id)) out.push_back(std::move(inner));
    out.push_back(id);
    return out;
}

namespace
{

void note_maker(model::SceneSpec& fragment, const std::string& maker)
{
    for (std::size_t k = 0; k < fragment.components.size(); ++k)
    {
        model::ComponentSpec spec = fragment.components[k];
        spec.made_by = maker;
        fragment.components.replace(k, std::move(spec));
    }
}

}  // namespace

Transaction::Transaction(Run& run, RunContext& context, RunOperations& operations, const Request& request)
    : run_(&run), context_(&context), whole_(&operations), request_(&request)
{
    reply_.request = request.id, reply_.step = run.clock.tick;
}

Result<std::uint32_t> Transaction::find_typed(const std::string& id) const
{
    const std::uint32_t i = run_->world().find(id);
    if (i != kNoIndex && run_->world().component(i).table != kNoIndex) return i;
    // An object's id may be used for the only State inside it, as in the roles of a blueprint.
    std::vector<std::uint32_t> states;
    if (i != kNoIndex)
        for (const std::string& inner : subtree_of(run_->world().scene(), id))
        {
            const std::uint32_t k = run_->world().find(inner);
            const Facet facet = run_->world().component(k).facet;
            if (facet == Facet::Body || facet == Facet::Shaft) states.push_back(k);
        }
    if (states.size() == 1) return states.front();
    std::vector<std::string> known;
    for (const std::uint32_t k : run_->world().in_id_order())
        if (run_->world().component(k).table != kNoIndex) known.push_back(run_->world().id_of(k));
    if (i != kNoIndex) return Error{{}, id, "is a group; name one of its components"};
    return Error{{}, {}, "no component has the id '" + id + "'" + model::did_you_mean(id, known)};
}

/// Restores the past state but keeps the present pause and rate.
template <class Op>
Result<void> Transaction::go_back(const Op& op)
{
    const std::tuple clock(run_->clock.paused, run_->clock.steps_left, run_->clock.rate);
    const auto go = [&]() -> Result<void>
    {
        if constexpr (std::is_same_v<Op, RestoreOperation>)
            return whole_->restore(op.name);
        else
            return whole_->rewind(op.back ? run_->clock.time() - op.time : op.time);
    };
    auto done = go();
    if (done) std::tie(run_->clock.paused, run_->clock.steps_left, run_->clock.rate) = clock;
    return done;
}

Result<void> Transaction::apply(const Operation& operation)
{
    return std::visit(
        [this](const auto& op) -> Result<void>
        {
            using T = std::decay_t<decltype(op)>;
            if constexpr (requires { this->apply_one(op); })
                return apply_one(op);
            else if constexpr (std::is_same_v<T, PauseOperation>)
                run_->clock.paused = true, run_->clock.steps_left = 0;
            else if constexpr (std::is_same_v<T, ResumeOperation>)
                run_->clock.paused = false, run_->clock.steps_left = 0;
            else if constexpr (std::is_same_v<T, StepOperation>)
            {
                if (op.steps < 1) return reason("needs at least one step, not " + std::to_string(op.steps));
                run_->clock.paused = true, run_->clock.steps_left = op.steps;
            }
            else if constexpr (std::is_same_v<T, RateOperation>)
            {
                if (!(op.factor >= 0)) return reason("the rate must be 0 (as fast as possible) or a positive factor");
                run_->clock.rate = op.factor;
            }
            else if constexpr (std::is_same_v<T, StepLengthOperation>)
            {
                const double dt = op.dt.seconds;
                if (!(dt >= 1e-9 && dt <= 3600) || op.dt.denominator < 0 || op.dt.numerator <= 0)
                    return reason("the step length must be between 1e-9 s and 3600 s");
                run_->clock.base_time = run_->clock.time(), run_->clock.base_tick = run_->clock.tick;
                run_->clock.dt = op.dt;
            }
            else if constexpr (std::is_same_v<T, SnapshotOperation>)
                return whole_->keep(op.name);
            else if constexpr (std::is_same_v<T, ForgetOperation>)
                return whole_->forget(op.name);
            else if constexpr (std::is_same_v<T, RestoreOperation> || std::is_same_v<T, RewindOperation>)
                return go_back(op);
            else
            {
                const model::SceneSpec scene = [&]
                {
                    if constexpr (std::is_same_v<T, LoadOperation>)
                        return op.scene;
                    else
                        return *run_->loaded;
                }();
                return whole_->load(scene);
            }
            return {};
        },
        operation);
}

Result<void> Transaction::apply_one(const AddOperation& op)
{
    note_added(op.fragment.components, 0);
    return run_->world().add(op.fragment);
}

void Transaction::note_added(const model::ComponentList& specs, std::size_t first)
{
    structural_ = true;
    saved_.add_backup();
    for (std::size_t k = first; k < specs.size(); ++k) touched_.push_back(specs[k].id), added_.push_back(specs[k].id);
}

Result<void> Transaction::apply_one(const AddBlueprintOperation& op)
{
    world::World& world = run_->world();
    if (!op.prepared || !op.prepared->fits(world.scene()))
    {
        auto fragment = model::compile(*op.blueprint, world.types(), &world.scene(), context_->limits);
        if (!fragment) return fragment.errors();
        model::SceneSpec made = fragment.take();
        if (!request_->made_by.empty()) note_maker(made, request_->made_by);
        return apply_one(AddOperation{std::move(made)});
    }
    const auto& whole = op.prepared->whole;
    if (!whole) return whole.errors();
    note_added((*whole)->components, world.scene().components.size());
    return world.add(*whole);
}

Result<void> Transaction::apply_one(const RemoveOperation& op)
{
    structural_ = true;
    saved_.add_backup();
    const std::uint32_t top = run_->world().find(op.id);
    if (top == kNoIndex)
    {
        std::vector<std::string> known;
        for (const std::uint32_t k : run_->world().in_id_order()) known.push_back(run_->world().id_of(k));
        return Error{{}, {}, "no component has the id '" + op.id + "'" + model::did_you_mean(op.id, known)};
    }
    const std::vector<std::string> going = subtree_of(run_->world().scene(), op.id);
    Errors errors;
    for (const std::string& id : going)
        for (const std::uint32_t referrer : run_->world().referrers(run_->world().find(id)))
            if (std::find(going.begin(), going.end(), run_->world().id_of(referrer)) == going.end())
                errors.push_back({{}, id, "is still used by '" + run_->world().id_of(referrer) + "'"});
    if (!errors.empty()) return errors;
    for (const std::string& id : going)
    {
        touched_.push_back(id);
        run_->stepper().retire(run_->world().find(id));
        run_->world().remove(run_->world().find(id));
    }
    run_->world().refresh_open_roles();
    return {};
}

Result<void> Transaction::apply_one(const SetOperation& op)
{
    auto component = find_typed(op.id);
    if (!component) return component.errors();
    world::World& world = run_->world();
    const model::ComponentType& type = *world.type_of(*component);
    const std::string element = op.id + " (" + type.info.name + ")";
    const std::size_t dot = op.name.find('.');
    const Field* field = type.schema.find_field(dot == std::string::npos ? op.name : op.name.substr(0, dot));
    if (!field)
    {
        std::vector<std::string> names;
        for (const Field& f : type.schema.fields())
            if (f.kind == FieldKind::Param || f.kind == FieldKind::State) names.push_back(f.name);
        return Error{{}, element, "has no field '" + op.name + "'" + model::did_you_mean(op.name, names)};
    }
    auto value = new_value(*component, *field, op);
    if (!value) return Error{{}, element, op.name + ": " + value.error().reason};
    auto done = set_field(world, *component, field->name, *value, prepared_);
    if (done)
    {
        touched_.push_back(world.id_of(*component));
        return {};
    }
    Errors errors = done.errors();
    for (Error& e : errors)
        if (e.element.empty()) e.element = element;
    return errors;
}

Result<Value> Transaction::new_value(std::uint32_t component, const Field& field, const SetOperation& op) const
{
    const std::size_t dot = op.name.find('.');
    if (dot == std::string::npos) return value_for(field, op.value);
    const auto* text = std::get_if<std::string>(&op.value);
    if (field.type != FieldType::EntryList) return reason("'" + field.name + "' has no entries");
    Value cell = run_->world().get(component, field.name);
    for (Entry& entry : std::get<Entries>(cell))
    {
        if (entry.name != op.name.substr(dot + 1)) continue;
        Field as;
        as.name = entry.name;
        as.type = std::holds_alternative<bool>(entry.value)     ? FieldType::Boolean
                  : std::holds_alternative<double>(entry.value) ? FieldType::Real
                                                                : FieldType::Text;
        auto parsed = text ? model::parse_value(*text, as) : Result<Value>(std::get<Value>(op.value));
        if (!parsed) return parsed;
        if (type_of(*parsed) != as.type) return reason("has another type");
        if (const auto* b = std::get_if<bool>(&*parsed)) entry.value = *b;
        if (const auto* d = std::get_if<double>(&*parsed)) entry.value = *d;
        if (const auto* s = std::get_if<std::string>(&*parsed)) entry.value = *s;
        return cell;
    }
    return reason("there is no entry '" + op.name.substr(dot + 1) + "'");
}

Result<void> Transaction::apply_one(const PushOperation& op)
{
    auto component = find_typed(op.id);
    if (!component) return component.errors();
    const world::Component& c = run_->world().component(*component);
    world::HostTables& host = run_->world().host();
    if (!is_finite(op.impulse) || (op.point && !is_finite(*op.point))) return Error{{}, op.id, "an impulse must be finite"};
    run_->world().note(*component);  // the host row changes directly
    if (c.facet == Facet::Body && host.bodies.dynamic(c.host_index))
        host.bodies.apply_impulse(c.host_index, op.impulse, op.point ? *op.point : host.bodies.position[c.host_index]);
    else if (c.facet == Facet::Shaft && host.shafts.dynamic(c.host_index))
        host.shafts.speed[c.host_index] += op.impulse.x * host.shafts.inverse_inertia[c.host_index];
    else
        return Error{{}, op.id, "is not dynamic, so it cannot be pushed"};
    const double energy = c.facet == Facet::Body ? host.bodies.kinetic_energy(c.host_index) : host.shafts.kinetic_energy(c.host_index);
    if (!std::isfinite(energy)) return Error{{}, op.id, "would get a kinetic energy that is not finite"};
    return {};
}

}  // namespace plab::simulation
