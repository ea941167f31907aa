/// A recording in progress: a queue that the step thread fills, and one thread that empties it into the file.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

#include "publish/hash_batch.h"
#include "publish/queue.h"
#include "publish/wake_up.h"
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
    publish::Frame& begin_frame() override;
    void end_frame() override;
    void collisions(publish::Batch<publish::CollisionRecord>&& batch) override;
    void events(publish::Batch<publish::EventRecord>&& batch) override;
    void metrics(publish::Metrics&& metrics) override;
    void image(publish::Image&& image) override;
    void journal(publish::JournalRecord&& entry) override;
    void hash(std::uint64_t run, Tick step, std::uint64_t hash) override;
    void snapshot(publish::SnapshotRecord&& snapshot) override;
    void status(const publish::Status& status) override;
    bool catalogue(publish::CatalogueChange&& change) override;

    publish::RecordingStatus progress() const override;
    Result<void> close() override;

private:
    /// What is dropped first when the writer does not keep up.
    enum class Weight
    {
        Detail,     ///< may use up to half of the room
        Essential,  ///< may use all of it
        Vital,      ///< small entries without which no replay is possible: accepted as long as the queue has a slot
    };
    Recorder(const RecordOptions& options, recording::Writer writer);
    bool push(Entry::Body&& body, std::size_t bytes, Weight weight);
    void push(std::optional<publish::HashRecord> record);
    bool has_room(std::size_t bytes, Weight weight) const;

    // Writer's thread --------------------------------------------------------------------------------------------------
    void run();
    bool pass();
    void write(Entry& entry);
    void give_back(Entry& entry);
    void look_after_disk(recording::Clock::time_point now);
    void tell_progress();
    void say(const std::string& line);

    RecordOptions options_;
    recording::Writer writer_;
    TopicWriter topics_;
    recording::Timeline timeline_;

    publish::Queue<Entry> queue_;
    publish::Queue<std::unique_ptr<publish::Frame>> spare_;
    std::atomic<std::size_t> waiting_bytes_{0};
    publish::WakeUp wake_up_;
    std::atomic<bool> stop_{false};

    // Used by the step thread only.
    std::uint64_t run_ = 0;
    double time_ = 0;
    std::unique_ptr<publish::Frame> filling_;
    publish::HashBatch hash_batch_;
    recording::Losses lost_;

    // Used by the writer's thread only.
    recording::Clock::time_point tried_{}, warned_at_{};
    bool in_trouble_ = false;
    bool closed_ = false;
    std::optional<Error> close_error_;

    mutable std::mutex mutex_;  ///< protects only progress_, held for a copy
    publish::RecordingStatus progress_;
    std::atomic<std::uint64_t> dropped_here_{0};
    std::thread thread_;
};

}  // namespace plab::record
