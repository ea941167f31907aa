#include "control/live/frames.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "link/frame_reader.h"

namespace plab::cli
{

Frame frame_of(const plab_v2_Frame& f)
{
    Frame out;
    out.run = f.run, out.revision = f.revision, out.number = f.sequence_number;
    out.step = f.step, out.stamp_ns = f.stamp_ns, out.time = f.time;
    const auto vec = [](const plab_v2_Vector& v) { return Vec3{v.x, v.y, v.z}; };
    for (std::uint32_t i = 0; i < f.bodies._length; ++i)
    {
        const plab_v2_BodyState& b = f.bodies._buffer[i];
        out.motions[b.handle] = {false,
                                 vec(b.position),
                                 vec(b.linear_velocity),
                                 vec(b.angular_velocity),
                                 {b.orientation.w, b.orientation.x, b.orientation.y, b.orientation.z}};
    }
    for (std::uint32_t i = 0; i < f.shafts._length; ++i)
    {
        Motion& m = out.motions[f.shafts._buffer[i].handle];
        m.is_shaft = true, m.angle = f.shafts._buffer[i].angle, m.speed = f.shafts._buffer[i].speed;
    }
    return out;
}

std::optional<Frame> next_frame(const link::Session& session, link::Seconds timeout)
{
    auto reader = link::FrameReader::open(session);
    if (!reader) return {};
    const auto end = link::moment_after(timeout);
    std::optional<Frame> out;
    while (!out && session.wait(*reader, std::max(link::Seconds(0), link::Seconds(end - std::chrono::steady_clock::now()))))
        (void)reader->take([&](const plab_v2_Frame& f) { out = frame_of(f); });
    return out;
}

Json json_of(const Motion& m)
{
    if (m.is_shaft) return {{"angle", m.angle}, {"speed", m.speed}};
    return {{"position", json_of(m.position)},
            {"orientation", json_of(m.orientation)},
            {"linear_velocity", json_of(m.linear_velocity)},
            {"angular_velocity", json_of(m.angular_velocity)}};
}

}  // namespace plab::cli
