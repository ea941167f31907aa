/// A recording whose producer never waits for the disk: a bounded queue, and one thread that empties it into the file. Entries
/// that find no room are dropped, counted, and noted in the file as a gap.
#pragma once

#include "idl/recording/file_thread.h"
#include "idl/recording/queue.h"

namespace plab::recording
{

/// What is dropped first when the disk does not keep up.
enum class Weight : std::uint8_t
{
    Detail,     ///< may use up to half of the room
    Essential,  ///< may use all of it
    Vital,      ///< small entries that nothing can replace: accepted as long as the queue has a slot
};

/// One thread pushes. Entry: what it hands over; default constructible, and cheap to move.
template <class Entry>
class AsyncWriter final : private FileThread::Source
{
public:
    /// Writes an entry, and returns its log_time. Called on the writer's thread.
    using Write = std::function<std::uint64_t(TopicFile& file, Entry& entry)>;

    /// What `write` uses must outlive close().
    AsyncWriter(McapWriter writer, const AsyncWriterOptions& options, Write write)
        : write_(std::move(write)),
          most_waiting_bytes_(options.most_waiting_bytes),
          queue_(options.most_waiting),
          thread_(std::move(writer), options, *this)
    {
        thread_.start();
    }
    ~AsyncWriter() { (void)close(); }

    bool has_room(std::size_t bytes, Weight weight) const
    {
        if (weight == Weight::Vital) return queue_.size() < queue_.capacity();
        const std::size_t part = weight == Weight::Detail ? 2 : 1;
        return queue_.size() < queue_.capacity() - queue_.capacity() / 4 * part &&
               waiting_bytes_.load(std::memory_order_relaxed) + bytes <= most_waiting_bytes_ / part;
    }

    /// `bytes`: the approximate memory that the entry uses. False: there was no room, and the entry is gone.
    bool push(Entry&& entry, std::size_t bytes, Weight weight)
    {
        // A single entry larger than the room is accepted when nothing else waits: a snapshot of a huge scene.
        const bool fits = has_room(bytes, weight) || (weight == Weight::Essential && queue_.size() == 0);
        Slot slot{std::move(entry), bytes, lost_messages_, lost_bytes_};
        waiting_bytes_.fetch_add(bytes, std::memory_order_relaxed);
        if (fits && queue_.push(slot))
        {
            lost_messages_ = lost_bytes_ = 0;
            thread_.wake();
            return true;
        }
        waiting_bytes_.fetch_sub(bytes, std::memory_order_relaxed);
        drop(bytes);
        return false;
    }
    /// Counts an entry that was not pushed for lack of room.
    void drop(std::size_t bytes)
    {
        ++lost_messages_, lost_bytes_ += bytes;
        dropped_here_.fetch_add(1, std::memory_order_relaxed);
    }

    /// From any thread.
    WriteProgress progress() const
    {
        WriteProgress out = thread_.progress();
        out.dropped += dropped_here_.load(std::memory_order_relaxed);
        return out;
    }
    /// Writes what waits and completes the file. An error: the file is as after a crash, intact up to the failure; progress()
    /// still reports how far it got. Nothing may be pushed afterwards.
    Result<void> close() { return thread_.close(lost_messages_, lost_bytes_); }

private:
    struct Slot
    {
        Entry entry;
        std::size_t bytes = 0;
        std::uint64_t lost_messages = 0, lost_bytes = 0;  ///< dropped before this entry
    };
    static constexpr std::size_t kBurst = 256;  // the file gets its due in between

    // Writer's thread --------------------------------------------------------------------------------------------------
    bool write_some(TopicFile& file) override
    {
        bool any = false;
        for (std::size_t i = 0; i < kBurst; ++i)
        {
            auto slot = queue_.pop();
            if (!slot) break;
            any = true;
            thread_.note(write_(file, slot->entry), slot->lost_messages, slot->lost_bytes);
            waiting_bytes_.fetch_sub(slot->bytes, std::memory_order_relaxed);
        }
        return any;
    }
    bool is_empty() const override { return queue_.size() == 0; }

    Write write_;
    const std::size_t most_waiting_bytes_;
    Queue<Slot> queue_;
    std::atomic<std::size_t> waiting_bytes_{0};
    std::atomic<std::uint64_t> dropped_here_{0};
    std::uint64_t lost_messages_ = 0, lost_bytes_ = 0;  ///< since the last entry that was accepted; producer's
    FileThread thread_;                                 ///< last: it uses all of the above
};

}  // namespace plab::recording
