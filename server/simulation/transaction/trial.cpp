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

/// Notes changes in another log for a while: what a trial changes is no change by the request.
class NoteScope
{
public:
    NoteScope(world::World& world, world::UndoLog* log) : world_(world), before_(world.note_in(log)) {}
    ~NoteScope() { (void)world_.note_in(before_); }
    NoteScope(const NoteScope&) = delete;
    NoteScope& operator=(const NoteScope&) = delete;

private:
    world::World& world_;
    world::UndoLog* before_;
};

std::string failure_in(const std::vector<Event>& events)
{
    for (const Event& e : events)
        if (e.severity == Severity::Failure) return e.kind + (e.message.empty() ? "" : ": " + e.message);
    return {};
}

/// J, of the prescribed objects in the scope: what they drive may well reach the same speed.
double kinetic_of_prescribed(const world::HostTables& host, const TrialScope& scope)
{
    double sum = 0;
    for (const std::uint32_t b : scope.bodies())
        if (host.bodies.motion[b] == Motion::Kinematic)
            sum += 0.5 * host.bodies.mass[b] * length_squared(host.bodies.velocity[b]) +
                   0.5 * dot(host.bodies.angular_velocity[b], host.bodies.angular_momentum[b]);
    for (const std::uint32_t s : scope.shafts())
        if (host.shafts.motion[s] == Motion::Kinematic) sum += 0.5 * host.shafts.inertia[s] * host.shafts.speed[s] * host.shafts.speed[s];
    return std::isfinite(sum) ? sum : 0;
}

}  // namespace

Trial::Trial(world::World& world, const Stepper& stepper, const TrialStep& step) : world_(world), stepper_(stepper), step_(step) {}

void Trial::keep_cells(const TrialScope& scope)
{
    kept_.clear(), cells_.clear();
    for (const std::uint32_t i : scope.components().components)
    {
        if (world_.component(i).table == kNoIndex) continue;
        kept_.push_back(i);
        world_.table_of(i).save(world_.component(i).row, world::kLiveKinds, cells_);
    }
}

/// The contacts of the scene may be many more than those of the scope, so they are looked through once.
void Trial::keep_contacts(const TrialScope& scope)
{
    if (scope.has_everything())
        contacts_.copy(stepper_.contacts());
    else if (scope.bodies().empty())
        contacts_.copy_if(
            stepper_.contacts(), [](const PairKey&) { return false; }, [](Ref, Ref) { return false; });
    else
    {
        const std::vector<std::uint8_t>& flags = scope.components().flags;
        const std::vector<std::uint32_t>& order = world_.in_id_order();
        contacts_.copy_if(
            stepper_.contacts(), [&](const PairKey& key) { return flags[order[key.a]] != 0 || flags[order[key.b]] != 0; },
            [&](Ref a, Ref b) { return scope.holds(a) || scope.holds(b); });
    }
}

void Trial::load_cells()
{
    ByteReader cells(cells_.bytes());
    for (const std::uint32_t i : kept_) world_.table_of(i).load(world_.component(i).row, world::kLiveKinds, cells);
}

/// Restores the values of the components, what was prepared from them, and the host tables.
void Trial::put_back()
{
    load_cells();
    prepare_again();
    host_.restore(world_.host());
}

/// Brings the scope to the boundary for another step; all others stay fixed.
void Trial::put_back_moved()
{
    load_cells();
    prepare_again();
    host_.restore_moved(world_.host());
}

/// Prepares what scripts have changed from the restored parameters. That may overwrite values which were restored: of the changed
/// components by those of the log, and of those in the scope by the ones that were kept, which the log may have noted within the step.
void Trial::prepare_again()
{
    if (prepared_.empty() && host_.changes().entries.empty()) return;
    const NoteScope none(world_, nullptr);
    for (const std::uint32_t i : prepared_) (void)world_.prepare(i);
    prepared_.clear();
    world_.restore_values(host_.changes());
    load_cells();
}

/// Brings the partial stepper to the boundary, as one that continues from a snapshot would be.
void Trial::set_up(Stepper& part) const
{
    part.contacts().copy(contacts_);
    part.reported() = stepper_.reported();
    part.continue_after(stepper_.frame().tick, stepper_.frame().start_time, stepper_.frame().step);
}

