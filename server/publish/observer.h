/// Who watches a run: the bus, a recorder. The step thread calls these between steps; none of them waits, and the only
/// memory that they hold is that of bounded rings.
#pragma once

#include <optional>

#include "publish/records.h"

namespace plab::publish
{

enum class Stream : std::uint8_t
{
    States,
    Collisions,
    Events,
    Metrics,
    Images,
    Journal,
    Hashes,
    Snapshots,
};

class Observer
{
public:
    virtual ~Observer() = default;

    /// Whether anybody wants this stream now. Where nobody does, nothing is collected or copied.
    virtual bool wants(Stream stream) const = 0;
    /// Counts those who began to want it: whoever is new gets a frame, or a sample of metrics, also while nothing moves.
    virtual std::uint64_t joins(Stream) const { return 0; }
    /// s of simulated time between what it gets of States, Metrics or Snapshots; 0: each step. Nothing: as the server
    /// does it, by real time.
    virtual std::optional<double> interval(Stream) const { return {}; }

    /// What follows belongs to this time of this run, unless it says otherwise.
    virtual void moment(std::uint64_t /*run*/, double /*time*/) {}
    /// A frame to fill, its vectors with the memory of an earlier one; end_frame() hands it over. The oldest unsent one
    /// is given up when all are full.
    virtual Frame& begin_frame() = 0;
    virtual void end_frame() = 0;
    virtual void collisions(Batch<CollisionRecord>&& batch) = 0;
    virtual void events(Batch<EventRecord>&& batch) = 0;
    virtual void metrics(Metrics&& metrics) = 0;
    virtual void image(Image&& image) = 0;
    virtual void journal(JournalRecord&& entry) = 0;
    /// The hash of the state after a step; asked for at each step in turn while Hashes is wanted.
    virtual void hash(std::uint64_t run, Tick step, std::uint64_t hash) = 0;
    virtual void snapshot(SnapshotRecord&& snapshot) = 0;
    virtual void status(const Status& status) = 0;
    /// False if there was no room: the next change must be everything.
    virtual bool catalogue(CatalogueChange&& change) = 0;
};

}  // namespace plab::publish
