/// The state of all objects: completed frames (idl/recording/whole_frame.h) with lookup by handle.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "idl/recording/whole_frame.h"

namespace plab::recordings
{

class Merged
{
public:
    /// The next frame; it may contain only what moved.
    void note(const plab_v2_Frame& frame);

    /// Valid until the next frame is noted.
    const plab_v2_Frame& now() const { return *now_; }
    std::span<const plab_v2_BodyState> bodies() const { return {now_->bodies._buffer, now_->bodies._length}; }
    std::span<const plab_v2_ShaftState> shafts() const { return {now_->shafts._buffer, now_->shafts._length}; }
    /// Null: no frame of this run and revision contains it.
    const plab_v2_BodyState* find_body(std::uint32_t handle) const;
    const plab_v2_ShaftState* find_shaft(std::uint32_t handle) const;

private:
    using Places = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // handle, place in the frame; sorted

    recording::WholeFrame whole_;
    const plab_v2_Frame* now_ = nullptr;
    Places bodies_, shafts_;
    std::uint64_t run_ = 0, revision_ = 0;  ///< to which the places belong
};

}  // namespace plab::recordings
