#include "publish/states.h"

#include <chrono>

namespace plab::publish
{
namespace
{

/// Pose and velocity of the frame B that the author sees; the tables keep those of the centre of mass C.
BodyState state_of(const Bodies& bodies, const Roster::Place& body)
{
    const Pose X_WB = bodies.pose(body.row);
    return {body.handle, X_WB.p, X_WB.q, bodies.velocity_at(body.row, X_WB.p), bodies.angular_velocity[body.row]};
}

}  // namespace

void fill_frame(const simulation::Simulation& s, const Roster& roster, Frame& frame)
{
    using std::chrono::duration_cast, std::chrono::nanoseconds, std::chrono::system_clock;
    frame.run = s.run(), frame.revision = s.revision(), frame.step = s.tick(), frame.time = s.time();
    frame.stamp_ns = duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
    frame.bodies.clear(), frame.shafts.clear();
    const Bodies& bodies = s.world().host().bodies;
    const Shafts& shafts = s.world().host().shafts;
    for (const Roster::Place& body : roster.bodies())
        if (bodies.motion[body.row] != Motion::Static) frame.bodies.push_back(state_of(bodies, body));
    for (const Roster::Place& shaft : roster.shafts())
        frame.shafts.push_back({shaft.handle, shafts.angle[shaft.row], shafts.speed[shaft.row]});
}

}  // namespace plab::publish
