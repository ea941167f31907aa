#include "control/recording/analysis/gltf_tracks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plab::analysis
{

bool Track::moves() const
{
    for (std::size_t i = 7; i < poses.size(); ++i)
        if (poses[i] != poses[i % 7]) return true;
    return false;
}

bool Track::is_always_there() const
{
    return std::ranges::all_of(there, [](float x) { return x == 1; });
}

void Tracks::put(std::uint32_t handle, const Vec3& p, const Quat& q)
{
    Track& track = tracks_[handle];
    // Of two quaternions for a rotation the one on the side of the last: a viewer takes the shorter way between them.
    const float* const last = track.poses.empty() ? nullptr : &track.poses[track.poses.size() - 7];
    const bool flip = last != nullptr && q.x * last[3] + q.y * last[4] + q.z * last[5] + q.w * last[6] < 0;
    const double length = norm(q), s = (flip ? -1 : 1) / (length > 0 ? length : 1);
    const double values[7] = {p.x, p.y, p.z, s * q.x, s * q.y, s * q.z, s * q.w};
    const std::size_t frame = times_.size() - 1;
    // Where it was not there, it keeps the nearest known pose.
    for (std::size_t k = track.frames(); k <= frame; ++k)
        for (std::size_t i = 0; i < 7; ++i)
            track.poses.push_back(k < frame && last != nullptr ? track.poses[track.poses.size() - 7] : static_cast<float>(values[i]));
    track.there.resize(frame, 0), track.there.push_back(1);
}

bool Tracks::add(const Merged& frame, float time)
{
    floats_ += 1 + 8 * (frame.bodies().size() + frame.shafts().size());
    if (floats_ * sizeof(float) > kMostBytes) return false;
    times_.push_back(time);
    for (const plab_v2_BodyState& b : frame.bodies())
        put(b.handle, {b.position.x, b.position.y, b.position.z}, {b.orientation.w, b.orientation.x, b.orientation.y, b.orientation.z});
    for (const plab_v2_ShaftState& s : frame.shafts())
    {
        const auto axle = axles_.find(s.handle);
        if (axle == axles_.end()) continue;
        const Quat turn{std::cos(s.angle / 2), 0, 0, std::sin(s.angle / 2)};
        const bool known = tracks_.contains(s.handle);
        put(s.handle, axle->second.p, axle->second.q * turn);
        Track& track = tracks_[s.handle];
        if (known && std::fabs(s.angle - track.angle) > std::numbers::pi) ++too_fast_;
        track.angle = s.angle;
    }
    return true;
}

}  // namespace plab::analysis
