/// Completes the frames of a recording that contain only what moved, so that they are as the server would have sent them.
/// A recorder may omit objects whose values are bit for bit those last written (plabd --record --moved-only; metadata "plab"
/// has states = "moved"). It writes all objects with each run and each revision, and once per simulated second.
#pragma once

#include <cstdint>
#include <vector>

#include "idl/plab.h"

namespace plab::recording
{

/// Largest interval between full frames, s of simulated time.
inline constexpr double kFullFrameEvery = 1;

class WholeFrame
{
public:
    /// `frame` with all objects that occurred before in its run and revision, in the order of the first frame that contains
    /// them. Valid until the next call.
    const plab_v2_Frame& with(const plab_v2_Frame& frame);
    /// The next frame does not directly follow the last one.
    void forget() { run_ = 0; }

private:
    std::uint64_t run_ = 0, revision_ = 0;  ///< no run has number 0
    std::vector<plab_v2_BodyState> bodies_;
    std::vector<plab_v2_ShaftState> shafts_;
    plab_v2_Frame out_{};
};

}  // namespace plab::recording
