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
