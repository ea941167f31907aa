#include "publish/states.h"

#include <chrono>

#include "publish/state_stream.h"

namespace plab::publish
{
namespace
{

/// From so many bodies on a frame is too large for the processor's caches to be of use to whoever reads it.
constexpr std::size_t kLargeFrame = 1000;

/// Passes pose and velocity of the frame B that the author defined to put(p_WB, q_WB, v_WB, w_WB).
template <class Put>
auto with_motion(const Bodies& bodies, std::uint32_t row, Put put)
{
    // The frame B of most bodies is at the centre of mass.
    if (bodies.center_B[row] == Vec3{})
        return put(bodies.position[row], bodies.orientation[row], bodies.velocity[row], bodies.angular_velocity[row]);
    const Pose X_WB = bodies.pose(row);
    return put(X_WB.p, X_WB.q, bodies.velocity_at(row, X_WB.p), bodies.angular_velocity[row]);
}

/// Overwrites what the list held before, so that existing entries are not rebuilt.
void fill_bodies(const Bodies& bodies, const Roster& roster, std::vector<wire::BodyState>& out)
{
    out.resize(roster.bodies().size());
    std::size_t count = 0;
    const auto each = [&](auto put)
    {
        for (const Roster::ObjectRow& body : roster.bodies())
            if (bodies.motion[body.row] != Motion::Static)
                with_motion(bodies, body.row,
                            [&, handle = body.handle](const Vec3& p, const Quat& q, const Vec3& v, const Vec3& w)
                            { put(out[count++], handle, p, q, v, w); });
    };
    if (StateStream stream; roster.bodies().size() >= kLargeFrame)
        each([&](wire::BodyState& to, const auto&... values) { stream.put(to, values...); });
    else
        each([](wire::BodyState& to, std::uint32_t handle, const auto&... motion) { to = {handle, motion...}; });
    out.resize(count);
}

}  // namespace

wire::BodyState state_of(const Bodies& bodies, std::uint32_t row, std::uint32_t handle)
{
    return with_motion(bodies, row, [&](const auto&... motion) { return wire::BodyState{handle, motion...}; });
}

void fill_frame(const simulation::Simulation& s, const Roster& roster, wire::Frame& frame)
{
    using std::chrono::duration_cast, std::chrono::nanoseconds, std::chrono::system_clock;
    frame.run = s.run(), frame.revision = s.revision(), frame.step = s.tick(), frame.time = s.time();
    frame.stamp_ns = duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
    frame.shafts.clear();
    const Shafts& shafts = s.world().host().shafts;
    fill_bodies(s.world().host().bodies, roster, frame.bodies);
    for (const Roster::ObjectRow& shaft : roster.shafts())
        frame.shafts.push_back({shaft.handle, shafts.angle[shaft.row], shafts.speed[shaft.row]});
}

}  // namespace plab::publish
