/// Contacts as forces: springs and dampers that push bodies apart while they overlap, with stiction springs along the
/// surface. See README, "contacts as forces".
#pragma once

#include <cstdint>

#include "plab/registrar.h"

namespace plab::response
{

/// A number that follows from another one by an equation that takes time to solve: remembered until that one changes.
struct Solved
{
    double of = -1;
    double value = 0;
};

/// What both laws ask of the surface and of the host (server/simulation/contact_forces/contact_forces.h reads the last two by name).
struct SurfaceColumns
{
    Column<double> friction, restitution;       // 1
    Column<double> tangential_ratio;            // 1, stiffness along the surface over stiffness across it
    Column<double> tangential_damping_ratio;    // 1
    Column<std::int64_t> steps_per_contact;     // of the solver, per half period
    Column<std::int64_t> max_substeps;          // per step
    Column<double> stored, force, penetration;  // J, N, m

    void describe(Schema& schema);
};

/// Response/Penalty: f = preload + k (depth - rest_depth) - c u_n.
struct PenaltyRows
{
    SurfaceColumns surface;
    Column<double> stiffness;      // N/m
    Column<double> damping;        // N s/m
    Column<double> damping_ratio;  // 1
    Column<bool> pulls;
    Column<Solved> ratio_of_restitution;

    void describe(Schema& schema);
};

/// Response/HuntCrossley: f = k x^n (1 - d u_n), x = depth - rest_depth + (preload / k)^(1/n).
struct HuntCrossleyRows
{
    SurfaceColumns surface;
    Column<double> stiffness;    // N/m^n
    Column<double> exponent;     // 1
    Column<double> dissipation;  // s/m
    Column<double> least_speed;  // m/s
    Column<Solved> loss_of_restitution;

    void describe(Schema& schema);
};

/// Phase::Touch. All contacts of one response that push at this stage. Impact::dt is 1 s, so that Contact::impulse comes
/// out as the force on b. Contact::stretch comes in as the present stretch of the stiction spring, and goes out as what
/// Coulomb's law lets it be.
void touch_penalty(const StepContext& context, Row row, PenaltyRows& rows, const Bodies& bodies, Wrenches& wrenches, Impact& impact);
void touch_hunt_crossley(const StepContext& context, Row row, HuntCrossleyRows& rows, const Bodies& bodies, Wrenches& wrenches,
                         Impact& impact);

/// Phase::Potential: energy in the springs, J, as of the end of the last step.
void stored_penalty(Rows rows, const PenaltyRows& table, StoredEnergy& stored);
void stored_hunt_crossley(Rows rows, const HuntCrossleyRows& table, StoredEnergy& stored);

}  // namespace plab::response
