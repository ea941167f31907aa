/// Leaves out of frames what stands still: a heap that has come to rest costs nothing but its place in a full frame.
#pragma once

#include <cstdint>
#include <vector>

#include "publish/records.h"

namespace plab::record
{

/// A frame names what is not, bit for bit, as it was named last; a full one comes with each run, each change of the
/// structure, and after each `full_every`. Readers keep what was named last.
class MovedFilter
{
public:
    explicit MovedFilter(double full_every) : full_every_(full_every) {}

    /// Valid until the next call.
    const publish::Frame& thin(const publish::Frame& frame);

private:
    double full_every_;  ///< s, simulated
    double full_at_ = 0;
    publish::Frame last_, out_;  ///< last_: as a reader knows it
};

}  // namespace plab::record
