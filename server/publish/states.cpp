#include "publish/states.h"

#include <chrono>

namespace plab::publish
{

BodyState state_of(const Bodies& bodies, std::uint32_t row, std::uint32_t handle)
{
    const Pose X_WB = bodies.pose(row);
    return {handle, X_WB.p, X_WB.q, bodies.velocity_at(row, X_WB.p), bodies.angular_velocity[row]};
}

void fill_frame(const simulation::Simulation& s, const Roster& roster, Frame& frame)
{
    using std::chrono::duration_cast, std::chrono::nanoseconds, std::chrono::system_clock;
    frame.run = s.run(), frame.revision = s.revision(), frame.step = s.tick(), frame.time = s.time();
    frame.stamp_ns = duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
    frame.bodies.clear(), frame.shafts.clear();
    const Bodies& bodies = s.world().host().bodies;
    const Shafts& shafts = s.world().host().shafts;
    for (const Roster::Place& body : roster.bodies())
        if (bodies.motion[body.row] != Motion::Static) frame.bodies.push_back(state_of(bodies, body.row, body.handle));
    for (const Roster::Place& shaft : roster.shafts())
        frame.shafts.push_back({shaft.handle, shafts.angle[shaft.row], shafts.speed[shaft.row]});
}

}  // namespace plab::publish
