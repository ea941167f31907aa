/// The rows of a scene, as its components emit them, while bodies move as a test prescribes.
#pragma once

#include "plab/rotation.h"
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
        for (const simulation::Group& g : stepper.groups().all) rows.insert(rows.end(), g.rows.begin(), g.rows.end());
        system_.configure(scene_.simulation().world(), stepper.schedule(), rows, stepper.graph());
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
        StepContext context;
        context.time = time_, context.dt = 1e-3;
        system_.collect(context);
        return {system_.rows().begin(), system_.rows().end()};
    }
    double speed(const ConstraintRow& row)
    {
        double sum = 0;
        for (std::uint32_t k = 0; k < row.count; ++k)
        {
            const RowBlock& b = row.blocks[k];
            sum += b.participant.facet == Facet::Shaft ? b.angular.x * host().shafts.speed[b.participant.index]
                                                       : dot(b.linear, host().bodies.velocity[b.participant.index]) +
                                                             dot(b.angular, host().bodies.angular_velocity[b.participant.index]);
        }
        return sum;
    }

private:
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
    double time_ = 0;
    std::uint64_t seed_ = 7;
};

}  // namespace plab::test