/// Detectors need not look at the bodies outside the scope again if they have looked at all of them, because those stay where they are.
/// To be called before the others are fixed.
void Trial::choose_bodies(Stepper& part, const TrialScope& scope)
{
    if (scope.has_everything() || !step_.looked) return;
    const Bodies& bodies = world_.host().bodies;
    moving_.begin(bodies.size());
    for (const std::uint32_t b : scope.bodies())
        if (bodies.dynamic(b)) moving_.add(b);
    part.look_among(&moving_);
}

/// Puts everything back after a step, also for the detectors, which are those of the scene.
void Trial::end_step(Stepper& part)
{
    put_back();
    if (part.look_again()) load_cells();
}

/// How impacts are found may depend on all bodies of a detection, so it is chosen before the others are fixed.
void Trial::choose_search(Stepper& part)
{
    host_.restore(world_.host());
    part.search_as(stepper_, step_.tick, step_.start, step_.h);
    load_cells();
    host_.fix_others(world_.host());
    host_.restore_derived(world_.host()), host_.restore_moved(world_.host());
}

void Trial::apply_changes(void* self, std::vector<ParameterChange>& changes)
{
    auto& trial = *static_cast<Trial*>(self);
    bool structure = false;
    const NoteScope noted(trial.world_, &trial.host_.changes());
    for (const ParameterChange& change : changes)
    {
        // A change that a script makes to a component outside the scope is ignored here, because only components in the scope can be
        // restored.
        const std::uint32_t i = trial.world_.find(change.component);
        if (i == kNoIndex || trial.selection_->flags[i] == 0) continue;
        const Facet facet = trial.world_.component(i).facet;
        if (trial.world_.component(i).quarantined) continue;  // setting a field would end its quarantine, also after the trial
        const Value before = trial.world_.get(i, change.name);
        if (set_field(trial.world_, i, change.name, change.value, trial.prepared_))
            structure = structure || trial.world_.type_of(i)->takes_part(Phase::Connect) || facet != Facet::Component;
        else if (type_of(before) != FieldType::None)
            (void)set_field(trial.world_, i, change.name, before, trial.prepared_);
    }
    if (!structure) return;
    trial.part_->look_among(nullptr);  // shapes may have changed
    (void)trial.part_->rebuild();
}

