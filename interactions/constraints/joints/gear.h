/// Gears between any mixture of bodies and shafts: a pair at a ratio, and the planetary train of three.
///
///   Gear        C = angle_b - f angle_a - offset = 0                      J = [ -f | 1 ] on spins; a carrier takes the rest
///   Planetary   C = N_s angle_s + N_r angle_r - (N_s + N_r) angle_c - offset = 0, divided by N_s + N_r
///
/// A planetary train has a sun s in the middle, a ring r with inner teeth around it, and planets between them, whose axles a carrier c
/// moves in a circle. Seen from the carrier, all axles stand still, and the train is an ordinary one: the planets are idle wheels, and the
/// inner teeth of the ring reverse the sense of rotation once, so (w_s - w_c) / (w_r - w_c) = -N_r / N_s (R. Willis, Principles of
/// mechanism, 1841). Multiplied out, this is one row over three spins. Two of them remain free: hold the ring, and it is a reduction by 1 +
/// N_r / N_s; hold none, and it is a differential that divides the torque in the ratio N_s : N_r : -(N_s + N_r). Planets have no inertia
/// here.
///
/// Angles include whole turns, so C holds over any number of them. For shafts alone, Constraint/AngularVelocity/Graph is cheaper
/// and free of drift.
///
/// Forces between the teeth of a Gear, at the pitch circle of radius r of the driven gear, with normal pressure angle a and
/// helix angle b (ISO 21771; J. Shigley, Mechanical engineering design, chapter 13); T is the torque on the driven gear about
/// its axle:
///   P_t = T / r        P_r = |P_t| tan a / cos b        P_a = P_t tan b
/// They are outputs only. The row is a pure couple: it turns both wheels as P_t would, but neither the bearings nor the parts
/// that hold them feel P_t, P_r or P_a. Where they should, add them to the bodies as forces.
#pragma once

#include "angular_velocity/ratio.h"
#include "joints/spin.h"

namespace plab::constraints
{

/// Outputs of gears.
struct GearOutputs
{
    Column<double> phase_offset, phase_factor;  // rad, 1
    Column<double> phase_error, velocity_error, torque;
    Column<std::int64_t> redundant;

    void describe_gear(Schema& s, const std::string& last);
    /// The offset is taken when the gear engages, and anew after a change of its factor.
    void engage(Row row, double factor, double phase)
    {
        if (phase_factor[row] != factor) phase_offset[row] = phase, phase_factor[row] = factor;
    }
};

/// Forces between the teeth of a pair, N.
struct ToothForces
{
    double tangential = 0, radial = 0, axial = 0;
};
/// `torque` on a gear (N m), `radius` of its pitch circle (m, positive), angles below a right angle (rad).
ToothForces tooth_forces(double torque, double radius, double pressure_angle, double helix_angle);

struct GearRows : GearOutputs
{
    Column<Ref> driver, driven, carrier;
    Column<double> velocity_factor;
    Column<std::int64_t> driver_teeth, driven_teeth;
    Column<std::string> mesh;
    Column<double> driven_radius, pressure_angle, helix_angle;   // m, rad
    Column<double> tangential_force, radial_force, axial_force;  // N
    SpinColumns driver_spin, driven_spin;
    Column<Ratio> ratio;

    void describe(Schema& s);
};
struct PlanetaryRows : GearOutputs
{
    Column<Ref> sun, ring, carrier;
    Column<std::int64_t> sun_teeth, ring_teeth;
    SpinColumns sun_spin, ring_spin, carrier_spin;

    void describe(Schema& s);
};

Result<void> prepare_gear(Row row, GearRows& rows, const Bodies& bodies);
void begin_gear(const StepContext& step, Rows which, GearRows& rows, const Bodies& bodies, const Shafts& shafts);
void constrain_gear(const StepContext& step, Rows which, const GearRows& rows, const Bodies& bodies, const Shafts& shafts, RowSink& sink);
void finish_gear(const StepContext& step, Rows which, GearRows& rows, const Bodies& bodies, const Shafts& shafts,
                 const RowReports& reports);

Result<void> prepare_planetary(Row row, PlanetaryRows& rows, const Bodies& bodies);
void begin_planetary(const StepContext& step, Rows which, PlanetaryRows& rows, const Bodies& bodies, const Shafts& shafts);
void constrain_planetary(const StepContext& step, Rows which, const PlanetaryRows& rows, const Bodies& bodies, const Shafts& shafts,
                         RowSink& sink);
void finish_planetary(const StepContext& step, Rows which, PlanetaryRows& rows, const Bodies& bodies, const Shafts& shafts,
                      const RowReports& reports);

}  // namespace plab::constraints
