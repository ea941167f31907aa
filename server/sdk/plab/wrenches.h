/// Accumulators of forces: one sum per body and shaft, and the power of each force component for the energy ledger.
#pragma once

#include <span>
#include <vector>

#include "plab/ref.h"
#include "plab/tables.h"

namespace plab
{

/// Sums of forces and torques at one solver stage. Phase::Force functions add; the host clears and reads.
class Wrenches
{
public:
    std::vector<Vec3> force;                         ///< N, in W, per body
    std::vector<Vec3> torque;                        ///< N m about C, in W, per body
    std::vector<double> shaft_torque;                ///< N m about the axle, per shaft
    std::vector<std::vector<double>> quantity_rate;  ///< per row of Quantities and value: unit of the value per second

    Wrenches() = default;
    Wrenches(const Bodies& bodies, const Shafts& shafts) : bodies_(&bodies), shafts_(&shafts) {}
    void bind(const Bodies& bodies, const Shafts& shafts) { bodies_ = &bodies, shafts_ = &shafts; }

    /// Names the component (directory index) to which the following additions belong. To be called before the first one.
    void begin(std::uint32_t component) { current_ = component; }

    /// A force through the centre of mass.
    void add_force(Ref body, const Vec3& f_W)
    {
        force[body.index] += f_W;
        if (accounted(body)) account(dot(f_W, bodies_->velocity[body.index]));
    }
    /// A force at a point of the body.
    void add_force_at(Ref body, const Vec3& f_W, const Vec3& p_W)
    {
        const Vec3 t = cross(p_W - bodies_->position[body.index], f_W);
        force[body.index] += f_W;
        torque[body.index] += t;
        if (accounted(body)) account(dot(f_W, bodies_->velocity[body.index]) + dot(t, bodies_->angular_velocity[body.index]));
    }
    void add_torque(Ref body, const Vec3& t_W)
    {
        torque[body.index] += t_W;
        if (accounted(body)) account(dot(t_W, bodies_->angular_velocity[body.index]));
    }
    void add_shaft_torque(Ref shaft, double t)
    {
        shaft_torque[shaft.index] += t;
        if (accounted(shaft)) account(t * shafts_->speed[shaft.index]);
    }

    /// Adds to the rate of value i of a row of Quantities. Does no work.
    void add_rate(Ref quantities, std::size_t i, double rate) { quantity_rate[quantities.index][i] += rate; }

    /// Power by component, W; null where nothing is booked (trial steps).
    std::vector<double>* power = nullptr;
    /// Participants whose power is booked; those outside the advanced set are not part of the ledger. Empty: all.
    std::span<const std::uint8_t> accounted_bodies, accounted_shafts;

private:
    bool accounted(Ref r) const
    {
        const auto& accounted = r.facet == Facet::Body ? accounted_bodies : accounted_shafts;
        return power && (accounted.empty() || accounted[r.index] != 0);
    }
    void account(double watts) { (*power)[current_] += watts; }
    const Bodies* bodies_ = nullptr;
    const Shafts* shafts_ = nullptr;
    std::uint32_t current_ = 0;
};

}  // namespace plab
