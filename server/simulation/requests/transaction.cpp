#include "simulation/requests/transaction.h"

#include <algorithm>
#include <cmath>

#include "model/compile.h"
#include "model/names.h"
#include "model/values.h"
#include "simulation/requests/field_change.h"
#include "simulation/snapshot/history.h"

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

Transaction::Transaction(Simulation& simulation, const Request& request) : s_(&simulation), request_(&request)
{
    reply_.request = request.id, reply_.step = simulation.tick_;
}

Transaction::State Transaction::capture() const
{
    Stepper& stepper = *s_->stepper_;
    return {s_->world_->backup(),    stepper.contacts(),      stepper.work(),    stepper.contact_energy(),
            stepper.departed_work(), stepper.requests_work(), stepper.reported()};
}

void Transaction::restore(const State& state, bool structure_changed)
{
    s_->world_->restore(state.world);
    // Opaque parts (a script's chunk) are not in the backup: they are made again from what is.
    for (const std::set<std::uint32_t>* made : {&prepared_, &s_->changed_by_scripts_})
        for (const std::uint32_t i : *made)
            if (i < s_->world_->components().size() && s_->world_->component(i).alive) (void)s_->world_->prepare(i);
    // Preparing rewrites host rows from parameters; what moved on since (a body's pose) is in the backup.
    s_->world_->host() = state.world.host;
    if (structure_changed) (void)s_->stepper_->rebuild();
    s_->world_->host() = state.world.host;
    s_->stepper_->contacts() = state.contacts;
    s_->stepper_->work() = state.work, s_->stepper_->contact_energy() = state.contact_energy;
    s_->stepper_->reported() = state.reported;
    s_->stepper_->reported().contradictory.resize(s_->world_->components().size(), 0);
    s_->stepper_->departed_work() = state.departed_work, s_->stepper_->requests_work() = state.requests_work;
}

Result<std::uint32_t> Transaction::find_typed(const std::string& id) const
{
    const std::uint32_t i = s_->world_->find(id);
    if (i != kNoIndex && s_->world_->component(i).table != kNoIndex) return i;
    // An object stands for the only State inside it, as in roles of the blueprint.
    std::vector<std::uint32_t> states;
    if (i != kNoIndex)
        for (const std::string& inner : subtree_of(s_->world_->scene(), id))
        {
            const std::uint32_t k = s_->world_->find(inner);
            const Facet facet = s_->world_->component(k).facet;
            if (facet == Facet::Body || facet == Facet::Shaft) states.push_back(k);
        }
    if (states.size() == 1) return states.front();
    std::vector<std::string> known;
    for (const std::uint32_t k : s_->world_->in_id_order())
        if (s_->world_->component(k).table != kNoIndex) known.push_back(s_->world_->id_of(k));
    if (i != kNoIndex) return Error{{}, id, "is a group; name one of its components"};
    return Error{{}, {}, "no component has the id '" + id + "'" + model::did_you_mean(id, known)};
}

/// The state is that of the past; pause and rate are the present's.
template <class Op>
Result<void> Transaction::go_back(const Op& op)
{
    const std::tuple clock(s_->paused_, s_->steps_left_, s_->rate_);
    const auto go = [&]() -> Result<void>
    {
        if constexpr (std::is_same_v<Op, RestoreOperation>)
        {
            auto found = s_->history().find(op.name);
            return found ? s_->restore(*found) : found.errors();
        }
        else
            return s_->history().rewind(*s_, op.back ? s_->time() - op.time : op.time);
    };
    auto done = go();
    if (done) std::tie(s_->paused_, s_->steps_left_, s_->rate_) = clock;
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
                s_->paused_ = true, s_->steps_left_ = 0;
            else if constexpr (std::is_same_v<T, ResumeOperation>)
                s_->paused_ = false, s_->steps_left_ = 0;
            else if constexpr (std::is_same_v<T, StepOperation>)
            {
                if (op.steps < 1) return reason("needs at least one step, not " + std::to_string(op.steps));
                s_->paused_ = true, s_->steps_left_ = op.steps;
            }
            else if constexpr (std::is_same_v<T, RateOperation>)
            {
                if (!(op.factor >= 0)) return reason("a rate is 0 (as fast as it goes) or a positive factor");
                s_->rate_ = op.factor;
            }
            else if constexpr (std::is_same_v<T, StepLengthOperation>)
            {
                const double dt = op.dt.seconds;
                if (!(dt >= 1e-9 && dt <= 3600) || op.dt.denominator < 0 || op.dt.numerator <= 0)
                    return reason("a step length is from 1e-9 s to 3600 s");
                s_->base_time_ = s_->time(), s_->base_tick_ = s_->tick_;
                s_->dt_ = op.dt;
            }
            else if constexpr (std::is_same_v<T, SnapshotOperation>)
                return s_->history().keep(op.name, s_->capture());
            else if constexpr (std::is_same_v<T, ForgetOperation>)
                return s_->history().forget(op.name);
            else if constexpr (std::is_same_v<T, RestoreOperation> || std::is_same_v<T, RewindOperation>)
                return go_back(op);
            else
            {
                const model::SceneSpec scene = [&]
                {
                    if constexpr (std::is_same_v<T, LoadOperation>)
                        return op.scene;
                    else
                        return *s_->loaded_;
                }();
                return s_->load(scene);
            }
            return {};
        },
        operation);
}

