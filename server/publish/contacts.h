/// Contacts of a step as a record: the points that the step has logged, with their forces.
#pragma once

#include <vector>

#include "publish/records.h"
#include "simulation/simulation.h"

namespace plab::publish
{

/// A record has at most this many points: those with the largest normal forces. The others are counted.
inline constexpr std::size_t kMostContactPoints = 4096;

class ContactRecords
{
public:
    /// After a step that was logged (Simulation::log_contacts). What acted on a point in several parts of the step is added up; impacts
    /// stay apart. Does not allocate if `out` and earlier records held as many before.
    void fill(const simulation::Simulation& simulation, wire::ContactForces& out);

private:
    /// A logged contact; of a point with several parts the sum of their impulses.
    struct Point
    {
        const simulation::LoggedContact* at = nullptr;
        Vec3 impulse;  ///< N s
        bool asleep = false;
    };
    void list(const simulation::Simulation& simulation);
    void add_up_parts(const world::World& world);
    void limit(double h, wire::ContactForces& out);

    std::vector<Point> points_;
    std::vector<double> normal_;  ///< N s: normal impulse of each point
    std::vector<std::uint32_t> order_;
};

}  // namespace plab::publish
