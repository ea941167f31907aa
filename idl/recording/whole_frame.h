/// Frames of a recording that names only what moved, made whole again: as the server would have sent them.
///
/// A recorder may leave out what is, bit for bit, as it was named last (plabd --record --moved-only; metadata "plab" says
/// states = "moved"). It names everything again with each run and each revision, and once in a simulated second.
#pragma once

#include <cstdint>
#include <vector>

#include "idl/plab.h"

namespace plab::recording
{

/// A full frame comes at least this often, s of simulated time.
inline constexpr double kFullFrameEvery = 1;

class WholeFrame
{
public:
    /// `frame` with all that was named before in its run and revision, in the order of the first frame that named it.
    /// Valid until the next call.
    const plab_v2_Frame& with(const plab_v2_Frame& frame);
    /// The next frame is not the one that follows the last one.
    void forget() { run_ = 0; }

private:
    std::uint64_t run_ = 0, revision_ = 0;  ///< no run has number 0
    std::vector<plab_v2_BodyState> bodies_;
    std::vector<plab_v2_ShaftState> shafts_;
    plab_v2_Frame out_{};
};

}  // namespace plab::recording
