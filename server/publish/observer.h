/// Receives the records of a run: implemented by the bus and by a recorder. The step thread calls these functions between
/// steps; none of them may wait, and they may hold memory only in bounded rings.
#pragma once

#include <optional>

#include "plab/context.h"
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
    Forces,
    Contacts,
};

class Observer
{
public:
    virtual ~Observer() = default;

    /// Whether this stream is wanted now. Streams that no observer wants are neither collected nor copied.
    virtual bool wants(Stream stream) const = 0;
    /// Counts the readers that began to want it: a new reader gets a frame, or a sample of metrics, even if nothing moves.
    virtual std::uint64_t joins(Stream) const { return 0; }
    /// Interval of simulated time between States, Contacts, Metrics or Snapshots, s; 0: each step. Empty: use the server's schedule, by
    /// real time.
    virtual std::optional<double> interval(Stream) const { return {}; }

    /// Everything that follows belongs to this time of this run, unless it says otherwise.
    virtual void moment(std::uint64_t /*run*/, double /*time*/) {}
    /// Returns a frame to fill, whose vectors keep the memory of an earlier one; end_frame() hands it over. If all frames are
    /// in use, the oldest unsent one is dropped.
    virtual wire::Frame& begin_frame() = 0;
    virtual void end_frame() = 0;
    /// The same for the contacts of a step.
    virtual wire::ContactForces& begin_contacts() = 0;
    virtual void end_contacts() = 0;
    virtual void collisions(wire::Collisions&& batch) = 0;
    virtual void events(wire::Events&& batch) = 0;
    virtual void metrics(wire::Metrics&& metrics) = 0;
    virtual void image(wire::Image&& image) = 0;
    virtual void journal(wire::Journal&& entry) = 0;
    /// Receives the hash of the state after a step; called for each step in order while Hashes is wanted.
    virtual void hash(std::uint64_t run, Tick step, std::uint64_t hash) = 0;
    virtual void snapshot(wire::Snapshot&& snapshot) = 0;
    virtual void forces(wire::Forces&& /*forces*/) {}
    virtual void status(const wire::Server& status) = 0;
    /// False if there was no room: the next change must then contain everything.
    virtual bool catalogue(CatalogueChange&& change) = 0;
};

}  // namespace plab::publish
