// A run that continues from a snapshot in a fresh Simulation equals the run that never stopped: state, events, outputs, ledger.
#include "support/ground.h"
#include "twin.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("every type's scene continues from a snapshot as if there had been no interruption")
{
    for (const Subject& subject : subjects())
        for (const int threads : {1, 2})
        {
            Plan plan;
            plan.threads_after = threads;
            const std::string what = follow(compiled(subject.blueprint), plan);
            CHECK_MESSAGE(what.empty(), subject.type, ", ", threads, " threads: ", what);
        }
}

TEST_CASE("so do the example scenes, those of the studies and the golden ones")
{
    REQUIRE(scene_files().size() > 20);
    for (const std::string& file : scene_files())
    {
        const auto scene = compile_file(file);
        REQUIRE_MESSAGE(scene.ok(), file, ": ", reasons(scene));
        const std::string what = follow(*scene, Plan{});
        CHECK_MESSAGE(what.empty(), file, ": ", what);
    }
}

TEST_CASE("so does a heap whose algorithms are chosen anew in each step")
{
    std::string bodies = std::string(kGround) + "<component id='box' type='Shape/Box' half_extents='0.1 0.1 0.1'/>";
    for (int k = 0; k < 24; ++k)
        bodies += "<component id='b" + std::to_string(k) + "' type='State/RigidBody' mass='1' shape='box' position='" +
                  std::to_string(0.15 * (k % 2)) + " " + std::to_string(0.11 * (k % 3)) + " " + std::to_string(0.2 + 0.25 * k) + "'/>";
    const std::string scene =
        bodies + "<component id='weight' type='Field/Gravity' between='*'/><component id='contact' type='CDetection/ODE' between='*'/>";
    Plan plan;
    plan.every = 20;
    plan.follow = 60;
    CHECK(follow(scene_of(scene), plan) == "");
}

namespace
{

/// Two towers, balls and boxes that bounce beside them and on a plate that moves, and a ball that hits the second tower late.
std::string towers(const std::string& resolution)
{
    std::string scene = std::string(kGround) +
                        "<component id='box' type='Shape/Box' half_extents='0.1 0.1 0.1'/><component id='ball' type='Shape/Sphere' "
                        "radius='0.1'/><component id='weight' type='Field/Gravity' between='*'/><component id='contact' "
                        "type='CDetection/ODE' between='*' response.restitution='0.6' " +
                        resolution + "/>";
    const auto body = [](const std::string& id, const std::string& shape, const std::string& place)
    { return "<component id='" + id + "' type='State/RigidBody' mass='1' shape='" + shape + "' position='" + place + "'/>"; };
    for (int k = 0; k < 20; ++k)
        scene += body("t" + std::to_string(k), "box", (k < 10 ? "0 0 " : "1 0 ") + std::to_string(0.1 + 0.2 * (k % 10)));
    for (int k = 0; k < 8; ++k)
        scene +=
            body("b" + std::to_string(k), k % 2 == 0 ? "ball" : "box", std::to_string(0.3 * k) + " 0.8 " + std::to_string(0.4 + 0.1 * k));
    return scene + body("above", "ball", "1.02 0.03 4.2") +
           "<component id='plate' type='State/Kinematic' shape='box' position='0.6 0.8 0' linear_velocity='0.2 0 0'/>";
}

}  // namespace

TEST_CASE("so do bodies that bounce beside towers, which fall asleep, and one that hits them there")
{
    std::size_t asleep = 0;
    Plan plan;
    plan.steps = 120, plan.every = 4, plan.follow = 12;
    plan.meddle = [&](simulation::Simulation& s, int) { asleep = std::max(asleep, s.stepper().contacts().rest().islands.size()); };
    for (const bool as_file : {false, true})
    {
        plan.as_file = as_file;
        CHECK(follow(scene_of(towers(""), "dt='1/120'"), plan) == "");
    }
    CHECK(asleep == 2);
}

TEST_CASE("so does a box that slept and was woken, from a file of a step in which nothing rests")
{
    Plan plan;
    plan.steps = 240, plan.every = 4, plan.follow = 80, plan.as_file = true;
    const char* const scene =
        "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/><component id='weight' "
        "type='Field/Gravity' between='*'/><component id='box' type='State/RigidBody' mass='1' shape='Shape/Box' "
        "shape.half_extents='0.1 0.1 0.1' position='0 0 0.1'/><component id='ball' type='State/RigidBody' mass='1' shape='Shape/Sphere' "
        "shape.radius='0.1' position='0.05 0 2.5'/><component id='contact' type='CDetection/ODE' between='*' "
        "resolution='Resolution/None' response.friction='0.5'/>";
    CHECK(follow(scene_of(scene, "dt='1/60'"), plan) == "");
}

TEST_CASE(
    "so do they where bodies are crowded for no longer than they touch, where few impacts can be located, and with a second detection")
{
    const std::string sensor =
        "/><component id='other' type='CDetection/ODE' between='b0 b1 b2 above' against='ground' response='Response/None'";
    Plan plan;
    plan.steps = 120, plan.every = 2, plan.follow = 4;
    for (const std::string& more :
         {std::string("resolution.dwell='0'"), std::string("resolution.max_work='0.01' resolution.base_work='6'"),
          std::string("resolution.dwell='0' resolution.base_work='100'"), std::string("resolution.dwell='0.05' resolution.max_bodies='2'"),
          sensor, "response='Response/Impulse' " + sensor, sensor + " resolution='Resolution/LocalRoot'"})
    {
        CAPTURE(more);
        CHECK(follow(scene_of(towers(more), "dt='1/120'"), plan) == "");
    }
}

TEST_CASE("so does a box that tumbles over tiles: whether it passes over a seam depends on its other contacts")
{
    std::string scene =
        "<component id='weight' type='Field/Gravity' between='*'/><component id='contact' type='CDetection/ODE' between='*' "
        "resolution='Resolution/Speculative' response='Response/Rows' response.friction='0.3'/>"
        "<component id='tile' type='Shape/Box' half_extents='0.1 0.1 0.05'/>";
    int tiles = 0;
    for (const char* const at : {"1 0.2", "1 0.4", "1.2 0.2"})
        scene += "<component id='t" + std::to_string(tiles++) + "' type='State/Static' shape='tile' position='" + at + " -0.05'/>";
    scene +=
        "<component id='box' type='State/RigidBody' mass='1' inertia='0.001 0.001 0.001' shape='Shape/Box' shape.half_extents='0.04 0.03 "
        "0.02' position='0.7 0.1858909664280705 0.09586279156582901' orientation='0.7076658838305383 1.5517165788844585 "
        "0.25704194568954475 1.3421552268825012' linear_velocity='2.8430943772551576 0.8309056873719805 0' "
        "angular_velocity='0.7982462396472175 -2.386480083288588 1.3150760273115731'/>";
    Plan plan;
    plan.steps = 60, plan.every = 1, plan.follow = 8;
    CHECK(follow(scene_of(scene, "dt='1/120'"), plan) == "");
}
