// A run that continues from a snapshot in a fresh Simulation equals the run that never stopped: state, events, outputs, ledger.
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
