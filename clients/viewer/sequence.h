/// Frames at equal simulated times, from states at arbitrary times.
#pragma once

#include <functional>

#include "viewer/moment_buffer.h"

namespace plab::view
{

/// Frame k has the time origin + k / per_second. Without `duration` and `until` there is no end.
struct SequencePlan
{
    double per_second = 30;
    std::optional<double> origin = {};    ///< s; none: the first state's time
    std::optional<double> duration = {};  ///< s: round(duration * per_second) frames, at least one
    std::optional<double> until = {};     ///< s: the last frame is not later
};

class Sequence
{
public:
    using Draw = std::function<Result<void>(std::uint64_t index, const Moment& moment)>;

    explicit Sequence(const SequencePlan& plan) : plan_(plan) {}

    /// Draws all frames that are due with this moment, each from the two moments around its time. A new run starts at its own
    /// first time, with the next number.
    Result<void> advance(Moment&& moment, const Draw& draw);

    bool done() const { return total_ && next_ >= *total_; }
    /// Number of frames that there will be; empty: no end.
    std::optional<std::uint64_t> total() const { return total_; }
    std::uint64_t drawn() const { return next_ - missing_; }
    /// Time of the newest state, s.
    double time() const { return before_ ? before_->state.time : 0; }
    std::uint64_t runs() const { return runs_; }

    /// Frames before the first state, which cannot be drawn.
    std::uint64_t missing() const { return missing_; }
    /// The longest interval between two states that a frame was interpolated from, s.
    double widest_gap() const { return widest_gap_; }

private:
    void begin(const State& first);
    double time_of(std::uint64_t index) const { return origin_ + static_cast<double>(index) / plan_.per_second; }

    SequencePlan plan_;
    double origin_ = 0;
    std::optional<Moment> before_;
    std::optional<std::uint64_t> total_;
    std::uint64_t next_ = 0, missing_ = 0, runs_ = 0;
    double widest_gap_ = 0;
};

}  // namespace plab::view
