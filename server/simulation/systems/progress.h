/// What the step thread is doing, for display by other threads; written without locks while the work proceeds.
#pragma once

#include <atomic>
#include <cstdint>

namespace plab::simulation
{

enum class Activity : std::uint8_t
{
    Nothing,  ///< between two steps
    Step,
    TrialOfOld,  ///< a swap's first step with the old component
    TrialOfNew,
    Again,  ///< past steps are recomputed
};

class Progress
{
public:
    struct Reading
    {
        Activity activity = Activity::Nothing;
        std::uint8_t node = 0;       ///< node of the step tree that is running
        std::int64_t step = 0;       ///< the step that follows this tick
        std::uint64_t since_ns = 0;  ///< monotonic, when the activity began
        std::uint64_t node_ns = 0;   ///< monotonic, when the node began
        std::uint64_t work = 0;      ///< evaluations of forces, contact detections and event searches so far
    };

    // Step thread ------------------------------------------------------------------------------------------------------
    void begin(Activity activity, std::int64_t step, std::uint64_t now_ns)
    {
        const Change change(version_);
        activity_.store(activity, relaxed), step_.store(step, relaxed), since_.store(now_ns, relaxed);
        node_.store(0, relaxed), node_since_.store(now_ns, relaxed), work_.store(0, relaxed);
    }
    void enter(std::uint8_t node, std::uint64_t now_ns)
    {
        const Change change(version_);
        node_.store(node, relaxed), node_since_.store(now_ns, relaxed);
    }
    /// Helper threads call this too; a count may be lost if two of them collide.
    void count() { work_.store(work_.load(relaxed) + 1, relaxed); }
    void end()
    {
        const Change change(version_);
        activity_.store(Activity::Nothing, relaxed);
    }

    // Any thread -------------------------------------------------------------------------------------------------------
    Reading read() const
    {
        for (;;)
        {
            const std::uint32_t before = version_.load(std::memory_order_acquire);
            Reading out{activity_.load(relaxed), node_.load(relaxed),       step_.load(relaxed),
                        since_.load(relaxed),    node_since_.load(relaxed), work_.load(relaxed)};
            std::atomic_thread_fence(std::memory_order_acquire);
            if (before % 2 == 0 && version_.load(relaxed) == before) return out;
        }
    }

private:
    static constexpr auto relaxed = std::memory_order_relaxed;
    /// The sequence number is odd during a change; a reader that meets an odd number reads again.
    class Change
    {
    public:
        explicit Change(std::atomic<std::uint32_t>& version) : version_(version)
        {
            version_.store(version_.load(relaxed) + 1, relaxed);
            std::atomic_thread_fence(std::memory_order_release);
        }
        ~Change() { version_.store(version_.load(relaxed) + 1, std::memory_order_release); }
        Change(const Change&) = delete;
        Change& operator=(const Change&) = delete;

    private:
        std::atomic<std::uint32_t>& version_;
    };

    std::atomic<std::uint32_t> version_{0};
    std::atomic<Activity> activity_{Activity::Nothing};
    std::atomic<std::uint8_t> node_{0};
    std::atomic<std::int64_t> step_{0};
    std::atomic<std::uint64_t> since_{0}, node_since_{0}, work_{0};
};

}  // namespace plab::simulation
