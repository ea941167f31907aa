#include "simulation/transaction/trial.h"

#include <algorithm>
#include <cmath>

#include "simulation/costs/clock.h"
#include "simulation/run/field_change.h"
#include "simulation/step/totals.h"

namespace plab::simulation
{
namespace
{

constexpr int kMostTrialRounds = 4;

std::string failure_in(const std::vector<Event>& events)
{
    for (const Event& e : events)
        if (e.severity == Severity::Failure) return e.kind + (e.message.empty() ? "" : ": " + e.message);
    return {};
}

/// J, of prescribed objects: what they drive may well reach the same speed.
double kinetic_of_prescribed(const world::HostTables& host)
{
    double sum = 0;
    for (std::uint32_t b = 0; b < host.bodies.size(); ++b)
        if (host.bodies.motion[b] == Motion::Kinematic)
            sum += 0.5 * host.bodies.mass[b] * length_squared(host.bodies.velocity[b]) +
                   0.5 * dot(host.bodies.angular_velocity[b], host.bodies.angular_momentum[b]);
    for (std::uint32_t s = 0; s < host.shafts.size(); ++s)
        if (host.shafts.motion[s] == Motion::Kinematic) sum += 0.5 * host.shafts.inertia[s] * host.shafts.speed[s] * host.shafts.speed[s];
    return std::isfinite(sum) ? sum : 0;
}

}  // namespace

Trial::Trial(world::World& world, const Stepper& stepper, const TrialStep& step)
    : world_(world), stepper_(stepper), step_(step), host_(world.host())
{
}

void Trial::fix_all_others(const TrialScope& scope)
{
    if (scope.has_everything()) return;
    Bodies& bodies = world_.host().bodies;
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
        if (!scope.holds({Facet::Body, b})) bodies.motion[b] = Motion::Static, bodies.inverse_mass[b] = 0, bodies.inverse_inertia_B[b] = {};
    Shafts& shafts = world_.host().shafts;
    for (std::uint32_t s = 0; s < shafts.size(); ++s)
        if (!scope.holds({Facet::Shaft, s})) shafts.motion[s] = Motion::Static, shafts.inverse_inertia[s] = 0;
}

void Trial::keep_cells(const TrialScope& scope)
{
    kept_.clear(), cells_.clear();
    for (const std::uint32_t i : world_.in_id_order())
    {
        if (scope.components()[i] == 0 || world_.component(i).table == kNoIndex) continue;
        kept_.push_back(i);
        world_.table_of(i).save(world_.component(i).row, world::kLiveKinds, cells_);
    }
}

/// Restores the values of the components, what was prepared from them, and the host tables.
void Trial::put_back()
{
    ByteReader cells(cells_.bytes());
    for (const std::uint32_t i : kept_) world_.table_of(i).load(world_.component(i).row, world::kLiveKinds, cells);
    for (const std::uint32_t i : prepared_) (void)world_.prepare(i);
    prepared_.clear();
    world_.host() = host_;
}

/// Brings the partial stepper to the boundary, as one that continues from a snapshot would be.
void Trial::set_up(Stepper& part, const TrialScope& scope) const
{
    const auto concerns = [&](const auto& p) { return scope.holds(p.a) || scope.holds(p.b); };
    part.contacts().copy(stepper_.contacts());
    if (!scope.has_everything())
    {
        part.contacts().drop_if([&](const PairState& p) { return !concerns(p); });
        std::erase_if(part.contacts().force_pairs(), [&](const ForcePair& p) { return !concerns(p); });
    }
    part.reported() = stepper_.reported();
    part.continue_after(stepper_.frame().tick, stepper_.frame().start_time, stepper_.frame().step);
}

void Trial::apply_changes(void* self, std::vector<ParameterChange>& changes)
{
    auto& trial = *static_cast<Trial*>(self);
    bool structure = false;
    for (const ParameterChange& change : changes)
    {
        // A change that a script makes to a component outside the scope is ignored here, because only components in the scope can be
        // restored.
        const std::uint32_t i = trial.world_.find(change.component);
        if (std::find(trial.kept_.begin(), trial.kept_.end(), i) == trial.kept_.end()) continue;
        const Facet facet = trial.world_.component(i).facet;
        if (trial.world_.component(i).quarantined) continue;  // setting a field would end its quarantine, also after the trial
        const Value before = trial.world_.get(i, change.name);
        if (set_field(trial.world_, i, change.name, change.value, trial.prepared_))
            structure = structure || trial.world_.type_of(i)->takes_part(Phase::Connect) || facet != Facet::Component;
        else if (type_of(before) != FieldType::None)
            (void)set_field(trial.world_, i, change.name, before, trial.prepared_);
    }
    if (structure) (void)trial.part_->rebuild();
}

/// Adds moving objects outside the scope that touched an object in it during the step. Returns false if there were none.
bool Trial::grow(TrialScope& scope, const Stepper& part) const
{
    if (scope.has_everything()) return false;
    bool grown = false;
    const auto meet = [&](Ref a, Ref b)
    {
        for (const Ref r : {a, b})
        {
            if (r.facet != Facet::Body || scope.holds(r) || host_.bodies.motion[r.index] == Motion::Static) continue;
            scope.add(r);
            grown = true;
        }
    };
    const auto extend = [&](const auto& p)
    {
        if (scope.holds(p.a) || scope.holds(p.b)) meet(p.a, p.b);
    };
    for (const PairState& p : part.contacts().pairs()) extend(p);
    for (const ForcePair& p : part.contacts().force_pairs()) extend(p);
    for (const Event& e : part.events())
        if (e.a.facet == Facet::Body && e.b.facet == Facet::Body && e.a.valid() && e.b.valid()) extend(e);
    return grown;
}

TrialResult Trial::once(Stepper& part, const std::vector<std::uint32_t>& components, const Interruption& deadline)
{
    TrialResult out;
    const Totals first = totals_of(world_, part, step_.start, step_.tick);
    out.before = first.kinetic + first.stored;
    out.moving = first.kinetic + kinetic_of_prescribed(world_.host());
    out.least = least_energy(world_.host(), part.radius_of_body(), step_.h);
    part.step(step_.tick, step_.start, step_.h);
    out.given_up = deadline.has_interrupted();
    out.failure = failure_in(part.events());
    const Totals then = totals_of(world_, part, step_.start + step_.h, step_.tick + 1);
    out.kinetic_after = then.kinetic;
    out.outcome.energy = then.kinetic + then.stored, out.outcome.momentum = then.momentum;
    for (const std::uint32_t c : components) out.errors.push_back(c == kNoIndex ? 0.0 : world_.largest_error(c));
    return out;
}

/// The first step of a new stepper has cold caches and allocates memory, so its time is not typical, and a single step shows no spread.
/// No step is started that would hardly finish in time.
Spread Trial::measure(Stepper& part, const TrialScope& scope, const Interruption& deadline, std::uint64_t until_ns)
{
    constexpr std::size_t kRepeats = 11;
    std::vector<double> ns;
    std::uint64_t longest = 0;
    for (std::uint64_t begin = now_ns(); ns.size() < kRepeats && begin + longest < until_ns && !deadline.due();)
    {
        fix_all_others(scope);
        set_up(part, scope);
        const std::uint64_t before = now_ns();
        part.step(step_.tick, step_.start, step_.h);
        const std::uint64_t after = now_ns();
        put_back();
        if (deadline.has_interrupted()) break;
        ns.push_back(static_cast<double>(after - before));
        const std::uint64_t end = now_ns();
        longest = std::max(longest, end - begin), begin = end;
    }
    return spread_of(ns);
}

TrialResult Trial::run(TrialScope& scope, const std::vector<std::uint32_t>& components, const Interruption& deadline, Progress& progress,
                       std::uint64_t until_ns)
{
    TrialResult out;
    for (int round = 0; round < kMostTrialRounds; ++round)
    {
        if (round + 1 == kMostTrialRounds) scope.add_everything();
        scope.close(stepper_);
        scope.choose_components();
        keep_cells(scope);
        fix_all_others(scope);
        const world::HostTables fixed = world_.host();
        Stepper part(world_, 1);
        part.restrict_to(scope.has_everything() ? nullptr : &scope.components());
        part.set_interruption(&deadline, &progress);
        part.on_changes(&Trial::apply_changes, this);
        part_ = &part;
        bool grown = false, tried = false;
        if (auto built = part.rebuild(); !built)
            out.failure = built.error().text();
        else
        {
            world_.host() = fixed;  // a stepper that derives values from the structure may have written to the tables
            set_up(part, scope);
            out = once(part, components, deadline);
            tried = !out.given_up;
        }
        put_back();  // before the scope grows: from here on nothing is fixed
        if (tried) grown = grow(scope, part);
        if (tried && !grown && out.failure.empty()) out.cost = measure(part, scope, deadline, until_ns);
        part_ = nullptr;
        if (!grown) break;
    }
    return out;
}

}  // namespace plab::simulation
