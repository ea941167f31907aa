/// The rows of a scene, as its components emit them, while bodies move as a test prescribes.
#pragma once

#include "plab/rotation.h"
#include "plab/row_speed.h"
#include "simulation/rows/force_changes.h"
#include "simulation/rows/row_system.h"
#include "support/joints.h"

namespace plab::test
{

class RowProbe
{
public:
    explicit RowProbe(const std::string& parts) : scene_(parts, dt(1000))
    {
        REQUIRE_MESSAGE(scene_.loaded(), scene_.error());
        std::vector<simulation::BlockRow> rows;
        const auto& stepper = scene_.simulation().stepper();
        for (const simulation::Group& g : stepper.groups().all)
        {
            rows.insert(rows.end(), g.rows.begin(), g.rows.end());
            forces_.insert(forces_.end(), g.forces.begin(), g.forces.end());
        }
        system_.configure(scene_.simulation().world(), stepper.schedule(), rows, stepper.graph());
        changes_.configure(scene_.simulation().world(), stepper.schedule(), forces_);
    }
    Scene& scene() { return scene_; }
    world::HostTables& host() { return scene_.simulation().world().host(); }
    /// Any speeds, whether or not they satisfy the joints.
    void throw_about(double size)
    {
        for (std::uint32_t b = 0; b < host().bodies.size(); ++b)
        {
            if (!host().bodies.dynamic(b)) continue;
            host().bodies.velocity[b] = size * random(), host().bodies.angular_velocity[b] = size * random();
        }
        for (std::uint32_t s = 0; s < host().shafts.size(); ++s) host().shafts.speed[s] = size * random().x;
    }
    /// All bodies move for dt (s) at constant speeds.
    void move(double dt)
    {
        Bodies& bodies = host().bodies;
        for (std::uint32_t b = 0; b < bodies.size(); ++b)
        {
            bodies.position[b] += dt * bodies.velocity[b];
            bodies.orientation[b] = normalized(exp_rotation(dt * bodies.angular_velocity[b]) * bodies.orientation[b]);
        }
        for (std::uint32_t s = 0; s < host().shafts.size(); ++s) host().shafts.angle[s] += dt * host().shafts.speed[s];
        time_ += dt;
    }
    std::vector<ConstraintRow> rows()
    {
        system_.collect(context());
        return {system_.rows().begin(), system_.rows().end()};
    }
    double speed(const ConstraintRow& row) { return speed_of(row, host().bodies, host().shafts); }
    /// How the only force of the scene changes.
    ConstraintRow change()
    {
        simulation::CostMeter meter;
        meter.accounts().fit(scene_.simulation().world().components().size(), scene_.simulation().world().tables().size());
        meter.start();
        changes_.collect(context(), 0, meter);
        REQUIRE(changes_.rows().size() == 1);
        return changes_.rows().front();
    }
    /// N or N m: that force along its row.
    double force_along(const ConstraintRow& row)
    {
        const auto& block = scene_.simulation().stepper().schedule().of(Phase::Force).at(forces_.front().block);
        Wrenches wrenches{host().bodies, host().shafts};
        wrenches.force.resize(host().bodies.size()), wrenches.torque.resize(host().bodies.size());
        wrenches.shaft_torque.resize(host().shafts.size());
        const StepContext now = context();
        world::CommandCall call{now, {}};
        call.arguments.bodies = &host().bodies, call.arguments.shafts = &host().shafts, call.arguments.wrenches = &wrenches;
        call.select(*scene_.simulation().world().tables()[block.table]);
        REQUIRE(call.run(*block.command, Rows(&forces_.front().row, 1)));
        const RowBlock& b = row.blocks[row.count - 1];
        const std::uint32_t i = b.participant.index;
        if (b.participant.facet == Facet::Shaft) return wrenches.shaft_torque[i] / b.angular.x;
        const double size = length_squared(b.linear) + length_squared(b.angular);
        return (dot(wrenches.force[i], b.linear) + dot(wrenches.torque[i], b.angular)) / size;
    }

private:
    StepContext context() const
    {
        StepContext c;
        c.time = time_, c.dt = 1e-3;
        return c;
    }
    Vec3 random()
    {
        const auto next = [this]
        {
            seed_ = seed_ * 6364136223846793005u + 1442695040888963407u;
            return static_cast<double>(seed_ >> 11) * 0x1p-52 - 1;
        };
        const double x = next(), y = next(), z = next();
        return {x, y, z};
    }

    Scene scene_;
    simulation::RowSystem system_;
    simulation::ForceChanges changes_;
    std::vector<simulation::BlockRow> forces_;
    double time_ = 0;
    std::uint64_t seed_ = 7;
};

}  // namespace plab::test
