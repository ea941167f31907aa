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
    publish::Frame& begin_frame() override { return frame; }
    void end_frame() override { ++frames; }
    void collisions(publish::Batch<publish::CollisionRecord>&& batch) override { collision_batches.push_back(std::move(batch)); }
    void events(publish::Batch<publish::EventRecord>&& batch) override { event_batches.push_back(std::move(batch)); }
    void metrics(publish::Metrics&& metrics) override { samples.push_back(std::move(metrics)); }
    void image(publish::Image&&) override {}
    std::optional<double> interval(publish::Stream stream) const override
    {
        const auto found = intervals.find(stream);
        return found == intervals.end() ? std::nullopt : std::optional(found->second);
    }
    void journal(publish::JournalRecord&& entry) override { journals.push_back(std::move(entry)); }
    void hash(std::uint64_t, Tick step, std::uint64_t hash) override { hashes[step] = hash; }
    void snapshot(publish::SnapshotRecord&& snapshot) override { snapshots.push_back(std::move(snapshot)); }
    void status(const publish::Status& status) override { statuses.push_back(status); }
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

    publish::Frame frame;  ///< the last one
    std::size_t frames = 0;
    std::vector<publish::Batch<publish::CollisionRecord>> collision_batches;
    std::vector<publish::Batch<publish::EventRecord>> event_batches;
    std::vector<publish::Metrics> samples;
    std::vector<publish::Status> statuses;
    std::vector<publish::CatalogueChange> changes;
    std::vector<publish::JournalRecord> journals;
    std::map<Tick, std::uint64_t> hashes;
    std::vector<publish::SnapshotRecord> snapshots;
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
        if (e.component == component) return &e;
    return nullptr;
}

inline std::string parameter(const std::vector<publish::Parameter>& parameters, const std::string& name)
{
    for (const publish::Parameter& p : parameters)
        if (p.name == name) return p.text;
    return "none";
}

/// The ids of all entries, sorted.
inline std::set<std::string> ids_in(const publish::CatalogueChange& change)
{
    std::set<std::string> out;
    for (const auto& e : change.objects) out.insert(e.component);
    for (const auto& e : change.shapes) out.insert(e.component);
    for (const auto& e : change.interactions) out.insert(e.component);
    return out;
}

}  // namespace plab::test
