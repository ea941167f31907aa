// All that a step depends on is in the memento: world, host tables and contacts. Nothing hides in a plugin.
#include "subjects.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr int kSteps = 50;

/// A world with its stepper, without Simulation around them: the memento is taken and put back from outside.
class Run
{
public:
    explicit Run(const model::SceneSpec& scene) : dt_(scene.settings.dt), world_(library())
    {
        world_.describe(scene.settings, scene.file);
        const auto added = world_.add(scene);
        REQUIRE_MESSAGE(added.ok(), reasons(added));
        stepper_ = std::make_unique<simulation::Stepper>(world_, 1);
        const auto built = stepper_->rebuild();
        REQUIRE_MESSAGE(built.ok(), reasons(built));
    }
    struct Memento
    {
        Tick tick;
        world::Backup world;
        simulation::ContactCache contacts;
    };
    Memento save() const { return {tick_, world_.backup(), stepper_->contacts()}; }
    void restore(const Memento& m)
    {
        tick_ = m.tick;
        world_.restore(m.world);
        stepper_->contacts() = m.contacts;
    }
    /// Hash after each step.
    std::vector<std::uint64_t> advance(int steps)
    {
        std::vector<std::uint64_t> out;
        for (int i = 0; i < steps; ++i, ++tick_)
        {
            const double start = dt_.at(tick_);
            stepper_->step(tick_, start, dt_.at(tick_ + 1) - start);
            out.push_back(stepper_->state_hash());
        }
        return out;
    }

private:
    model::StepLength dt_;
    Tick tick_ = 0;
    world::World world_;
    std::unique_ptr<simulation::Stepper> stepper_;
};

}  // namespace

TEST_CASE("a memento brings back every bit, and the same steps follow")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        Run run(compiled(subject.blueprint));
        for (int round = 0; round < 3; ++round)
        {
            run.advance(kSteps);
            const Run::Memento memento = run.save();
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
        Run run(scene), fresh(scene);
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
        Run run(compiled(subject.blueprint));
        const Run::Memento start = run.save();
        const std::vector<std::uint64_t> first = run.advance(kSteps), later = run.advance(kSteps);
        CHECK_MESSAGE(first.front() != first.back(), "nothing moves in the scene, so nothing is tested");
        CHECK(first != later);
        run.restore(start);
        CHECK(run.advance(kSteps) == first);
    }
}