/// Adds moving objects outside the scope that touched an object in it during the step. Returns false if there were none, or if the scope is
/// a sample, which holds them still.
bool Trial::grow(TrialScope& scope, const Stepper& part) const
{
    if (scope.has_everything()) return false;
    const bool sample = scope.is_sample();
    bool grown = false;
    const auto meet = [&](Ref a, Ref b)
    {
        for (const Ref r : {a, b})
        {
            if (r.facet != Facet::Body || scope.holds(r) || world_.host().bodies.motion[r.index] == Motion::Static) continue;
            grown = !sample;
            sample ? scope.note_neighbour() : scope.add(r);
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

std::vector<ObjectMotion> Trial::motion_in(const TrialScope& scope) const
{
    std::vector<ObjectMotion> out;
    const Bodies& bodies = world_.host().bodies;
    const Shafts& shafts = world_.host().shafts;
    for (const std::uint32_t b : scope.bodies())
        out.push_back({{Facet::Body, b},
                       bodies.position[b],
                       bodies.velocity[b],
                       bodies.angular_velocity[b],
                       bodies.orientation[b],
                       stepper_.radius_of_body()[b],
                       0,
                       0});
    for (const std::uint32_t s : scope.shafts())
    {
        ObjectMotion& shaft = out.emplace_back();
        shaft.object = {Facet::Shaft, s}, shaft.angle = shafts.angle[s], shaft.speed = shafts.speed[s];
    }
    return out;
}

TrialResult Trial::once(Stepper& part, const TrialScope& scope, const std::vector<std::uint32_t>& components, const Interruption& deadline)
{
    TrialResult out;
    const Totals first = totals_of(world_, part, step_.start, step_.tick);
    out.before = first.kinetic + first.stored;
    out.moving = first.kinetic + kinetic_of_prescribed(world_.host(), scope);
    out.least = least_energy(world_.host(), scope.bodies(), scope.shafts(), stepper_.radius_of_body(), step_.h);
    const std::uint64_t begin = now_ns();
    part.step(step_.tick, step_.start, step_.h);
    first_ns_ = now_ns() - begin;
    out.given_up = deadline.has_interrupted();
    out.failure = failure_in(part.events());
    const auto note = [&](int steps)
    {
        if (step_.course) out.course.push_back(motion_in(scope));
        if (!step_.energies) return;
        const Energies now = energies_of(world_, part, step_.start + steps * step_.h, step_.tick + steps);
        out.energies.push_back(now.kinetic + now.stored);
    };
    note(1);
    const auto is_enough = [&] { return step_.end && (*step_.end)(out.course); };
    int made = 1;
    for (; made < step_.count && !out.given_up && out.failure.empty() && !is_enough(); ++made)
    {
        part.step(step_.tick + made, step_.start + made * step_.h, step_.h);
        out.given_up = deadline.has_interrupted(), out.failure = failure_in(part.events());
        note(made + 1);
    }
    const Totals then = totals_of(world_, part, step_.start + made * step_.h, step_.tick + made);
    out.kinetic_after = then.kinetic;
    out.outcome.energy = then.kinetic + then.stored, out.outcome.momentum = then.momentum;
    for (const std::uint32_t c : components) out.errors.push_back(c == kNoIndex ? 0.0 : world_.largest_error(c));
    out.motion = motion_in(scope);
    return out;
}

/// The first step of a new stepper has cold caches and allocates memory, so its time is not typical, and a single step shows no spread.
/// No step is started that would hardly finish in time; a warm step is expected to take at least a quarter of the first one's time.
Spread Trial::measure(Stepper& part, const Interruption& deadline, std::uint64_t until_ns)
{
    constexpr std::size_t kRepeats = 11;
    std::vector<double> ns;
    std::uint64_t longest = first_ns_ / 4;
    host_.fix_others(world_.host());
    for (std::uint64_t begin = now_ns(); ns.size() < kRepeats && begin + longest < until_ns && !deadline.due();)
    {
        set_up(part);
        const std::uint64_t before = now_ns();
        part.step(step_.tick, step_.start, step_.h);
        const std::uint64_t after = now_ns();
        put_back_moved();
        if (deadline.has_interrupted()) break;
        ns.push_back(static_cast<double>(after - before));
        const std::uint64_t end = now_ns();
        longest = std::max(longest, end - begin), begin = end;
    }
    end_step(part);
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
        keep_cells(scope), keep_contacts(scope);
        host_.save(world_.host(), scope);
        Stepper part(world_, 1);
        part.take_over(stepper_);
        choose_bodies(part, scope);
        host_.fix_others(world_.host());
        part.restrict_to(scope.has_everything() ? nullptr : &scope.components());
        part.set_interruption(&deadline, &progress);
        part.on_changes(&Trial::apply_changes, this);
        part_ = &part, selection_ = &scope.components();
        bool grown = false, tried = false;
        if (auto built = part.rebuild(); !built)
            out.failure = built.error().text(), part.look_among(nullptr);
        else
        {
            if (!part.looks_once()) part.look_among(nullptr);
            // The stepper may have written values that it derives from the structure.
            if (step_.derives) host_.take_derived(world_.host());
            host_.restore_derived(world_.host()), host_.restore_moved(world_.host());
            if (part.adapts() && !scope.has_everything()) choose_search(part);
            set_up(part);
            out = once(part, scope, components, deadline);
            tried = !out.given_up;
        }
        end_step(part);  // before the scope grows: from here on nothing is fixed
        if (tried) grown = grow(scope, part);
        // A sample is there to keep the pause short.
        if (tried && !grown && out.failure.empty() && !scope.is_sample())
            out.cost = measure(part, deadline, step_.measure_ns > 0 ? now_ns() + step_.measure_ns : until_ns);
        part_ = nullptr;
        if (!grown) break;
    }
    return out;
}

}  // namespace plab::simulation
