/// The work of a recording's writer thread.
#include <cstdio>

#include "record/recorder.h"

namespace plab::record
{
namespace
{

constexpr std::chrono::seconds kSecond(1), kIdle(1);
constexpr std::chrono::milliseconds kTell(100);
/// While entries come at each step, the thread wakes at this interval, not for each entry.
constexpr std::chrono::milliseconds kGather(2);
constexpr std::size_t kBurst = 256;

}  // namespace

void Recorder::run()
{
    bool busy = false;
    while (!stop_.load(std::memory_order_acquire))
    {
        const bool any = pass();
        const auto due = writer_.due();
        std::chrono::nanoseconds idle = kIdle;
        if (due) idle = std::min<std::chrono::nanoseconds>(idle, std::max<std::chrono::nanoseconds>(*due - recording::Clock::now(), {}));
        if (busy && any)
            std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(kGather, idle));
        else if (queue_.size() == 0)
            wake_up_.sleep(idle);
        busy = any;
    }
    while (pass()) continue;
}

/// Writes what waits. True if there was something.
bool Recorder::pass()
{
    bool any = false;
    for (std::size_t i = 0; i < kBurst; ++i)
    {
        auto entry = queue_.pop();
        if (!entry) break;
        any = true;
        write(*entry);
        waiting_bytes_.fetch_sub(entry->bytes, std::memory_order_relaxed);
        give_back(*entry);
    }
    const recording::Clock::time_point now = recording::Clock::now();
    writer_.tick(now);
    look_after_disk(now);
    return any;
}

void Recorder::write(Entry& entry)
{
    // Snapshots are serialized in parallel with the run and arrive late: they are placed at the time when they were taken, a
    // run's first one before the run.
    const auto* snapshot = std::get_if<publish::SnapshotRecord>(&entry.body);
    const std::uint64_t log_time = snapshot ? timeline_.at(snapshot->run, snapshot->time) : timeline_.at(entry.run, entry.time);
    if (entry.lost.messages > 0)
    {
        entry.lost.first_log_time = entry.lost.last_log_time = log_time;
        // look_after_disk reports trouble with the disk itself.
        (void)writer_.add_gap(entry.lost, "the writer did not keep up with the simulation");
    }
    topics_.put(entry, {log_time, static_cast<std::uint64_t>(entry.stamp_ns), recording::Clock::now()});
}

void Recorder::give_back(Entry& entry)
{
    if (auto* frame = std::get_if<std::unique_ptr<publish::Frame>>(&entry.body)) (void)spare_.push(*frame);
}

void Recorder::look_after_disk(recording::Clock::time_point now)
{
    if (auto error = topics_.take_error()) say("recording " + options_.file + ": " + error->reason);
    if (writer_.trouble())
    {
        if (!in_trouble_) say("recording is stalled, the simulation continues: " + writer_.trouble()->reason);
        in_trouble_ = true;
        if (now - tried_ >= kSecond) tried_ = now, (void)writer_.retry();
    }
    else if (in_trouble_ && now - tried_ >= 2 * kSecond)
    {
        // A disk that accepted a few bytes is not yet considered healthy.
        in_trouble_ = false;
        say("recording " + options_.file + " continues: the disk accepts writes again");
    }
    if (now - warned_at_ < kTell) return;
    warned_at_ = now;
    tell_progress();
}

void Recorder::tell_progress()
{
    const recording::Statistics statistics = writer_.statistics();
    const std::lock_guard lock(mutex_);
    progress_.bytes = writer_.file_size(), progress_.messages = statistics.messages;
    progress_.dropped = writer_.dropped().messages;
    progress_.trouble = writer_.trouble() ? writer_.trouble()->reason : std::string();
}

void Recorder::say(const std::string& line)
{
    if (options_.log != nullptr)
        options_.log(options_.log_argument, line.c_str());
    else
        (void)std::fprintf(stderr, "%s\n", line.c_str());
}

}  // namespace plab::record
