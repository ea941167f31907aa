/// An observer that keeps what it receives, and the run that it observes.
#pragma once

#include <map>
#include <set>

#include "publish/collector.h"
#include "support/scene.h"

namespace plab::test
{

class Watcher final : public publish::Observer
{
public:
    bool wants(publish::Stream stream) const override { return wanted.contains(stream); }
    std::uint64_t joins(publish::Stream) const override { return joined; }
    wire::Frame& begin_frame() override { return frame; }
    void end_frame() override { ++frames; }
    wire::ContactForces& begin_contacts() override { return contacts; }
    void end_contacts() override { ++contact_samples; }
    void collisions(wire::Collisions&& batch) override { collision_batches.push_back(std::move(batch)); }
    void events(wire::Events&& batch) override { event_batches.push_back(std::move(batch)); }
    void metrics(wire::Metrics&& metrics) override { samples.push_back(std::move(metrics)); }
    void image(wire::Image&&) override {}
    std::optional<double> interval(publish::Stream stream) const override
    {
        const auto found = intervals.find(stream);
        return found == intervals.end() ? std::nullopt : std::optional(found->second);
    }
    void journal(wire::Journal&& entry) override { journals.push_back(std::move(entry)); }
    void hash(std::uint64_t, Tick step, std::uint64_t hash) override { hashes[step] = hash; }
    void snapshot(wire::Snapshot&& snapshot) override { snapshots.push_back(std::move(snapshot)); }
    void status(const wire::Server& status) override { statuses.push_back(status); }
    bool catalogue(publish::CatalogueChange&& change) override
    {
        if (!has_room) return false;
        changes.push_back(std::move(change));
        return true;
    }

    std::set<publish::Stream> wanted;
    std::uint64_t joined = 0;
    bool has_room = true;
    std::map<publish::Stream, double> intervals;

    wire::Frame frame;  ///< the last one
    std::size_t frames = 0;
    wire::ContactForces contacts;  ///< the last ones
    std::size_t contact_samples = 0;
    std::vector<wire::Collisions> collision_batches;
    std::vector<wire::Events> event_batches;
    std::vector<wire::Metrics> samples;
    std::vector<wire::Server> statuses;
    std::vector<publish::CatalogueChange> changes;
    std::vector<wire::Journal> journals;
    std::map<Tick, std::uint64_t> hashes;
    std::vector<wire::Snapshot> snapshots;
};

/// Intervals longer than any test, so that everything sent was requested.
inline constexpr publish::CollectorOptions kRarely{1e-3, 1e-3};
inline constexpr publish::CollectorOptions kAlways{0, 0};

class Watched
{
public:
    explicit Watched(Scene& scene, publish::CollectorOptions options = kAlways,
                     std::set<publish::Stream> wanted = {publish::Stream::States, publish::Stream::Collisions, publish::Stream::Events,
                                                         publish::Stream::Metrics})
        : scene_(scene), collector(options, library().summaries())
    {
        watcher.wanted = std::move(wanted);
        collector.attach(watcher);
    }
    void step(std::int64_t n = 1)
    {
        for (std::int64_t i = 0; i < n; ++i)
        {
            collector.prepare(scene_.simulation());
            scene_.step();
            collector.collect(scene_.simulation(), scene_.simulation().take_changes(), true);
        }
    }
    /// One request between two steps, and what is published because of it.
    simulation::Reply ask(simulation::Operation operation)
    {
        const simulation::Reply reply = scene_.ask(std::move(operation));
        CHECK_MESSAGE(reply.done, first_error(reply.errors));
        settle();
        return reply;
    }
    void settle() { collector.collect(scene_.simulation(), scene_.simulation().take_changes(), false); }

private:
    Scene& scene_;

public:
    Watcher watcher;
    publish::Collector collector;
};

template <class Entry>
const Entry* find_entry(const std::vector<Entry>& entries, const std::string& component)
{
    for (const Entry& e : entries)
        if (e.component_id == component) return &e;
    return nullptr;
}

inline std::string parameter(const std::vector<wire::Parameter>& parameters, const std::string& name)
{
    for (const wire::Parameter& p : parameters)
        if (p.name == name) return p.text;
    return "none";
}

/// The ids of all entries, sorted.
inline std::set<std::string> ids_in(const publish::CatalogueChange& change)
{
    std::set<std::string> out;
    for (const auto& e : change.objects) out.insert(e.component_id);
    for (const auto& e : change.shapes) out.insert(e.component_id);
    for (const auto& e : change.interactions) out.insert(e.component_id);
    return out;
}

}  // namespace plab::test
