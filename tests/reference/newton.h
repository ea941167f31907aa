/// A scene with the record of its contacts after each step (plab/contacts), and what Newton's laws demand of it.
#pragma once

#include "publish/contacts.h"
#include "support/gravity.h"
#include "support/ground.h"
#include "support/scene.h"

namespace plab::test
{

class RecordedScene : public Scene
{
public:
    explicit RecordedScene(const std::string& body, const std::string& settings = "dt=\"1/240\"") : Scene(body, settings)
    {
        simulation().log_contacts(true);
    }
    /// One step, and its record.
    const wire::ContactForces& next()
    {
        step();
        records_.fill(simulation(), contacts);
        return contacts;
    }
    /// N: on a body by another one; by all others if that is "".
    Vec3 force_on(const std::string& body, const std::string& by = "") const
    {
        Vec3 sum;
        for (const wire::ContactInfo& c : contacts.entries)
        {
            const bool is_b = c.b == body && (by.empty() || c.a == by), is_a = c.a == body && (by.empty() || c.b == by);
            for (const wire::ContactPoint& p : c.points)
            {
                const Vec3 on_b = p.normal * p.normal_force + p.friction_force;
                if (is_b) sum += on_b;
                if (is_a) sum += -on_b;
            }
        }
        return sum;
    }

    wire::ContactForces contacts;  ///< of the last step

private:
    publish::ContactRecords records_;
};

/// The bodies whose momentum is compared, with what they weigh.
struct Weighed
{
    std::string id;
    double mass = 1;  ///< kg
};

/// N: the largest difference between the change of a body's momentum in a step, divided by its length, and the forces on it.
inline double most_unexplained(RecordedScene& s, const std::vector<Weighed>& bodies)
{
    std::vector<Vec3> before;
    for (const Weighed& w : bodies) before.push_back(s.vec(w.id, "linear_velocity"));
    s.next();
    double most = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i)
    {
        const Vec3 change = (s.vec(bodies[i].id, "linear_velocity") - before[i]) * (bodies[i].mass / s.simulation().dt());
        most = std::max(most, length(change - Vec3{0, 0, -kG * bodies[i].mass} - s.force_on(bodies[i].id)));
    }
    return most;
}

}  // namespace plab::test
