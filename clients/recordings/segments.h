/// Interactions by the algorithm that they had: what each cost, and how wrong it was, while it was there.
#pragma once

#include "recordings/log.h"

namespace plab::recordings
{

struct Segment
{
    std::string component;
    std::string algorithm;  ///< that was requested
    std::string resolved;   ///< what did the work, as it last said
    std::uint64_t run = 0;
    double begin = 0, end = 0;  ///< s, on the recording's time line, of the first and the last sample
    std::uint64_t samples = 0;
    double mean_cost = 0;  ///< ns per step
    double largest_error = 0;
    std::string error_unit;  ///< of it; errors that were measured in another unit before are left out
    double work = 0;         ///< J, done in this time
};

/// By component, then time.
std::vector<Segment> segments_of(const Log& log);

}  // namespace plab::recordings
