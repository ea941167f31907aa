#include "simulation/simulation.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "model/alike.h"
#include "simulation/costs/clock.h"
#include "simulation/requests/field_change.h"
#include "simulation/requests/transaction.h"
#include "simulation/snapshot/history.h"
#include "simulation/watch/divergence_watch.h"

namespace plab::simulation
{

Simulation::Simulation(model::TypeSource& types, int threads)
    : types_(&types), threads_(threads), watch_(std::make_unique<DivergenceWatch>()), history_(std::make_unique<History>())
{
}
Simulation::~Simulation() = default;

Result<Simulation::Live> Simulation::build(const model::SceneSpec& scene)
{
    Live live;
    live.world = std::make_unique<world::World>(*types_);
    live.world->describe(scene.settings, scene.file);
    if (auto added = live.world->add(scene); !added) return added.errors();
    live.stepper = std::make_unique<Stepper>(*live.world, threads_);
    if (auto built = live.stepper->rebuild(); !built)
    {
        Errors errors = built.errors();
        for (Error& e : errors)
            if (e.where.file.empty()) e.where.file = scene.file;
        return model::first_of_alike(std::move(errors));
    }
    return live;
}

void Simulation::begin_run(Live live, std::shared_ptr<const model::SceneSpec> scene)
{
    stepper_ = std::move(live.stepper);
    world_ = std::move(live.world);
    stepper_->on_changes(&Simulation::apply_script_changes, this);
    stepper_->obey(interruption_, &progress_);
    loaded_ = std::move(scene);
    dt_ = loaded_->settings.dt;
    tick_ = base_tick_ = 0;
    base_time_ = 0;
    events_.clear();
    changed_by_scripts_.clear();
    ++run_;
    changes_ = {};
    changes_.everything = true;
    *watch_ = {};
    kinetic_at_start_ = totals().kinetic;
}

Result<void> Simulation::load(const model::SceneSpec& scene)
{
    auto live = build(scene);
    if (!live) return live.errors();
    begin_run(live.take(), std::make_shared<const model::SceneSpec>(scene));
    history_->begin(*this);
    return {};
}

double Simulation::time_at(Tick tick) const
{
    // t = n dt in one rounding; after a change of dt, from the time at which it changed.
    return base_tick_ == 0 ? dt_.at(tick) : base_time_ + dt_.at(tick - base_tick_);
}

void Simulation::post(Request request) { requests_.push_back({std::make_shared<const Request>(std::move(request)), run_}); }

bool Simulation::withdraw(std::uint64_t request)
{
    return std::erase_if(requests_, [&](const Waiting& w) { return w.request->id == request; }) > 0;
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
    reply.request = request.id, reply.step = tick_, reply.revision = revision_;
    if (request.at && *request.at < tick_)
    {
        reply.late = true;
        reply.errors = {reason("step " + std::to_string(*request.at) + " has passed, the next one is " + std::to_string(tick_))};
        return reply;
    }
    if (request.revision && *request.revision != revision_)
    {
        reply.errors = {reason("the scene is at revision " + std::to_string(revision_) + ", not " + std::to_string(*request.revision))};
        return reply;
    }
    Reply done = Transaction(*this, request).run();
    if (done.done && affects_the_run(request)) watch_->begin_anew();
    if (done.done) history_->note(*this, request);
    return done;
}

Changes Simulation::take_changes()
{
    Changes out;
    std::swap(out, changes_);
    return out;
}

bool Simulation::apply_due()
{
    bool any = false;
    for (std::size_t k = 0; k < requests_.size();)
    {
        const Waiting& w = requests_[k];
        if (w.request->at && w.run == run_ && *w.request->at > tick_)
        {
            ++k;
            continue;
        }
        const Waiting due = std::move(requests_[k]);
        requests_.erase(requests_.begin() + static_cast<std::ptrdiff_t>(k));
        replies_.push_back(due.request->at && due.run != run_ ? outlived(*due.request) : carry_out(*due.request));
        any = true;
        // A new run concerns those that wait: from the front again.
        k = 0;
    }
    return any;
}

Reply Simulation::outlived(const Request& request) const
{
    Reply reply;
    reply.request = request.id, reply.step = tick_, reply.revision = revision_;
    reply.errors = {reason("a new run began before step " + std::to_string(*request.at))};
    return reply;
}

bool Simulation::step()
{
    (void)apply_due();
    if (paused()) return false;
    if (!run_step()) return false;
    ++tick_;
    if (steps_left_ > 0) --steps_left_;
    history_->follow(*this);
    return true;
}

bool Simulation::step_once()
{
    if (!run_step()) return false;
    ++tick_;
    return true;
}

void Simulation::obey(const Interruption* interruption)
{
    interruption_ = interruption;
    if (stepper_) stepper_->obey(interruption_, &progress_);
}

void Simulation::forget_late_requests()
{
    std::erase_if(requests_, [&](const Waiting& w) { return w.run == run_ && w.request->at && *w.request->at < tick_; });
}

bool Simulation::run_step()
{
    changed_by_scripts_.clear(), script_changes_.clear();
    gave_up_ = false;
    const bool may_be_given_up = interruption_ != nullptr;
    if (may_be_given_up) step_start_.save(*world_, *stepper_);
    const double start = time_at(tick_);
    stepper_->draw_for(images_);
    watch_->before_step(view());
    const std::uint64_t begin = now_ns();
    progress_.begin(Activity::Step, tick_, begin);
    stepper_->step(tick_, start, time_at(tick_ + 1) - start);
    if (may_be_given_up && stepper_->gave_up()) take_back_step();
    progress_.end();
    if (gave_up_) return false;
    note_cost(static_cast<double>(now_ns() - begin));
    events_ = stepper_->events();
    watch_->after_step(view(), events_);
    freeze_lost_objects();
    quarantine_failed();
    return true;
}

void Simulation::note_cost(double ns)
{
    // Of all steps while they are few, then of about the last hundred.
    constexpr std::uint64_t kMost = 100;
    steps_timed_ = std::min(steps_timed_ + 1, kMost);
    mean_step_ns_ += (ns - mean_step_ns_) / static_cast<double>(steps_timed_);
}

void Simulation::take_back_step()
{
    gave_up_ = true;
    for (auto change = script_changes_.rbegin(); change != script_changes_.rend(); ++change)
        (void)set_field(*world_, change->component, change->name, change->before, changed_by_scripts_);
    step_start_.restore(*world_, *stepper_);
    events_.clear();
}

void Simulation::freeze_lost_objects()
{
    if (stepper_->report().frozen.empty()) return;
    for (const Ref ref : stepper_->report().frozen)
    {
        world::HostTables& host = world_->host();
        if (ref.facet == Facet::Body) host.bodies.motion[ref.index] = Motion::Static;
        if (ref.facet == Facet::Shaft) host.shafts.motion[ref.index] = Motion::Static;
        world_->quarantine(host.component_of(ref), true);
        changes_.touched.push_back(world_->id_of(ref));
    }
    if (!stepper_->rebuild()) release_lost_objects();
}

/// What stands still now may not be coupled to what is prescribed, or to another that stands: such couplings are taken out, too.
void Simulation::release_lost_objects()
{
    for (const Ref ref : stepper_->report().frozen)
        for (const std::uint32_t i : world_->referrers(world_->host().component_of(ref)))
        {
            const model::ComponentType* type = world_->type_of(i);
            if (world_->component(i).quarantined || !type || !type->takes_part(Phase::Connect)) continue;
            world_->quarantine(i, true);
            changes_.touched.push_back(world_->id_of(i));
            Event e;
            e.time = time_at(tick_ + 1), e.kind = "state.not_finite", e.severity = Severity::Warning, e.component = i;
            e.message = "takes no part any more: it couples " + world_->id_of(ref) + ", which left the numbers";
            events_.push_back(std::move(e));
        }
    const auto rebuilt = stepper_->rebuild();
    assert(rebuilt.ok());  // nobody that stands is coupled to anybody
    (void)rebuilt;
}

void Simulation::quarantine_failed()
{
    bool any = false;
    for (const Event& e : events_)
    {
        if (e.severity != Severity::Failure || e.component == kNoIndex) continue;
        const world::Component c = world_->component(e.component);
        const bool object = c.facet != Facet::Component;
        any = any || (!c.quarantined && !object);
        if (!c.quarantined) changes_.touched.push_back(c.id);
        world_->quarantine(e.component, true);
    }
    if (any) (void)stepper_->rebuild();
}

void Simulation::apply_script_changes(void* self, std::vector<ParameterChange>& changes)
{
    auto& s = *static_cast<Simulation*>(self);
    bool structure = false;
    for (const ParameterChange& change : changes)
    {
        const std::uint32_t i = s.world_->find(change.component);
        const Value before = i == kNoIndex ? Value() : s.world_->get(i, change.name);
        auto done = i == kNoIndex ? Result<void>(reason("no component has the id '" + change.component + "'"))
                                  : set_field(*s.world_, i, change.name, change.value, s.changed_by_scripts_);
        if (done)
        {
            s.script_changes_.push_back({i, change.name, before});
            s.changes_.by_scripts.insert(i);
            s.watch_->begin_anew();
            structure = structure || s.world_->type_of(i)->takes_part(Phase::Connect) || s.world_->component(i).facet != Facet::Component;
            continue;
        }
        if (type_of(before) != FieldType::None) (void)set_field(*s.world_, i, change.name, before, s.changed_by_scripts_);
        Event e;
        e.time = s.time(), e.kind = "script.refused", e.severity = Severity::Warning, e.component = i;
        e.message = "set " + change.component + "." + change.name + ": " + done.error().reason;
        s.stepper_->emit(std::move(e));
    }
    if (structure) (void)s.stepper_->rebuild();
}

Totals Simulation::totals() const { return totals_of(*world_, *stepper_, time(), tick_); }

double Simulation::error_of(std::uint32_t component) const { return world_->largest_error(component); }

}  // namespace plab::simulation
