#include "publish/states.h"

#include <chrono>

namespace plab::publish
{

wire::BodyState state_of(const Bodies& bodies, std::uint32_t row, std::uint32_t handle)
{
    // The frame B of most bodies is at the centre of mass.
    if (bodies.center_B[row] == Vec3{})
        return {handle, bodies.position[row], bodies.orientation[row], bodies.velocity[row], bodies.angular_velocity[row]};
    const Pose X_WB = bodies.pose(row);
    return {handle, X_WB.p, X_WB.q, bodies.velocity_at(row, X_WB.p), bodies.angular_velocity[row]};
}

void fill_frame(const simulation::Simulation& s, const Roster& roster, wire::Frame& frame)
{
    using std::chrono::duration_cast, std::chrono::nanoseconds, std::chrono::system_clock;
    frame.run = s.run(), frame.revision = s.revision(), frame.step = s.tick(), frame.time = s.time();
    frame.stamp_ns = duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
    frame.shafts.clear();
    const Bodies& bodies = s.world().host().bodies;
    const Shafts& shafts = s.world().host().shafts;
    // Overwrites what the frame held before, so that existing entries are not rebuilt.
    frame.bodies.resize(roster.bodies().size());
    std::size_t count = 0;
    for (const Roster::ObjectRow& body : roster.bodies())
        if (bodies.motion[body.row] != Motion::Static) frame.bodies[count++] = state_of(bodies, body.row, body.handle);
    frame.bodies.resize(count);
    for (const Roster::ObjectRow& shaft : roster.shafts())
        frame.shafts.push_back({shaft.handle, shafts.angle[shaft.row], shafts.speed[shaft.row]});
}

}  // namespace plab::publish
