/// Interactions by algorithm: cost and error of each while it was active.
#pragma once

#include "control/recordings/log.h"

namespace plab::recordings
{

struct Segment
{
    std::string component;
    std::string algorithm;  ///< that was requested
    std::string resolved;   ///< the algorithm that did the work, as last reported
    std::uint64_t run = 0;
    double begin = 0, end = 0;  ///< s, on the recording's time line, of the first and the last sample
    std::uint64_t samples = 0;
    double mean_cost = 0;  ///< ns per step
    double largest_error = 0;
    std::string error_unit;  ///< unit of the error; errors measured in another unit before are left out
    double work = 0;         ///< J, done in this time
};

/// By component, then time.
std::vector<Segment> segments_of(const Log& log);

}  // namespace plab::recordings
