/// The part of the service that concerns people in the scene.
#include "daemon/service.h"
#include "simulation/costs/clock.h"

namespace plab::daemon
{

void Service::take_people()
{
    if (!bus_) return;
    bus_->take_people(samples_);
    const auto tell = [this](const char* kind, const std::string& component, const std::string& message)
    {
        wire::EventInfo event;
        event.kind = kind, event.severity = "warning", event.component_id = component, event.message = message;
        collector_.note(*simulation_, std::move(event));
    };
    people_.move(
        samples_, static_cast<std::int64_t>(simulation::now_ns()), [this](const People::Ask& ask) { return move(ask); }, tell);
}

/// Such requests have no reply and no event: there may be thousands a second. They are in the journal.
simulation::Reply Service::move(const People::Ask& ask)
{
    const simulation::Reply reply = simulation_->carry_out_now(ask.request);
    if (!reply.done || !collector_.anybody_reads(publish::Stream::Journal)) return reply;
    wire::Journal entry;
    entry.run = simulation_->run(), entry.revision = reply.revision, entry.step = reply.step, entry.time = simulation_->time();
    entry.origin = ask.is_user ? "user" : "viewer";
    entry.client = ask.client, entry.number = ask.number, entry.operations = {ask.words};
    collector_.journal(std::move(entry));
    return reply;
}

void Service::publish_forces()
{
    if (!collector_.anybody_reads(publish::Stream::Forces)) return;
    wire::Forces forces;
    forces.entries = people_.forces();
    if (forces.entries.empty()) return;
    forces.run = simulation_->run(), forces.step = simulation_->tick(), forces.time = simulation_->time();
    collector_.forces(std::move(forces));
}

}  // namespace plab::daemon
