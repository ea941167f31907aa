/// Quantities of a recording over time, reduced to what a diagram can show.
#pragma once

#include "control/recording/analysis/contents.h"
#include "control/recording/analysis/signal.h"
#include "figures/chart.h"

namespace plab::analysis
{

/// A series of any length in bounded memory: for each slot of time it keeps the first, the smallest, the largest and the last
/// value, so that no peak is lost.
class Thinned
{
public:
    static constexpr std::size_t kSlots = 1200;

    /// Times from `begin` to `end`, s.
    Thinned(double begin, double end) : begin_(begin), width_(std::max(end - begin, 1e-9) / static_cast<double>(kSlots)) {}

    /// Times ascend.
    void add(double time, double value);
    /// The curve is interrupted here.
    void interrupt();
    std::vector<std::pair<double, double>> take();
    bool empty() const { return count_ == 0; }
    double largest() const { return largest_; }  ///< absolute value

private:
    struct Slot
    {
        std::size_t number = 0;
        std::uint64_t count = 0;
        std::pair<double, double> first, least, greatest, last;  ///< time, value
    };
    void flush();

    double begin_, width_;
    Slot slot_;
    std::uint64_t count_ = 0;
    double largest_ = 0;
    std::vector<std::pair<double, double>> points_;
};

/// Start and end of a span of a recording, s of its own time line.
struct Extent
{
    double begin = 0, end = 0;
};
Extent extent_of(const Log& log, const Span& span);

/// The quantities, over the recording's own time. One that never has a value has no points.
std::vector<figures::Curve> curves_of(const Log& log, const std::vector<Signal>& quantities, const Span& span);

/// Swaps, the beginnings of runs, and events of at least a warning (or all of them) as marks.
std::vector<figures::Moment> moments_of(const Log& log, const Span& span, bool all_events);

}  // namespace plab::analysis
