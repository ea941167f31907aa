/// Omits resting objects from frames: a heap at rest costs nothing except its entries in a full frame.
#pragma once

#include <cstdint>
#include <vector>

#include "publish/records.h"

namespace plab::record
{

/// A frame contains the objects whose values differ in any bit from those last written; a full frame comes with each run, each
/// change of the structure, and after each `full_every`. Readers keep the last values of each object.
class MovedFilter
{
public:
    explicit MovedFilter(double full_every) : full_every_(full_every) {}

    /// Valid until the next call.
    const wire::Frame& thin(const wire::Frame& frame);

private:
    double full_every_;  ///< s, simulated
    double full_at_ = 0;
    wire::Frame last_, out_;  ///< last_: as a reader has it
};

}  // namespace plab::record
