/// The part of the service that concerns recordings, snapshots and the requests that snapshots contain.
#include <spdlog/spdlog.h>

#include "control/waiting.h"
#include "daemon/service.h"
#include "simulation/snapshot/history.h"

namespace plab::daemon
{

Result<void> Service::open_recording(const DaemonOptions& options)
{
    auto module = RecordModule::load_for_writing();
    if (!module) return module.errors();
    record::RecordOptions record = record_options(options, *simulation_, *library_);
    record.log = [](void*, const char* line) { spdlog::warn("{}", line); };
    auto opened = module->record(record);
    if (!opened) return opened.errors();
    record_module_ = module.take(), recording_ = opened.take();
    collector_.attach(*recording_);
    simulation_->draw_for(this);
    return {};
}

bool Service::wanted() const
{
    return (bus_ && bus_->wants(publish::Stream::Images)) || (recording_ && recording_->wants(publish::Stream::Images));
}

bool Service::close_recording()
{
    if (!recording_) return true;
    snapshots_.finish();
    send_snapshots();
    const auto closed = recording_->close();
    const wire::RecordingInfo status = recording_->progress();
    if (!closed) spdlog::error("{}", closed.error().reason);
    if (status.dropped > 0) spdlog::warn("{}: {} messages were dropped on the way to the file", status.file, status.dropped);
    spdlog::info("recorded {} messages in {} bytes: {}", status.messages, status.bytes, status.file);
    return static_cast<bool>(closed);
}

Result<void> Service::take_over(const std::vector<std::string>& waiting)
{
    for (const std::string& words : waiting)
    {
        auto text = control::read_request(words);
        if (!text) return text.errors();
        auto wanted = control::wanted_of(*text, *library_, simulation_->limits());
        if (!wanted) return wanted.errors();
        Origin origin;
        origin.texts = std::move(text->operations);
        post(std::move(wanted->request), std::move(origin));
    }
    return {};
}

std::vector<std::string> Service::words_of(const simulation::Snapshot& snapshot) const
{
    std::vector<std::string> out;
    for (const auto& request : snapshot->waiting)
    {
        wire::Request text;
        if (const auto said = timed_.find(request->id); said != timed_.end())
            text.operations = said->second.texts;
        else if (const auto asked = waiting_.find(request->id); asked != waiting_.end())
            text.operations = asked->second.texts;  // without a step: it came together with the request for the snapshot
        else
            spdlog::warn("a request that waits for step {} is too old: the snapshot does not contain it", request->at.value_or(-1));
        if (request->at) text.at = *request->at;
        if (request->revision) text.revision = static_cast<std::int64_t>(*request->revision);
        out.push_back(control::text_of(text));
    }
    return out;
}

Result<void> Service::save(const std::string& file) const
{
    const simulation::Snapshot snapshot = simulation_->capture();
    return write_snapshot(snapshot, words_of(snapshot), file);
}

void Service::write_journal(const Origin& origin, const simulation::Reply& reply)
{
    wire::Journal entry;
    entry.run = simulation_->run(), entry.revision = reply.revision, entry.step = reply.step, entry.time = simulation_->time();
    entry.origin = origin.from_bus ? "client" : "command line";
    entry.client = origin.client, entry.number = origin.number, entry.operations = origin.texts;
    collector_.journal(std::move(entry));
    send_named_snapshots(origin);
}

void Service::note_own(const simulation::Reply& reply)
{
    if (!reply.done) return;
    wire::Journal entry;
    entry.run = simulation_->run(), entry.revision = reply.revision, entry.step = reply.step, entry.time = simulation_->time();
    entry.origin = reply.decided_by.empty() ? wire::kMeasured : wire::kDecidedByComponent;
    for (const simulation::Operation& op : reply.made->operations) entry.operations.push_back(control::text_of(op));
    collector_.journal(std::move(entry));
}

/// Readers of snapshots also get those that clients request: this is how a client downloads one.
void Service::send_named_snapshots(const Origin& origin)
{
    if (!collector_.anybody_reads_snapshots()) return;
    for (const wire::Operation& op : origin.texts)
    {
        if (op.verb != "snapshot") continue;
        const auto& named = simulation_->history().named();
        if (const auto kept = named.find(op.target); kept != named.end()) make_snapshot(kept->second.snapshot, op.target, "request");
    }
}

void Service::make_snapshot(const simulation::Snapshot& snapshot, const std::string& name, const char* cause)
{
    if (snapshots_.begin(snapshot, words_of(snapshot), name, cause)) return;
    // Logged at the first, the second, the fourth ... occurrence, so that the log does not fill up.
    if (const std::uint64_t n = snapshots_.left_out(); (n & (n - 1)) == 0)
        spdlog::warn("{} snapshots were skipped so far: they are requested faster than they can be written", n);
}

/// Hands over the snapshots that are complete; neither they nor the loop wait for others.
void Service::send_snapshots()
{
    while (auto made = snapshots_.take())
        if (*made)
            collector_.snapshot(**made);
        else
            spdlog::error("no snapshot was written: {}", made->error().text());
}

std::vector<wire::KeptSnapshot> Service::kept_snapshots() const
{
    std::vector<wire::KeptSnapshot> out;
    for (const auto& [name, kept] : simulation_->history().named())
        out.push_back({name, kept.snapshot->run, kept.snapshot->clock.tick, kept.snapshot->clock.time(), kept.bytes});
    return out;
}

}  // namespace plab::daemon
