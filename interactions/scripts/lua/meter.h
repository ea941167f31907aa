/// The limits of a script, the meter of one call, and why a call was ended.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace plab::scripts
{

/// The resource limits of one script.
struct Limits
{
    std::int64_t instructions = 0;  ///< per call
    std::size_t memory = 0;         ///< bytes
};

/// Counts instructions exactly against a budget, in strides of growing length, and the bytes that a call requests against a
/// limit far above what normal code reaches. Once a call has exceeded a limit, it stays in error until the next one starts.
///
/// Only the number of instructions can stop normal code: how many bytes Lua requests depends on its hash seeds, which differ
/// from run to run.
class Meter
{
public:
    /// Bytes that a call may request per instruction of its budget.
    static constexpr std::uint64_t kBytesPerInstruction = 512;

    enum class Doom : std::uint8_t
    {
        None,
        Instructions,
        Traffic,      ///< bytes requested in one call
        Memory,       ///< bytes held at one time
        Text,         ///< a string that is too long
        Interrupted,  ///< the step was interrupted, so the outcome of the call is irrelevant
    };

    void start(std::int64_t budget)
    {
        budget_ = budget, used_ = 0, traffic_ = 0, doom_ = Doom::None;
        stride_ = std::clamp<std::int64_t>(budget, 1, kFirstStride);
    }
    /// Another stride of instructions is done. Returns false if the call is over its budget.
    bool count_stride() { return spend(stride_); }
    /// The next stride: growing, so that a short call triggers no hook at all, and a long one few.
    int next_stride()
    {
        stride_ = std::clamp<std::int64_t>(budget_ - used_, 1, std::min<std::int64_t>(stride_ * 2, kLongestStride));
        return static_cast<int>(stride_);
    }
    int stride() const { return static_cast<int>(stride_); }
    /// Returns false if the call is over its budget.
    bool spend(std::int64_t instructions)
    {
        used_ += std::min(instructions, budget_ + 1);
        if (used_ >= budget_) doom(Doom::Instructions);
        return !doomed();
    }
    /// Returns false if the call requests too much memory.
    bool move(std::size_t bytes)
    {
        traffic_ += bytes;
        if (traffic_ > static_cast<std::uint64_t>(budget_) * kBytesPerInstruction) doom(Doom::Traffic);
        return !doomed();
    }
    void doom(Doom why)
    {
        if (doom_ == Doom::None) doom_ = why;
    }
    bool doomed() const { return doom_ != Doom::None; }
    Doom why() const { return doom_; }
    /// Never more than the true count; at least half of it, or 64 less.
    std::int64_t used() const { return used_; }
    std::int64_t budget() const { return budget_; }

private:
    static constexpr std::int64_t kFirstStride = 64, kLongestStride = 1024;

    std::int64_t budget_ = 0;
    std::int64_t used_ = 0;
    std::int64_t stride_ = 1;
    std::uint64_t traffic_ = 0;
    Doom doom_ = Doom::None;
};

}  // namespace plab::scripts
