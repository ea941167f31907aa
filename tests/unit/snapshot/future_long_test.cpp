// Snapshots at every 100th step of every scene of this project, written to bytes and read back, and continued with one and two
// threads.
#include "boxes.h"

using namespace plab;
using namespace plab::test;

namespace
{

void check(const model::SceneSpec& scene, const std::string& name)
{
    for (const int threads : {1, 2})
    {
        Plan plan;
        plan.steps = 1200, plan.threads = plan.threads_after = threads, plan.as_file = true;
        const std::string what = follow(scene, plan);
        CHECK_MESSAGE(what.empty(), name, ", ", threads, " threads: ", what);
    }
}

}  // namespace

TEST_CASE("every type's scene, at every 100th step")
{
    for (const Subject& subject : subjects()) check(compiled(subject.blueprint), subject.type);
}

TEST_CASE("every example scene, those of the studies and of the golden tests, at every 100th step")
{
    for (const std::string& file : scene_files())
    {
        const auto scene = compile_file(file);
        REQUIRE_MESSAGE(scene.ok(), file, ": ", reasons(scene));
        check(*scene, file);
    }
}

TEST_CASE("contacts that change from one response to another and back, at every 10th step")
{
    for (const char* response : {"Penalty", "HuntCrossley", "Rows", "None"})
        for (const bool as_file : {false, true})
        {
            Plan plan;
            plan.every = 10, plan.follow = 100, plan.as_file = as_file;
            const std::string what = follow_changes(kBoxes,
                                                    {{35, {swap_of("contact.response", std::string("Response/") + response)}},
                                                     {75, {swap_of("contact.response", "Response/Impulse")}}},
                                                    plan);
            CHECK_MESSAGE(what.empty(), std::string(response), ": ", what);
        }
}
