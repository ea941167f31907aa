/// The poses of all objects of one run at key frames.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "control/recording/analysis/stream.h"
#include "plab/vector.h"

namespace plab::analysis
{

/// One object: at each key frame 7 floats, position x y z (m) and rotation x y z w.
struct Track
{
    std::vector<float> poses;
    std::vector<float> there;  ///< 1, or 0 where the object does not exist
    double angle = 0;          ///< of a shaft at the last key frame, rad
    bool moves() const;
    bool is_always_there() const;
    std::size_t frames() const { return there.size(); }
};

class Tracks
{
public:
    static constexpr std::size_t kMostBytes = std::size_t{1} << 30;

    /// X_WA of shafts, by handle: z of A along the axle.
    explicit Tracks(std::map<std::uint32_t, Pose> axles) : axles_(std::move(axles)) {}
    /// A key frame. False: there is no room for it.
    bool add(const Merged& frame, float time);

    const std::vector<float>& times() const { return times_; }
    const std::map<std::uint32_t, Track>& by_handle() const { return tracks_; }
    /// Shafts that turned by more than half a turn between key frames: they look slower.
    std::size_t too_fast() const { return too_fast_; }

private:
    void put(std::uint32_t handle, const Vec3& p, const Quat& q);

    std::map<std::uint32_t, Pose> axles_;
    std::vector<float> times_;
    std::map<std::uint32_t, Track> tracks_;
    std::size_t floats_ = 0, too_fast_ = 0;
};

}  // namespace plab::analysis