Result<void> Transaction::apply_one(const AddOperation& op)
{
    structural_ = true;
    for (const model::ComponentSpec& c : op.fragment.components) touched_.push_back(c.id);
    return s_->world_->add(op.fragment);
}

Result<void> Transaction::apply_one(const AddBlueprintOperation& op)
{
    auto fragment = model::compile(op.blueprint, s_->world_->types(), &s_->world_->scene(), s_->limits_);
    if (!fragment) return fragment.errors();
    return apply_one(AddOperation{fragment.take()});
}

Result<void> Transaction::apply_one(const RemoveOperation& op)
{
    structural_ = true;
    const std::uint32_t top = s_->world_->find(op.id);
    if (top == kNoIndex)
    {
        std::vector<std::string> known;
        for (const std::uint32_t k : s_->world_->in_id_order()) known.push_back(s_->world_->id_of(k));
        return Error{{}, {}, "no component has the id '" + op.id + "'" + model::did_you_mean(op.id, known)};
    }
    const std::vector<std::string> going = subtree_of(s_->world_->scene(), op.id);
    Errors errors;
    for (const std::string& id : going)
        for (const std::uint32_t who : s_->world_->referrers(s_->world_->find(id)))
            if (std::find(going.begin(), going.end(), s_->world_->id_of(who)) == going.end())
                errors.push_back({{}, id, "is still used by '" + s_->world_->id_of(who) + "'"});
    if (!errors.empty()) return errors;
    for (const std::string& id : going)
    {
        touched_.push_back(id);
        s_->stepper_->retire(s_->world_->find(id));
        s_->world_->remove(s_->world_->find(id));
    }
    s_->world_->refresh_open_roles();
    return {};
}

Result<void> Transaction::apply_one(const SetOperation& op)
{
    auto component = find_typed(op.id);
    if (!component) return component.errors();
    world::World& world = *s_->world_;
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
    const auto* text = std::get_if<std::string>(&op.value);
    const std::size_t dot = op.name.find('.');
    if (dot == std::string::npos)
    {
        if (text) return model::parse_value(*text, field);
        Value value = std::get<Value>(op.value);
        if (const auto* integer = std::get_if<std::int64_t>(&value); integer && field.type == FieldType::Real)
            value = static_cast<double>(*integer);
        if (auto fits = model::check_value(value, field); !fits) return fits.errors();
        return value;
    }
    if (field.type != FieldType::EntryList) return reason("'" + field.name + "' has no entries");
    Value cell = s_->world_->get(component, field.name);
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
    const world::Component& c = s_->world_->component(*component);
    world::HostTables& host = s_->world_->host();
    if (!is_finite(op.impulse) || (op.point && !is_finite(*op.point))) return Error{{}, op.id, "an impulse must be finite"};
    if (c.facet == Facet::Body && host.bodies.dynamic(c.host_index))
        host.bodies.apply_impulse(c.host_index, op.impulse, op.point ? *op.point : host.bodies.position[c.host_index]);
    else if (c.facet == Facet::Shaft && host.shafts.dynamic(c.host_index))
        host.shafts.speed[c.host_index] += op.impulse.x * host.shafts.inverse_inertia[c.host_index];
    else
        return Error{{}, op.id, "does not move by forces, so it cannot be pushed"};
    const double energy = c.facet == Facet::Body ? host.bodies.kinetic_energy(c.host_index) : host.shafts.kinetic_energy(c.host_index);
    if (!std::isfinite(energy)) return Error{{}, op.id, "would move faster than can be computed with"};
    return {};
}

}  // namespace plab::simulation
