/// Contacts as forces: springs and dampers that push bodies apart while they overlap, with stiction springs along the surface.
///
/// A contact is treated as an elastic layer instead of a constraint. Each contact point has a spring across the surface, whose
/// compression is the overlap, and a damper, which makes it return the share e of the approach speed. Along the surface a second
/// spring remembers how far the point has been displaced since it stuck; if its force would exceed Coulomb's limit mu f_n, the
/// point slides, and the spring is shortened to what gives exactly that limit. The contact is thus an ordinary force, and any
/// solver can integrate it with its own order, but only in steps much shorter than the half period of the spring, pi sqrt(m /
/// k). The host therefore splits a step into substeps (steps_per_contact) while something touches. Equations: README, "Contacts
/// as forces".
/// Sources: P. Cundall, O. Strack, A discrete numerical model for granular assemblies, Geotechnique 29 (1979) 47 (both springs and the
/// limit of the second); K. Hunt, F. Crossley, Coefficient of restitution interpreted as damping in vibroimpact, J. Appl. Mech. 42 (1975)
/// 440.
#pragma once

#include <cstdint>
#include <vector>

#include "plab/registrar.h"

namespace plab::response
{

/// A number that is expensive to compute from another one, cached until that one changes.
struct Solved
{
    double of = -1;
    double value = 0;
};

/// J, in the springs of one contact.
struct StoredShare
{
    Ref a, b;
    double joule = 0;
};
struct StoredShares
{
    std::vector<StoredShare> of_contacts;  ///< of those that pushed when the law was evaluated last
};

/// Columns common to both laws: surface parameters, and limits for the host (server/simulation/contact_forces/contact_forces.h
/// reads the numbers of steps by name).
struct SurfaceColumns
{
    Column<double> friction, restitution;       // 1
    Column<double> tangential_ratio;            // 1, tangential stiffness over normal stiffness
    Column<double> tangential_damping_ratio;    // 1
    Column<std::int64_t> steps_per_contact;     // steps of the solver per half period
    Column<std::int64_t> steps_among_many;      // the same where many points push
    Column<std::int64_t> max_substeps;          // per step
    Column<double> stored, force, penetration;  // J, N, m
    Column<StoredShares> shares;

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

/// Phase::Touch. Handles all contacts of one response that push at this stage. Impact::dt is 1 s, so Contact::impulse receives
/// the force on b. Contact::stretch is the present extension of the stiction spring on entry, and limited by Coulomb's law on
/// return.
void evaluate_penalty(const StepContext& context, Row row, PenaltyRows& rows, const Bodies& bodies, Wrenches& wrenches, Impact& impact);
void evaluate_hunt_crossley(const StepContext& context, Row row, HuntCrossleyRows& rows, const Bodies& bodies, Wrenches& wrenches,
                            Impact& impact);

/// Phase::Potential: energy in the springs, J, at the end of the last step.
void stored_penalty(Rows rows, const PenaltyRows& table, StoredEnergy& stored);
void stored_hunt_crossley(Rows rows, const HuntCrossleyRows& table, StoredEnergy& stored);

}  // namespace plab::response
