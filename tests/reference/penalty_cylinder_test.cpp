// Cylinders that stand on springs: the point of the rim that is lowest passes from side to side of a level end.
#include <algorithm>
#include <cmath>

#include "plab/rotation.h"
#include "support/gravity.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

const std::string kFloors[] = {"Shape/Plane'/>", "Shape/Box' half_extents='5 5 0.5' position='0 0 -0.5'/>",
                               "Shape/Cylinder' radius='5' height='1' position='0 0 -0.5'/>",
                               "Shape/HeightField' columns='21' rows='21' spacing='0.5'/>"};

/// A puck of 3 kg, r = h = 0.1 m, on a floor.
std::string puck(const std::string& floor, const Vec3& position, const std::string& motion, const std::string& response)
{
    return "<component id='puck' type='Shape/Cylinder' radius='0.1' height='0.1'/><component id='p' type='State/RigidBody' shape='puck' "
           "mass='3' position='" +
           text(position) + "' " + motion + "/>" + kGravity + "<component id='floor' type='" + floor +
           "<component id='ground' type='State/Static' shape='floor'/>" +
           "<component id='contact' type='CDetection/ODE' between='p' against='ground' response='Response/" + response + "/>";
}

/// J: kinetic and potential energy of the puck.
double energy_of(const Scene& s)
{
    const Vec3 v = s.vec("p", "linear_velocity"), w = rotate_back(s.quat("p", "orientation"), s.vec("p", "angular_velocity"));
    const double across = 3 * (3 * 0.01 + 0.01) / 12, along = 3 * 0.01 / 2;
    return 3 * (0.5 * length_squared(v) + kG * s.vec("p", "position").z) + 0.5 * (across * (w.x * w.x + w.y * w.y) + along * w.z * w.z);
}

}  // namespace

TEST_CASE("a cylinder that slides upright on springs is slowed by mu g, on any floor")
{
    for (const std::string& floor : kFloors)
    {
        CAPTURE(floor);
        Scene s(puck(floor, {0, 0, 0.05}, "linear_velocity='2 0 0'", "Penalty' response.friction='0.3'"));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(0.2);
        // It settles within a few ms; of the friction before that the puck's weight is the mean.
        CHECK(std::fabs(s.vec("p", "linear_velocity").x - (2 - 0.3 * kG * s.simulation().time())) < 1e-6);
        CHECK(std::fabs(s.vec("p", "linear_velocity").y) < 1e-6);
        CHECK(length(s.vec("p", "angular_velocity")) < 1e-6);
        CHECK(s.vec("p", "position").z < 0.05);
    }
}

TEST_CASE("a cylinder that spins as it slides on springs takes the same course on any floor")
{
    for (const std::string response : {"Penalty", "HuntCrossley"})
    {
        Vec3 first;
        for (const std::string& floor : kFloors)
        {
            CAPTURE(floor);
            Scene s(puck(floor, {0, 0, 0.05}, "linear_velocity='1 0 0' angular_velocity='0 0 10'", response + "' response.friction='0.3'"));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(0.05);
            const Vec3 v = s.vec("p", "linear_velocity");
            if (&floor == &kFloors[0]) first = v;
            CHECK(length(v - first) < 1e-4);
            // Coulomb friction takes less speed than mu g t from what spins as well, and pushes to the side of the spin.
            CHECK(v.x > 1 - 0.3 * kG * s.simulation().time());
            CHECK(v.x < 1 - 0.1 * kG * s.simulation().time());
        }
    }
}

TEST_CASE("springs without damping keep the energy of a cylinder that lands nearly level, or level, at any stiffness")
{
    double worst = 0;
    for (const double stiffness : {1e6, 3e6, 4e6, 7e6})
        for (const double tilt : {0.0, 1e-13, 1e-5, 3e-4, 8e-4, 2e-3, 0.3})
            for (const double azimuth : {0.3, 2.0})
            {
                CAPTURE(stiffness);
                CAPTURE(tilt);
                const double sine = std::sin(tilt / 2);
                const Quat q{std::cos(tilt / 2), sine * std::cos(azimuth), sine * std::sin(azimuth), 0};
                Scene s(puck(kFloors[0], {0, 0, 0.12}, "angular_velocity='0 0 5' orientation='" + text(q) + "'",
                             "Penalty' response.restitution='1' response.stiffness='" + text(stiffness) + "'"));
                REQUIRE_MESSAGE(s.loaded(), s.error());
                const double before = energy_of(s);
                for (int i = 0; i < 240; ++i)
                {
                    s.step();
                    worst = std::max(worst, std::fabs(energy_of(s) + s.real("contact.response", "stored") - before) / before);
                }
            }
    MESSAGE("largest relative error of the energy within 1 s: ", worst);
    CHECK(worst < 1e-6);
}
