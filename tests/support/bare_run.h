/// A world with its stepper but without Simulation: tests save and restore the memento from outside.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "support/scene.h"

namespace plab::test
{

class BareRun
{
public:
    /// Everything that the next steps depend on.
    struct Memento
    {
        Tick tick;
        world::Backup world;
        simulation::ContactCache contacts;
    };

    /// The test fails if the world or the stepper refuses the scene.
    explicit BareRun(const model::SceneSpec& scene, int threads = 1) : dt_(scene.settings.dt), world_(library())
    {
        world_.describe(scene.settings, scene.file);
        const auto added = world_.add(scene);
        REQUIRE_MESSAGE(added.ok(), reasons(added));
        stepper_ = std::make_unique<simulation::Stepper>(world_, threads);
        const auto built = stepper_->rebuild();
        REQUIRE_MESSAGE(built.ok(), reasons(built));
    }

    Memento save() const { return {tick_, world_.backup(), stepper_->contacts()}; }
    void restore(const Memento& m)
    {
        tick_ = m.tick;
        world_.restore(m.world);
        stepper_->contacts() = m.contacts;
    }
    /// The state hash after a step.
    std::uint64_t step()
    {
        const double start = dt_.at(tick_);
        stepper_->step(tick_, start, dt_.at(tick_ + 1) - start);
        ++tick_;
        return stepper_->state_hash();
    }
    /// The hash after each of `steps` steps.
    std::vector<std::uint64_t> advance(int steps)
    {
        std::vector<std::uint64_t> out;
        for (int i = 0; i < steps; ++i) out.push_back(step());
        return out;
    }
    Tick tick() const { return tick_; }
    const simulation::ContactCache& contacts() const { return stepper_->contacts(); }

private:
    model::StepLength dt_;
    Tick tick_ = 0;
    world::World world_;
    std::unique_ptr<simulation::Stepper> stepper_;
};

}  // namespace plab::test
