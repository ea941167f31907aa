#include "daemon/pacer.h"

#include <algorithm>

namespace plab::daemon
{
namespace
{

/// s of real time by which a step may be late before the anchor moves: a short delay is caught up, overload is not.
constexpr double kPatience = 0.1;
constexpr double kLongest = 1e8;  // s

}  // namespace

Pacer::Clock::time_point Pacer::due(double next, double rate, std::uint64_t run, Clock::time_point now)
{
    if (rate <= 0)
    {
        anchored_ = false;
        return now;
    }
    if (!anchored_ || rate != rate_ || run != run_)
    {
        anchored_ = true, anchor_ = now, anchor_time_ = next, rate_ = rate, run_ = run;
        return now;
    }
    // A longer duration would overflow after some years; a wait is never that long.
    const std::chrono::duration<double> ahead(std::clamp((next - anchor_time_) / rate, -kLongest, kLongest));
    const Clock::time_point due = anchor_ + std::chrono::duration_cast<Clock::duration>(ahead);
    const double late = std::chrono::duration<double>(now - due).count();
    if (late <= kPatience) return due;
    slipped_ += late * rate;
    last_slip_ = now;
    anchor_ = now, anchor_time_ = next;
    return now;
}

void RateMeter::sample(double time, std::uint64_t run, Clock::time_point now)
{
    if (!begun_ || run != run_)
    {
        begun_ = true, begin_ = now, begin_time_ = time, run_ = run;
        return;
    }
    const double real = std::chrono::duration<double>(now - begin_).count();
    if (real < 1.0) return;
    factor_ = (time - begin_time_) / real;
    begin_ = now, begin_time_ = time;
}

}  // namespace plab::daemon
