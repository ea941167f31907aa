// All that a step depends on is in the memento: world, host tables and contacts. Nothing hides in a plugin.
#include "subjects.h"
#include "support/bare_run.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr int kSteps = 50;

}  // namespace

TEST_CASE("a memento brings back every bit, and the same steps follow")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        BareRun run(compiled(subject.blueprint));
        for (int round = 0; round < 3; ++round)
        {
            run.advance(kSteps);
            const BareRun::Memento memento = run.save();
            const std::vector<std::uint64_t> first = run.advance(kSteps);
            run.restore(memento);
            CHECK(first_difference(first, run.advance(kSteps)) == -1);
        }
    }
}

TEST_CASE("a memento brings a world that never ran to the same steps")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        const model::SceneSpec scene = compiled(subject.blueprint);
        BareRun run(scene), fresh(scene);
        run.advance(kSteps);
        fresh.restore(run.save());
        CHECK(first_difference(run.advance(2 * kSteps), fresh.advance(2 * kSteps)) == -1);
    }
}

TEST_CASE("a step from a memento is not the step from the start")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        BareRun run(compiled(subject.blueprint));
        const BareRun::Memento start = run.save();
        const std::vector<std::uint64_t> first = run.advance(kSteps), later = run.advance(kSteps);
        CHECK_MESSAGE(first.front() != first.back(), "nothing moves in the scene, so nothing is tested");
        CHECK(first != later);
        run.restore(start);
        CHECK(run.advance(kSteps) == first);
    }
}
