#include "joints/gear.h"

#include <cmath>
#include <numbers>

#include "plab/limits.h"
#include "plab/number_text.h"

namespace plab::constraints
{
namespace
{

constexpr double kRightAngle = std::numbers::pi / 2;
constexpr double kUsualPressureAngle = std::numbers::pi / 9;  // 20 degrees

}  // namespace

ToothForces tooth_forces(double torque, double radius, double pressure_angle, double helix_angle)
{
    const double tangential = torque / radius;
    return {tangential, std::fabs(tangential) * std::tan(pressure_angle) / std::cos(helix_angle), tangential * std::tan(helix_angle)};
}

void GearOutputs::describe_gear(Schema& s, const std::string& last)
{
    s.state(phase_offset, "phase_offset", unit::radian, "the phase when the gear engaged");
    s.state(phase_factor, "phase_factor", unit::one, "factor for which phase_offset was taken; 0: not engaged yet");
    s.output(phase_error, "phase_error", unit::radian, "of the angles since it engaged").reported_as_error();
    s.output(velocity_error, "velocity_error", unit::radian_per_second, "of the speeds").reported_as_error();
    s.output(torque, "torque", unit::newton_metre, "on " + last + " about its axle, at the last solver stage of the step");
    s.output(redundant, "redundant", unit::one, "1: the row is implied by other rows");
}

void GearRows::describe(Schema& s)
{
    s.role(driver, "driver", {Facet::Body, Facet::Shaft}, "the driving side").writes();
    s.role(driven, "driven", {Facet::Body, Facet::Shaft}, "the driven side").writes();
    s.role(carrier, "carrier", {Facet::Body}, "the body that carries both axles; none: the world").optional().writes();
    describe_factor(s, velocity_factor, driver_teeth, driven_teeth, mesh);
    s.param(driven_radius, "driven_radius", unit::metre, "of the driven's pitch circle, for the forces between the teeth; 0: not given")
        .or_else(0)
        .not_negative();
    s.param(pressure_angle, "pressure_angle", unit::radian, "normal pressure angle of the teeth; below 90 deg; 20 deg is usual")
        .or_else(kUsualPressureAngle)
        .not_negative();
    s.param(helix_angle, "helix_angle", unit::radian, "of the teeth against the axle, at the pitch circle; within 90 deg, 0: spur gears")
        .or_else(0);
    driver_spin.describe_spin(s, "driver_", "the driver");
    driven_spin.describe_spin(s, "driven_", "the driven");
    describe_gear(s, "driven");
    s.output(tangential_force, "tangential_force", unit::newton,
             "P_t = torque / driven_radius, of the teeth on driven; 0 without driven_radius. A pure couple turns the wheels: bearings "
             "feel none of these forces");
    s.output(radial_force, "radial_force", unit::newton, "P_r = |P_t| tan(pressure_angle) / cos(helix_angle), pushes the axles apart");
    s.output(axial_force, "axial_force", unit::newton, "P_a = P_t tan(helix_angle), along driven's axle");
    s.scratch(ratio, "ratio", "the factor as a rational");
}

void PlanetaryRows::describe(Schema& s)
{
    s.role(sun, "sun", {Facet::Body, Facet::Shaft}, "the inner wheel").writes();
    s.role(ring, "ring", {Facet::Body, Facet::Shaft}, "the outer wheel").writes();
    s.role(carrier, "carrier", {Facet::Body, Facet::Shaft}, "carries the planets between them").writes();
    s.param(sun_teeth, "sun_teeth", unit::one, "tooth count of the sun").positive().at_most(1e9);
    s.param(ring_teeth, "ring_teeth", unit::one, "tooth count of the ring").positive().at_most(1e9);
    sun_spin.describe_spin(s, "sun_", "the sun");
    ring_spin.describe_spin(s, "ring_", "the ring");
    carrier_spin.describe_spin(s, "carrier_", "the carrier");
    describe_gear(s, "the carrier");
}

namespace
{

/// The carrier is the base of bodies; the axle of a shaft is fixed in the world.
Ref base_of(const GearRows& rows, Row row, Ref participant) { return participant.facet == Facet::Body ? rows.carrier[row] : Ref{}; }

struct GearSpins
{
    Spin driver, driven;
    double factor = 1;
    double phase = 0, speed = 0;  ///< before the offset, rad; rad/s
};

GearSpins spins_of(const GearRows& rows, Row row, const Bodies& bodies, const Shafts& shafts, double now)
{
    GearSpins g;
    g.driver = rows.driver_spin.spin_of(row, rows.driver[row], base_of(rows, row, rows.driver[row]), bodies, shafts);
    g.driven = rows.driven_spin.spin_of(row, rows.driven[row], base_of(rows, row, rows.driven[row]), bodies, shafts);
    g.factor = rows.ratio[row].value;
    g.phase = rows.driven_spin.angle_now(row, g.driven, now) - g.factor * rows.driver_spin.angle_now(row, g.driver, now);
    g.speed = g.driven.speed - g.factor * g.driver.speed;
    return g;
}

struct PlanetarySpins
{
    Spin sun, ring, carrier;
    double sun_share = 0, ring_share = 0;
    double phase = 0, speed = 0;
};

PlanetarySpins spins_of(const PlanetaryRows& rows, Row row, const Bodies& bodies, const Shafts& shafts, double now)
{
    PlanetarySpins p;
    p.sun = rows.sun_spin.spin_of(row, rows.sun[row], {}, bodies, shafts);
    p.ring = rows.ring_spin.spin_of(row, rows.ring[row], {}, bodies, shafts);
    p.carrier = rows.carrier_spin.spin_of(row, rows.carrier[row], {}, bodies, shafts);
    const auto sun = static_cast<double>(rows.sun_teeth[row]), ring = static_cast<double>(rows.ring_teeth[row]);
    p.sun_share = sun / (sun + ring), p.ring_share = ring / (sun + ring);
    p.phase = p.sun_share * rows.sun_spin.angle_now(row, p.sun, now) + p.ring_share * rows.ring_spin.angle_now(row, p.ring, now) -
              rows.carrier_spin.angle_now(row, p.carrier, now);
    p.speed = p.sun_share * p.sun.speed + p.ring_share * p.ring.speed - p.carrier.speed;
    return p;
}

double torque_about(const Spin& spin, const RowReport& report)
{
    return spin.participant.facet == Facet::Shaft ? report.torque.x : dot(spin.n, report.torque);
}

void put_out_teeth(GearRows& rows, Row row)
{
    ToothForces teeth;
    if (const double radius = rows.driven_radius[row]; radius > 0)
        teeth = tooth_forces(rows.torque[row], radius, rows.pressure_angle[row], rows.helix_angle[row]);
    rows.tangential_force[row] = teeth.tangential, rows.radial_force[row] = teeth.radial, rows.axial_force[row] = teeth.axial;
}

void put_out(GearOutputs& out, Row row, double phase, double speed, double torque, std::uint32_t redundant)
{
    out.phase_error[row] = phase - out.phase_offset[row];
    out.velocity_error[row] = speed;
    out.torque[row] = torque;
    out.redundant[row] = redundant;
}

}  // namespace

Result<void> prepare_gear(Row row, GearRows& rows, const Bodies& bodies)
{
    const auto ratio = ratio_of({rows.velocity_factor[row], rows.driver_teeth[row], rows.driven_teeth[row], rows.mesh[row]});
    if (!ratio) return ratio.errors();
    rows.ratio[row] = *ratio;
    const double radius = rows.driven_radius[row];
    if (radius > 0 && radius < kLeastGiven) return reason("driven_radius must be 0 or at least " + number_text(kLeastGiven));
    if (!(rows.pressure_angle[row] < kRightAngle)) return reason("pressure_angle must be below 90 deg");
    if (!(std::fabs(rows.helix_angle[row]) < kRightAngle)) return reason("helix_angle must be within 90 deg to either side");
    if (auto placed = rows.driver_spin.place(row, rows.driver[row], base_of(rows, row, rows.driver[row]), bodies); !placed) return placed;
    return rows.driven_spin.place(row, rows.driven[row], base_of(rows, row, rows.driven[row]), bodies);
}

void begin_gear(const StepContext& step, Rows which, GearRows& rows, const Bodies& bodies, const Shafts& shafts)
{
    for (const Row row : which)
    {
        const GearSpins g = spins_of(rows, row, bodies, shafts, step.time);
        rows.driver_spin.begin(row, g.driver, step.time), rows.driven_spin.begin(row, g.driven, step.time);
        rows.engage(row, g.factor, g.phase);
    }
}

void constrain_gear(const StepContext& step, Rows which, const GearRows& rows, const Bodies& bodies, const Shafts& shafts, RowSink& sink)
{
    for (const Row row : which)
    {
        const GearSpins g = spins_of(rows, row, bodies, shafts, step.time);
        ConstraintRow out;
        add_spin(g.driver, -g.factor, out);
        add_spin(g.driven, 1, out);
        out.error = g.phase - rows.phase_offset[row];
        sink.begin(step.component_of_row[row]);
        sink.add(out);
    }
}

void finish_gear(const StepContext& step, Rows which, GearRows& rows, const Bodies& bodies, const Shafts& shafts, const RowReports& reports)
{
    for (const Row row : which)
    {
        const GearSpins g = spins_of(rows, row, bodies, shafts, step.time);
        rows.driver_spin.keep_spin(row, g.driver, step.time), rows.driven_spin.keep_spin(row, g.driven, step.time);
        const RowReport report = reports.of(step.component_of_row[row]);
        put_out(rows, row, g.phase, g.speed, torque_about(g.driven, report), report.redundant);
        put_out_teeth(rows, row);
    }
}

Result<void> prepare_planetary(Row row, PlanetaryRows& rows, const Bodies& bodies)
{
    if (auto placed = rows.sun_spin.place(row, rows.sun[row], {}, bodies); !placed) return placed;
    if (auto placed = rows.ring_spin.place(row, rows.ring[row], {}, bodies); !placed) return placed;
    return rows.carrier_spin.place(row, rows.carrier[row], {}, bodies);
}

void begin_planetary(const StepContext& step, Rows which, PlanetaryRows& rows, const Bodies& bodies, const Shafts& shafts)
{
    for (const Row row : which)
    {
        const PlanetarySpins p = spins_of(rows, row, bodies, shafts, step.time);
        rows.sun_spin.begin(row, p.sun, step.time), rows.ring_spin.begin(row, p.ring, step.time);
        rows.carrier_spin.begin(row, p.carrier, step.time);
        rows.engage(row, p.sun_share, p.phase);
    }
}

void constrain_planetary(const StepContext& step, Rows which, const PlanetaryRows& rows, const Bodies& bodies, const Shafts& shafts,
                         RowSink& sink)
{
    for (const Row row : which)
    {
        const PlanetarySpins p = spins_of(rows, row, bodies, shafts, step.time);
        ConstraintRow out;
        add_spin(p.sun, p.sun_share, out);
        add_spin(p.ring, p.ring_share, out);
        add_spin(p.carrier, -1, out);
        out.error = p.phase - rows.phase_offset[row];
        sink.begin(step.component_of_row[row]);
        sink.add(out);
    }
}

void finish_planetary(const StepContext& step, Rows which, PlanetaryRows& rows, const Bodies& bodies, const Shafts& shafts,
                      const RowReports& reports)
{
    for (const Row row : which)
    {
        const PlanetarySpins p = spins_of(rows, row, bodies, shafts, step.time);
        rows.sun_spin.keep_spin(row, p.sun, step.time), rows.ring_spin.keep_spin(row, p.ring, step.time);
        rows.carrier_spin.keep_spin(row, p.carrier, step.time);
        const RowReport report = reports.of(step.component_of_row[row]);
        put_out(rows, row, p.phase, p.speed, torque_about(p.carrier, report), report.redundant);
    }
}

}  // namespace plab::constraints
