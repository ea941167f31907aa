// A ball meets a face that turns: a paddle, a flipper, a door. The normal of the contact passes through the ball's centre, so the ball's
// speed along it changes by (1 + e) times the closing speed, which includes the speed of the face at the contact point.
#include "impacts.h"

using namespace plab;
using namespace plab::test;

namespace
{
constexpr double kRadius = 0.05, kReach = 1, kTurning = 0.3, kClosing = 0.2;
}

TEST_CASE("a ball that meets a turning face takes up the speed of the face where it is hit")
{
    for (const char* response :
         {"Response/Impulse", "Response/Rows' response.manager='Manager/Direct",
          "Response/Rows' response.manager='Manager/SequentialImpulse", "Response/Rows' response.manager='Manager/SoftStep"})
        for (const char* resolution : {"LocalRoot", "LocalBisection", "ConservativeAdvancement", "Speculative", "None"})
            for (const double restitution : {0.0, 1.0})
            {
                if (std::string(response) == "Response/Impulse" && std::string(resolution) == "Speculative") continue;  // is refused
                CAPTURE(std::string(response));
                CAPTURE(std::string(resolution));
                CAPTURE(restitution);
                // The face moves down at 0.3 m/s where the ball comes down on it at 0.5 m/s; it is met after 1 mm, when the face has turned
                // by 1.5 mrad.
                Scene s("<component id='paddle' type='State/Kinematic' angular_velocity='0 " + text(kTurning) +
                            " 0' shape='Shape/Box' shape.position='0 0 -0.1' shape.half_extents='2 1 0.1'/>"
                            "<component id='ball' type='State/RigidBody' mass='1' position='" +
                            text(Vec3{kReach, 0, kRadius + 1e-3}) + "' linear_velocity='" +
                            text(Vec3{0, 0, -kTurning * kReach - kClosing}) + "' shape='Shape/Sphere' shape.radius='" + text(kRadius) +
                            "'/><component id='contact' type='CDetection/ODE' between='ball paddle' resolution='Resolution/" + resolution +
                            "' response='" + response + "' response.friction='0' response.restitution='" + text(restitution) + "'/>",
                        "dt='1/1000'");
                REQUIRE_MESSAGE(s.loaded(), s.error());
                s.run(0.02);
                const double want = -kTurning * kReach + restitution * kClosing;
                CHECK(std::fabs(s.vec("ball", "linear_velocity").z - want) < 5e-3);
            }
}
