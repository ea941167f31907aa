#include "angular_velocity/couplings.h"

namespace plab::constraints
{

RoleBuilder CouplingRows::describe_driver(Schema& s) { return s.role(driver, "driver", {Facet::Shaft}, "the driving side"); }

RoleBuilder CouplingRows::describe_driven(Schema& s) { return s.role(driven, "driven", {Facet::Shaft}, "the driven side"); }

void CouplingRows::describe_fields(Schema& s)
{
    describe_factor(s, velocity_factor, driver_teeth, driven_teeth, mesh);
    s.state(phase_offset, "phase_offset", unit::radian, "angle_driven - factor * angle_driver when the coupling engaged");
    s.state(phase_factor, "phase_factor", unit::one, "factor for which phase_offset was taken; 0: not engaged yet");
    s.output(velocity_error, "velocity_error", unit::radian_per_second, "speed_driven - factor * speed_driver").reported_as_error();
    s.output(phase_error, "phase_error", unit::radian, "angle_driven - factor * angle_driver since it engaged").reported_as_error();
    s.output(torque, "torque", unit::newton_metre, "on driven about its axle; 0 for a redundant coupling");
    s.scratch(ratio, "ratio", "the factor as a rational");
}

Result<void> prepare_ratio(CouplingRows& rows, Row row)
{
    const auto ratio = ratio_of({rows.velocity_factor[row], rows.driver_teeth[row], rows.driven_teeth[row], rows.mesh[row]});
    if (!ratio) return ratio.errors();
    rows.ratio[row] = *ratio;
    return {};
}

void measure_coupling(CouplingRows& rows, Row row, const Shafts& shafts, const ShaftReactions& reactions, std::uint32_t component)
{
    const double f = rows.ratio[row].value;
    const std::uint32_t a = rows.driver[row].index;
    const std::uint32_t b = rows.driven[row].index;
    const double phase = shafts.angle[b] - f * shafts.angle[a];
    if (rows.phase_factor[row] != f) rows.phase_offset[row] = phase, rows.phase_factor[row] = f;
    rows.phase_error[row] = phase - rows.phase_offset[row];
    rows.velocity_error[row] = shafts.speed[b] - f * shafts.speed[a];
    rows.torque[row] = reactions.torque(component).value_or(0.0);
}

void AssignRows::describe(Schema& s)
{
    describe_driver(s);
    describe_driven(s).writes().exclusive();
    describe_fields(s);
}

void assign_driven(const StepContext& step, Rows which, const AssignRows& rows, ShaftMotion& motion)
{
    for (const Row row : which)
    {
        motion.begin(step.component_of_row[row], rows.driven[row]);
        motion.assign(rows.driven[row], rows.ratio[row].value * motion.rate(rows.driver[row]));
    }
}

void ImpulseRows::describe(Schema& s)
{
    describe_driver(s).writes();
    describe_driven(s).writes();
    describe_fields(s);
}

void exchange_impulses(const StepContext& step, Rows which, const ImpulseRows& rows, ShaftMotion& motion)
{
    for (const Row row : which)
    {
        const Ref a = rows.driver[row];
        const Ref b = rows.driven[row];
        const double f = rows.ratio[row].value;
        motion.begin(step.component_of_row[row], b);
        const double mobility = motion.mobility(b) + f * f * motion.mobility(a);
        if (mobility == 0) continue;  // both are prescribed: the error remains, and the host reports it
        const double lambda = -(motion.rate(b) - f * motion.rate(a)) / mobility;
        motion.apply(b, lambda);
        motion.apply(a, -f * lambda);
    }
}

void GraphRows::describe(Schema& s)
{
    describe_driver(s).writes();
    describe_driven(s).writes();
    describe_fields(s);
}

void connect(const StepContext& step, Rows which, const GraphRows& rows, RatioGraph& graph)
{
    for (const Row row : which) graph.add(step.component_of_row[row], rows.driver[row], rows.driven[row], rows.ratio[row]);
}

}  // namespace plab::constraints
