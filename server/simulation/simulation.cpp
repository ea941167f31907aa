#include "simulation/simulation.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "simulation/costs/clock.h"
#include "simulation/run/field_change.h"
#include "simulation/transaction/inputs.h"

namespace plab::simulation
{

Simulation::Simulation(model::TypeSource& types, int threads) { context_.types = &types, context_.threads = threads; }
Simulation::~Simulation() = default;

void Simulation::begin_run(LiveScene live, std::shared_ptr<const model::SceneSpec> scene)
{
    run_.live = std::move(live);
    run_.stepper().on_changes(&Simulation::apply_script_changes, this);
    run_.stepper().set_interruption(context_.interruption, &context_.progress);
    run_.loaded = std::move(scene);
    run_.clock.dt = run_.loaded->settings.dt;
    run_.clock.tick = run_.clock.base_tick = 0;
    run_.clock.base_time = 0;
    run_.events.clear();
    run_.changed_by_scripts.clear();
    ++run_.number;
    run_.changes = {};
    run_.changes.everything = true;
    *run_.watch = {};
    decided_ = {};
    run_.kinetic_at_start = totals().kinetic;
}

Result<void> Simulation::load(const model::SceneSpec& scene)
{
    auto live = build_scene(context_, scene);
    if (!live) return live.errors();
    begin_run(live.take(), std::make_shared<const model::SceneSpec>(scene));
    history_.begin(run_);
    return {};
}

Result<void> Simulation::restore(const Snapshot& snapshot)
{
    if (!snapshot) return reason("there is no snapshot to restore");
    auto live = revive(context_, *snapshot);
    if (!live) return live.errors();
    begin_run(live.take(), snapshot->loaded);
    continue_from(run_, *snapshot);
    history_.begin(run_);
    return {};
}

Result<void> Simulation::restore(const std::string& name)
{
    auto found = history_.find(name);
    return found ? restore(*found) : found.errors();
}

Result<void> Simulation::rewind(double time)
{
    auto back = history_.plan_rewind(run_, time);
    if (!back) return back.errors();
    // A snapshot could not bring the present back on error: restoring it begins a new run with a new number, and the requests that wait in
    // the present run would be refused.
    Run present = run_.set_aside();
    history_.suspend(true);
    auto done = restore(back->from);
    if (done) done = go_forward(back->requests, time);
    if (!done) run_ = std::move(present);
    history_.suspend(false);
    if (done) history_.cut_after(tick());
    return done;
}

Result<void> Simulation::go_forward(const std::vector<History::Asked>& requests, double time)
{
    std::size_t next = 0;
    while (this->time() < time - 0.5 * dt())
    {
        for (; next < requests.size() && requests[next].step == tick(); ++next)
            if (const Reply reply = carry_out_now(requests[next].request); !reply.done)
                return reason("a request of step " + std::to_string(requests[next].step) +
                              " cannot be carried out again: " + (reply.errors.empty() ? std::string() : reply.errors.front().text()));
        if (!step_once()) return reason("the server is shutting down: the rewind was interrupted at step " + std::to_string(tick()));
    }
    // Requests that waited for a step that was made again were replayed with the others.
    run_.forget_late_requests();
    return {};
}

void Simulation::post(Request request) { run_.waiting.push_back({std::make_shared<const Request>(std::move(request)), run_.number}); }

bool Simulation::withdraw(std::uint64_t request)
{
    return std::erase_if(run_.waiting, [&](const WaitingRequest& w) { return w.request->id == request; }) > 0;
}

std::vector<Reply> Simulation::take_replies()
{
    std::vector<Reply> out;
    out.swap(replies_);
    return out;
}

Reply Simulation::carry_out(const Request& request)
{
    Reply reply;
    reply.request = request.id, reply.step = run_.clock.tick, reply.revision = run_.revision;
    if (request.at && *request.at < run_.clock.tick)
    {
        reply.late = true;
        reply.errors = {reason("step " + std::to_string(*request.at) + " has passed, the next one is " + std::to_string(run_.clock.tick))};
        return reply;
    }
    if (request.revision && *request.revision != run_.revision)
    {
        reply.errors = {reason("the scene is at revision " + std::to_string(run_.revision) + ", not " + std::to_string(*request.revision))};
        return reply;
    }
    if (auto set = set_inputs(run_, request))
    {
        if (set->done) history_.note(run_, request);
        return *std::move(set);
    }
    Reply done = Transaction(run_, context_, *this, request).run();
    if (done.done && affects_the_run(request)) run_.watch->begin_anew();
    if (done.done) history_.note(run_, request);
    note_levels();
    return done;
}

Changes Simulation::take_changes()
{
    Changes out;
    std::swap(out, run_.changes);
    return out;
}

bool Simulation::apply_due()
{
    bool any = false;
    for (std::size_t k = 0; k < run_.waiting.size();)
    {
        const WaitingRequest& w = run_.waiting[k];
        if (w.request->at && w.run == run_.number && *w.request->at > run_.clock.tick)
        {
            ++k;
            continue;
        }
        const WaitingRequest due = std::move(run_.waiting[k]);
        run_.waiting.erase(run_.waiting.begin() + static_cast<std::ptrdiff_t>(k));
        replies_.push_back(due.request->at && due.run != run_.number ? outlived(*due.request) : carry_out(*due.request));
        any = true;
        // The request may have begun a new run, which changes which of the waiting requests are due: search again from the front.
        k = 0;
    }
    return any;
}

Reply Simulation::outlived(const Request& request) const
{
    Reply reply;
    reply.request = request.id, reply.step = run_.clock.tick, reply.revision = run_.revision;
    reply.errors = {reason("a new run began before step " + std::to_string(*request.at))};
    return reply;
}

bool Simulation::step()
{
    (void)apply_due();
    own_requests_.clear();
    if (paused()) return false;
    measure_for_governors();
    if (!run_step()) return false;
    ++run_.clock.tick;
    if (run_.clock.steps_left > 0) --run_.clock.steps_left;
    history_.follow(run_);
    return true;
}

bool Simulation::step_once()
{
    own_requests_.clear();
    if (!run_step()) return false;
    ++run_.clock.tick;
    return true;
}

void Simulation::set_interruption(const Interruption* interruption)
{
    context_.interruption = interruption;
    if (run_.live.stepper) run_.stepper().set_interruption(context_.interruption, &context_.progress);
}

bool Simulation::run_step()
{
    run_.changed_by_scripts.clear(), script_changes_.clear();
    const bool watched = run_.levels().watches_anything();
    const std::uint64_t whole_begin = watched ? now_ns() : 0, thread_begin = watched ? thread_ns() : 0;
    decide();
    gave_up_ = false;
    const bool may_be_given_up = context_.interruption != nullptr;
    if (may_be_given_up) step_start_.save(run_.world(), run_.stepper());
    const double start = run_.clock.time_at(run_.clock.tick);
    run_.stepper().draw_for(images_);
    run_.stepper().log_contacts(logs_contacts_);
    run_.watch->before_step(run_.view());
    const std::uint64_t begin = now_ns();
    context_.progress.begin(Activity::Step, run_.clock.tick, begin);
    run_.stepper().step(run_.clock.tick, start, run_.clock.time_at(run_.clock.tick + 1) - start);
    if (may_be_given_up && run_.stepper().gave_up()) take_back_step();
    context_.progress.end();
    if (gave_up_) return false;
    const auto took = static_cast<double>(now_ns() - begin);
    context_.note_cost(took);
    if (watched) note_step_time(whole_begin, thread_begin);
    run_.events = std::move(decided_.events);
    run_.events.insert(run_.events.end(), run_.stepper().events().begin(), run_.stepper().events().end());
    decided_.events.clear();
    run_.watch->after_step(run_.view(), run_.events);
    freeze_lost_objects();
    quarantine_failed();
    read_changed_governors();
    return true;
}

/// What governors spread over steps themselves is no part of what these cost; what others decide is.
void Simulation::note_step_time(std::uint64_t begin, std::uint64_t thread_begin)
{
    const StepCost& told = run_.levels().decision_cost().told;
    const StepCost cost{1e-9 * static_cast<double>(now_ns() - begin) - told.wall,
                        1e-9 * static_cast<double>(thread_ns() - thread_begin) - told.processor};
    if (run_.levels().note_step(cost)) step_times_.add(cost);
}

void Simulation::take_back_step()
{
    gave_up_ = true;
    for (auto change = script_changes_.rbegin(); change != script_changes_.rend(); ++change)
        (void)set_field(run_.world(), change->component, change->name, change->before, run_.changed_by_scripts);
    step_start_.restore(run_.world(), run_.stepper());
    run_.events.clear();
}

void Simulation::freeze_lost_objects()
{
    if (run_.stepper().report().frozen.empty()) return;
    for (const Ref ref : run_.stepper().report().frozen)
    {
        world::HostTables& host = run_.world().host();
        if (ref.facet == Facet::Body) host.bodies.motion[ref.index] = Motion::Static;
        if (ref.facet == Facet::Shaft) host.shafts.motion[ref.index] = Motion::Static;
        run_.world().quarantine(host.component_of(ref), true);
        run_.changes.touched.push_back(run_.world().id_of(ref));
    }
    if (!run_.live.rebuild()) release_lost_objects();
}

/// Frozen objects are static from now on, and a static object cannot be coupled to a prescribed or to another static one. Therefore the
/// couplings of frozen objects are quarantined as well.
void Simulation::release_lost_objects()
{
    for (const Ref ref : run_.stepper().report().frozen)
        for (const std::uint32_t i : run_.world().referrers(run_.world().host().component_of(ref)))
        {
            const model::ComponentType* type = run_.world().type_of(i);
            if (run_.world().component(i).quarantined || !type || !type->takes_part(Phase::Connect)) continue;
            run_.world().quarantine(i, true);
            run_.changes.touched.push_back(run_.world().id_of(i));
            Event e;
            e.time = run_.clock.time_at(run_.clock.tick + 1), e.kind = "state.not_finite", e.severity = Severity::Warning, e.component = i;
            e.message = "is taken out of the step: it couples " + run_.world().id_of(ref) + ", whose state is no longer finite";
            run_.events.push_back(std::move(e));
        }
    const auto rebuilt = run_.live.rebuild();
    assert(rebuilt.ok());  // frozen objects have no couplings left that could be refused
    (void)rebuilt;
}

void Simulation::quarantine_failed()
{
    bool any = false;
    for (const Event& e : run_.events)
    {
        if (e.severity != Severity::Failure || e.component == kNoIndex) continue;
        const world::Component c = run_.world().component(e.component);
        const bool object = c.facet != Facet::Component;
        any = any || (!c.quarantined && !object);
        if (!c.quarantined) run_.changes.touched.push_back(c.id);
        run_.world().quarantine(e.component, true);
    }
    if (any) (void)run_.live.rebuild();
}

void Simulation::apply_script_changes(void* self, std::vector<ParameterChange>& changes)
{
    auto& s = *static_cast<Simulation*>(self);
    bool structure = false;
    for (const ParameterChange& change : changes)
    {
        const std::uint32_t i = s.run_.world().find(change.component);
        const Value before = i == kNoIndex ? Value() : s.run_.world().get(i, change.name);
        auto done = i == kNoIndex ? Result<void>(reason("no component has the id '" + change.component + "'"))
                                  : set_field(s.run_.world(), i, change.name, change.value, s.run_.changed_by_scripts);
        if (done)
        {
            s.script_changes_.push_back({i, change.name, before});
            s.run_.changes.by_scripts.insert(i);
            s.run_.watch->begin_anew();
            structure =
                structure || s.run_.world().type_of(i)->takes_part(Phase::Connect) || s.run_.world().component(i).facet != Facet::Component;
            continue;
        }
        if (type_of(before) != FieldType::None) (void)set_field(s.run_.world(), i, change.name, before, s.run_.changed_by_scripts);
        Event e;
        e.time = s.time(), e.kind = "script.refused", e.severity = Severity::Warning, e.component = i;
        e.message = "set " + change.component + "." + change.name + ": " + done.error().reason;
        s.run_.stepper().emit(std::move(e));
    }
    if (structure) (void)s.run_.stepper().rebuild();
}

}  // namespace plab::simulation
