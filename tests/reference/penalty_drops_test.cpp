// Bodies of every shape that spin and tumble onto springs with friction: nothing comes from nothing, and each step ends.
#include <algorithm>
#include <cmath>

#include "plab/random.h"
#include "support/gravity.h"
#include "support/ground.h"
#include "support/mechanical_energy.h"
#include "support/random_poses.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

const std::string kTumblers[] = {
    "Sphere' radius='0.1'",
    "Box' half_extents='0.1 0.07 0.05'",
    "Capsule' radius='0.05' length='0.2'",
    "Cylinder' radius='0.1' height='0.1'",
    "Cylinder' radius='0.1' height='0.02'",
    "Cylinder' radius='0.03' height='0.3'",
    "ConvexHull' points='0.1 0 -0.06 -0.05 0.08 -0.06 -0.05 -0.08 -0.06 0.1 0 0.06 -0.05 0.08 0.06 -0.05 -0.08 0.06'"};

const std::string kSlab =
    "<component id='slab' type='Shape/Box' half_extents='5 5 0.5'/><component id='ground' type='State/Static' shape='slab' position='0 0 "
    "-0.5'/>";

/// A body of 1 kg, 0.4 m above `floor`, with up to 60 rad/s.
std::string tumbler(std::uint64_t& seed, const std::string& shape, const std::string& floor, const std::string& response)
{
    const Quat q = random_rotation(seed);
    const Vec3 v = random_vector(seed, 1.5), w = random_vector(seed, 60);
    return floor + "<component id='s' type='Shape/" + shape +
           "/><component id='p' type='State/RigidBody' shape='s' mass='1' position='0 0 0.4' " + "orientation='" + text(q) +
           "' linear_velocity='" + text(v) + "' angular_velocity='" + text(w) + "'/>" + kGravity +
           "<component id='contact' type='CDetection/ODE' between='p ground' response='Response/" + response + "/>";
}

}  // namespace

TEST_CASE("what spins and tumbles onto springs with friction gains no energy, at any moment, with either law")
{
    std::uint64_t seed = 11;
    double highest = 0;
    int count = 0;
    for (const std::string response : {"Penalty' response.stiffness='1e4'", "Penalty' response.stiffness='1e6'",
                                       "HuntCrossley' response.stiffness='1e6'", "HuntCrossley' response.stiffness='1e7'"})
        for (const std::string restitution : {"0.5", "1"})
            for (const std::string friction : {"0.3", "1"})
                for (const std::string& shape : kTumblers)
                {
                    const std::string floor = ++count % 2 == 0 ? std::string(kGround) : kSlab;
                    const std::string more = response + " response.friction='" + friction + "' response.restitution='" + restitution + "'";
                    CAPTURE(shape);
                    CAPTURE(more);
                    Scene s(tumbler(seed, shape, floor, more), "dt='1/240'");
                    REQUIRE_MESSAGE(s.loaded(), s.error());
                    s.warnings_expected = true;
                    const double start = mechanical_energy(s);
                    double most = 0;
                    while (s.simulation().time() < 1)
                    {
                        s.step();
                        most = std::max(most, mechanical_energy(s) + s.real("contact.response", "stored"));
                    }
                    CHECK(most <= start * (1 + 1e-5));
                    highest = std::max(highest, most / start);
                }
    MESSAGE("highest energy of ", count, " drops, relative to the start: 1 + ", highest - 1);
}

TEST_CASE("a disc that tumbles onto springs of a mesh takes explicit steps, however its contacts pass over edges")
{
    std::uint64_t seed = 5;
    const std::string ground =
        "<component id='field' type='Shape/HeightField' columns='41' rows='41' spacing='0.25' wave_height='0.05' wave_length='1.5'/>"
        "<component id='ground' type='State/Static' shape='field'/>";
    Scene s(tumbler(seed, kTumblers[4], ground, "Penalty' response.stiffness='1e4' response.friction='0.3'"), "dt='1/60'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;
    s.run(1.5);
    // An implicit method cannot step over a jump of the slope, and takes thousands of parts of each piece: where such a disc came to rest
    // between facets, a step took minutes.
    const auto methods = std::get<std::int64_t>(s.get("solver", "methods"));
    CHECK((methods & (8 + 16 + 32)) == 0);
    CHECK(length(s.vec("p", "linear_velocity")) < 1);
}

TEST_CASE("bodies that joints hold land on springs, and on one another, with explicit steps")
{
    const auto body = [](const char* id, const char* shape, const char* motion)
    { return std::string("<component id='") + id + "' type='State/RigidBody' shape='" + shape + "' " + motion + "/>"; };
    const std::string links =
        "<component id='brick' type='Shape/Box' half_extents='0.12 0.08 0.05'/>"
        "<component id='can' type='Shape/Cylinder' radius='0.08' height='0.12'/><component id='ball' type='Shape/Sphere' radius='0.1'/>" +
        body("a", "brick", "mass='1' position='0.14 0.24 0.64' linear_velocity='0.37 -0.06 0' angular_velocity='-4 -0.7 1.1'") +
        body("b", "brick", "mass='2' position='-0.01 0.22 0.86' linear_velocity='-0.5 0.6 0' angular_velocity='0.5 -4.9 2.2'") +
        body("c", "can", "mass='1.6' position='0.17 0.08 1.08' linear_velocity='0.2 0.7 0' angular_velocity='-1.7 2.3 2'") +
        body("d", "ball", "mass='0.8' position='0.04 -0.16 1.3' linear_velocity='0.9 0.6 0' angular_velocity='-0.5 -4.2 -1.8'") +
        "<component id='ab' type='Constraint/Ball' a='a' b='b' anchor='0 0 0.75'/>"
        "<component id='cd' type='Constraint/Ball' a='c' b='d' anchor='0 0 1.19'/>";
    Scene s(std::string(kGravity) + kGround + links +
                "<component id='contact' type='CDetection/ODE' between='*' response='Response/Penalty' response.friction='0.5' "
                "response.restitution='0.3'/>",
            "dt='1/120'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    // Where a contact slips and sticks, an implicit method takes ever shorter steps: this was not done in 20 s.
    std::uint64_t most = 0;
    while (s.simulation().time() < 0.7) s.step(), most = std::max<std::uint64_t>(most, s.simulation().stepper().report().evaluations);
    CHECK(most < 100'000);
    CHECK((std::get<std::int64_t>(s.get("solver", "methods")) & (8 + 16 + 32)) == 0);
    MESSAGE("evaluations in a step: at most ", most);
}
