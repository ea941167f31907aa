/// What a call may spend, and why it was ended.
#pragma once

#include <algorithm>
#include <cstdint>

namespace plab::scripts
{

/// Counts instructions exactly against a budget, in strides that grow, and the bytes that a call asks for against a
/// limit far above what honest code reaches. Once a call is doomed it stays so until the next one starts.
///
/// Only the instructions decide on honest code: how many bytes Lua asks for depends on hash seeds, which differ from
/// run to run.
class Meter
{
public:
    /// That a call may ask for, of its budget.
    static constexpr std::uint64_t kBytesPerInstruction = 512;

    enum class Doom : std::uint8_t
    {
        None,
        Instructions,
        Traffic,      ///< bytes asked for in one call
        Memory,       ///< bytes held at a time
        Text,         ///< one text too long
        Interrupted,  ///< the step is given up: nobody will see how the call ended
    };

    void start(std::int64_t budget)
    {
        budget_ = budget, used_ = 0, traffic_ = 0, doom_ = Doom::None;
        stride_ = std::clamp<std::int64_t>(budget, 1, kFirstStride);
    }
    /// Another stride of instructions is done. False: over budget.
    bool count_stride() { return spend(stride_); }
    /// The next stride: growing, so that a small call sees no hook at all and a large one few.
    int next_stride()
    {
        stride_ = std::clamp<std::int64_t>(budget_ - used_, 1, std::min<std::int64_t>(stride_ * 2, kLongestStride));
        return static_cast<int>(stride_);
    }
    int stride() const { return static_cast<int>(stride_); }
    /// False: over budget.
    bool spend(std::int64_t instructions)
    {
        used_ += std::min(instructions, budget_ + 1);
        if (used_ >= budget_) doom(Doom::Instructions);
        return !doomed();
    }
    /// False: the call moves too much memory.
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
    /// At most the true count; at least half of it, or 64 less.
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
