/// A recording in progress: the step thread fills the queue of an asynchronous writer, whose thread makes samples of it.
#pragma once

#include "idl/recording/async_writer.h"
#include "publish/hash_batch.h"
#include "record/entry.h"
#include "record/record.h"
#include "record/topic_writer.h"

namespace plab::record
{

class Recorder final : public Recording
{
public:
    static Result<std::unique_ptr<Recorder>> open(const RecordOptions& options);
    /// Closes the file, if that has not been done.
    ~Recorder() override;

    // Step thread ------------------------------------------------------------------------------------------------------
    bool wants(publish::Stream stream) const override;
    std::optional<double> interval(publish::Stream stream) const override;
    void moment(std::uint64_t run, double time) override { run_ = run, time_ = time; }
    wire::Frame& begin_frame() override;
    void end_frame() override;
    wire::ContactForces& begin_contacts() override { return contacts_; }
    void end_contacts() override;
    void collisions(wire::Collisions&& batch) override;
    void events(wire::Events&& batch) override;
    void metrics(wire::Metrics&& metrics) override;
    void image(wire::Image&& image) override;
    void journal(wire::Journal&& entry) override;
    void hash(std::uint64_t run, Tick step, std::uint64_t hash) override;
    void snapshot(wire::Snapshot&& snapshot) override;
    void status(const wire::Server& status) override;
    bool catalogue(publish::CatalogueChange&& change) override;

    wire::RecordingInfo progress() const override;
    Result<void> close() override;

private:
    /// Vital: what no replay is possible without.
    using Weight = recording::Weight;
    Recorder(const RecordOptions& options, const recording::AsyncWriterOptions& file, recording::McapWriter writer);
    bool push(Entry::Body&& body, std::size_t bytes, Weight weight);
    void push(std::optional<wire::Hashes> record);

    // Writer's thread --------------------------------------------------------------------------------------------------
    std::uint64_t write(recording::TopicFile& file, Entry& entry);

    RecordOptions options_;
    TopicWriter topics_;
    recording::Timeline timeline_;
    recording::Queue<std::unique_ptr<wire::Frame>> spare_;

    // Used by the step thread only.
    std::uint64_t run_ = 0;
    double time_ = 0;
    std::unique_ptr<wire::Frame> filling_;
    wire::ContactForces contacts_;  ///< being filled
    publish::HashBatch hash_batch_;

    recording::AsyncWriter<Entry> writer_;  ///< last: its thread uses the above
};

}  // namespace plab::record
