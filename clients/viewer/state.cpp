#include "viewer/state.h"

#include <algorithm>

#include "plab/rotation.h"

namespace plab::view
{
namespace
{

template <class T>
void sort_by_handle(std::vector<T>& rows)
{
    const auto before = [](const T& a, const T& b) { return a.handle < b.handle; };
    if (!std::is_sorted(rows.begin(), rows.end(), before)) std::sort(rows.begin(), rows.end(), before);
}

/// Rows of a, each blended with the row of b that has the same handle, if there is one.
template <class T, class Blend>
std::vector<T> blend_rows(const std::vector<T>& a, const std::vector<T>& b, Blend&& blend)
{
    std::vector<T> out(a);
    auto other = b.begin();
    for (T& row : out)
    {
        while (other != b.end() && other->handle < row.handle) ++other;
        if (other != b.end() && other->handle == row.handle) blend(row, *other);
    }
    return out;
}

}  // namespace

State state_of(const plab_v2_Frame& frame)
{
    State out{frame.run, frame.revision, frame.step, frame.time, {}, {}};
    out.bodies.reserve(frame.bodies._length);
    for (std::uint32_t i = 0; i < frame.bodies._length; ++i)
    {
        const plab_v2_BodyState& b = frame.bodies._buffer[i];
        const auto& [w, x, y, z] = b.orientation;
        out.bodies.push_back({b.handle, {{b.position.x, b.position.y, b.position.z}, {w, x, y, z}}});
    }
    out.shafts.reserve(frame.shafts._length);
    for (std::uint32_t i = 0; i < frame.shafts._length; ++i)
        out.shafts.push_back({frame.shafts._buffer[i].handle, frame.shafts._buffer[i].angle});
    sort_by_handle(out.bodies);
    sort_by_handle(out.shafts);
    return out;
}

Quat slerp(const Quat& a, const Quat& b, double share) { return normalized(a * exp_rotation(share * log_rotation(conjugate(a) * b))); }

State interpolate(const State& a, const State& b, double time)
{
    if (time >= b.time - kSameTime) return b;
    if (time <= a.time + kSameTime) return a;
    const double share = (time - a.time) / (b.time - a.time);
    State out{a.run, a.revision, a.step, time, {}, {}};
    out.bodies = blend_rows(a.bodies, b.bodies,
                            [share](Body& from, const Body& to)
                            {
                                from.pose.p += share * (to.pose.p - from.pose.p);
                                from.pose.q = slerp(from.pose.q, to.pose.q, share);
                            });
    out.shafts = blend_rows(a.shafts, b.shafts, [share](Shaft& from, const Shaft& to) { from.angle += share * (to.angle - from.angle); });
    return out;
}

}  // namespace plab::view
