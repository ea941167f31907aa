#include "penalty.h"

#include <algorithm>
#include <cmath>

#include "penalty_law.h"

namespace plab::response
{
namespace
{

constexpr Unit kNewtonPerMetre{"N/m", {{0, 1, -2, 0}}};
constexpr Unit kSecondPerMetre{"s/m", {{-1, 0, 1, 0}}};

template <class Solve>
double remembered(Solved& memory, double of, Solve solve)
{
    if (memory.of != of) memory = {of, solve(of)};
    return memory.value;
}

/// Of each contact point where none is given, for each kilogram of the lighter body: so whatever a body weighs, it sinks by as much, on one
/// point by 10 um and 0.1 mm under its weight.
constexpr double kPenaltyPerKilogram = 1e6, kHuntCrossleyPerKilogram = 1e7;

/// As a multiple of critical damping: what damps contacts that begin without an approach, at most.
constexpr double kMostCritical = 2;

double stiffness_of(double given, double per_kilogram, const Contact& c, const Bodies& bodies)
{
    if (given > 0) return given;
    const double most = std::max(bodies.inverse_mass[c.a.index], bodies.inverse_mass[c.b.index]);
    return most > 0 ? per_kilogram / most : per_kilogram;
}

/// Sums over the contacts of one call.
struct Total
{
    double stored = 0, force = 0, penetration = 0;
};

/// For each contact: calls `normal` (returns the NormalForce for the contact, its mobility along the normal and its separation
/// speed), adds friction, and applies the forces to the bodies.
template <class Normal>
void add_contact_forces(const StepContext& context, Row row, SurfaceColumns& surface, const Bodies& bodies, Wrenches& wrenches,
                        Impact& impact, Normal normal)
{
    Total total;
    std::vector<StoredShare>& shares = surface.shares[row].of_contacts;
    shares.clear();
    wrenches.begin(row < context.component_of_row.size() ? context.component_of_row[row] : kNoIndex);
    for (Contact& c : impact.contacts)
    {
        c.impulse = {}, c.slip = 0;
        const ContactPoint point(c, bodies);
        if (!point.moves()) continue;
        const Vec3 u = bodies.velocity_at(c.b.index, c.point) - bodies.velocity_at(c.a.index, c.point);
        const double separation_speed = dot(u, c.normal);
        const Vec3 slip = u - c.normal * separation_speed;
        const NormalForce n = normal(c, point.K()(2, 2), separation_speed);

        const double k = surface.tangential_ratio[row] * n.tangential;
        const double mobility = std::max(point.K()(0, 0), point.K()(1, 1));
        const double damping = 2 * surface.tangential_damping_ratio[row] * std::sqrt(k / mobility);
        const SurfaceForce t = surface_force(k, damping, c.friction * std::max(n.force, 0.0), c.stretch, slip);

        const Vec3 force = c.normal * n.force + t.force;
        for (const auto& [body, f] : {std::pair(c.a, -force), std::pair(c.b, force)})
            if (bodies.dynamic(body.index)) wrenches.add_force_at(body, f, c.point);
        c.impulse = force * impact.dt, c.stretch = t.stretch, c.slip = length(slip);
        shares.push_back({c.a, c.b, n.stored + t.stored});
        total.stored += n.stored + t.stored, total.force += n.force;
        total.penetration = std::max(total.penetration, c.depth);
    }
    surface.stored[row] = total.stored, surface.force[row] = total.force, surface.penetration[row] = total.penetration;
}

}  // namespace

void SurfaceColumns::describe(Schema& s)
{
    s.param(friction, "friction", unit::one, "Coulomb coefficient, unless a Material/Pair overrides it").or_else(0).not_negative();
    s.param(restitution, "restitution", unit::one,
            "fraction of the approach speed that a single central contact returns, unless a Material/Pair "
            "overrides it; 1: no damping for its sake")
        .or_else(0)
        .not_negative()
        .at_most(1);
    s.param(tangential_ratio, "tangential_ratio", unit::one,
            "ratio of the stiffness of the stiction spring to the normal stiffness, of HuntCrossley at the depth that the approach reaches")
        .or_else(1)
        .positive();
    s.param(tangential_damping_ratio, "tangential_damping_ratio", unit::one,
            "ratio of the damping of the stiction spring to its critical damping")
        .or_else(0.5)
        .not_negative();
    s.param(steps_per_contact, "steps_per_contact", unit::one,
            "solver steps during one contact, whose duration is pi / (its fastest rate): while bodies touch, a "
            "step is split accordingly")
        .or_else(200)
        .at_least(4)
        .at_most(10000);
    s.param(steps_among_many, "steps_among_many", unit::one,
            "the same while more than 8 points of bodies that touch one another push, if it is less than steps_per_contact")
        .or_else(40)
        .at_least(4)
        .at_most(10000);
    s.param(max_substeps, "max_substeps", unit::one, "maximum number of pieces into which one step is split")
        .or_else(20000)
        .positive()
        .at_most(1e6);
    s.output(stored, "stored", unit::joule, "energy in the springs at the end of the step");
    s.scratch(shares, "shares", "of `stored`, by contact");
    s.output(force, "force", unit::newton, "sum of the normal forces at the end of the step");
    s.output(penetration, "penetration", unit::metre, "deepest overlap with a contact force at the end of the step").reported_as_error();
}

void PenaltyRows::describe(Schema& s)
{
    s.param(stiffness, "stiffness", kNewtonPerMetre, "of each contact point; 0: not given, then 1e6 for each kilogram of the lighter body")
        .or_else(0)
        .not_negative();
    s.param(damping, "damping", unit::kilogram_per_second,
            "of each contact point, in addition to what damping_ratio and restitution require")
        .or_else(0)
        .not_negative();
    s.param(damping_ratio, "damping_ratio", unit::one, "ratio of the damping to the critical damping of a single contact point")
        .or_else(0)
        .not_negative();
    surface.describe(s);
    s.param(pulls, "pulls", unit::one,
            "whether the damper may pull just before the bodies separate: if so, a contact ends at depth 0, "
            "otherwise when its force reaches zero")
        .or_else(true);
    s.scratch(ratio_of_restitution, "ratio_of_restitution", "damping ratio for the last restitution");
}

void HuntCrossleyRows::describe(Schema& s)
{
    s.param(stiffness, "stiffness", unit::one,
            "k of each contact point, N/m^exponent; two spheres: 4/3 E* sqrt(R*); 0: not given, then 1e7 for each kilogram of the lighter "
            "body")
        .or_else(0)
        .not_negative();
    s.param(exponent, "exponent", unit::one, "n; 1.5 for smooth round bodies (Hertz)").or_else(1.5).at_least(1).at_most(4);
    s.param(dissipation, "dissipation", kSecondPerMetre, "d: 3/2 of the loss of restitution per approach speed").or_else(0).not_negative();
    s.param(least_speed, "least_speed", unit::metre_per_second,
            "approaches slower than this are damped like an approach at this speed, if restitution requires "
            "damping, but at most twice critically")
        .or_else(0.01)
        .positive();
    surface.describe(s);
    s.scratch(loss_of_restitution, "loss_of_restitution", "d v for the last restitution");
}

void evaluate_penalty(const StepContext& context, Row row, PenaltyRows& rows, const Bodies& bodies, Wrenches& wrenches, Impact& impact)
{
    const bool pulls = rows.pulls[row];
    const auto law = [&](const Contact& c, double mobility, double separation_speed)
    {
        const double k = stiffness_of(rows.stiffness[row], kPenaltyPerKilogram, c, bodies);
        const double asked = pulls ? ratio_for_restitution(c.restitution)
                                   : remembered(rows.ratio_of_restitution[row], c.restitution, ratio_for_restitution_without_pull);
        const double ratio = rows.damping_ratio[row] + asked;
        const double damping = rows.damping[row] + (ratio > 0 ? 2 * ratio * std::sqrt(k / mobility) : 0.0);
        const double spring = c.preload + k * (c.depth - c.rest_depth);
        NormalForce n;
        n.force = spring - damping * separation_speed;
        if (!pulls) n.force = std::max(n.force, 0.0);
        n.tangential = k;
        n.stored = 0.5 * spring * spring / k;
        return n;
    };
    add_contact_forces(context, row, rows.surface, bodies, wrenches, impact, law);
}

void evaluate_hunt_crossley(const StepContext& context, Row row, HuntCrossleyRows& rows, const Bodies& bodies, Wrenches& wrenches,
                            Impact& impact)
{
    const double exponent = rows.exponent[row];
    const auto law = [&](const Contact& c, double mobility, double separation_speed)
    {
        const double k = stiffness_of(rows.stiffness[row], kHuntCrossleyPerKilogram, c, bodies);
        NormalForce n;
        const double before = c.preload > 0 ? std::pow(c.preload / k, 1 / exponent) : 0.0;
        const double x = c.depth - c.rest_depth + before;
        if (x <= 0) return n;
        const double loss = remembered(rows.loss_of_restitution[row], c.restitution, loss_for_restitution);
        const double spring = k * std::pow(x, exponent);
        // A load may press deeper than the approach could; it is damped as if it had come with the speed that reaches this
        // depth.
        const double speed = std::sqrt(2 * spring * x / (exponent + 1) * mobility);
        double per_speed = loss / std::max({c.approach, rows.least_speed[row], speed});
        // A damper c = d k x^n is critical at d = 2 sqrt(n m / (k x^(n+1))). What is put down, without an approach, would be damped as much
        // as an impact that returns nothing, a hundred times critically, in sub-steps as short as that needs.
        if (c.approach < rows.least_speed[row])
            per_speed = std::min(per_speed, kMostCritical * 2 * std::sqrt(2 * exponent / (exponent + 1)) / speed);
        const double dissipation = rows.dissipation[row] + per_speed;
        n.force = std::max(spring * (1 - dissipation * separation_speed), 0.0);
        n.tangential = stiffness_at_approach(k, exponent, std::max(c.approach, rows.least_speed[row]),
                                             bodies.inverse_mass[c.a.index] + bodies.inverse_mass[c.b.index]);
        n.stored = spring * x / (exponent + 1);
        return n;
    };
    add_contact_forces(context, row, rows.surface, bodies, wrenches, impact, law);
}

namespace
{

/// The shares are those of the last evaluation, which is that of all contacts at the end of the step. After a restore there are none yet.
void add_stored(Rows rows, const SurfaceColumns& surface, StoredEnergy& stored)
{
    for (const Row row : rows)
    {
        stored.joule += surface.stored[row];
        if (stored.sink)
            for (const StoredShare& share : surface.shares[row].of_contacts) stored.sink->add(share.joule, share.a, share.b);
    }
}

}  // namespace

void stored_penalty(Rows rows, const PenaltyRows& table, StoredEnergy& stored) { add_stored(rows, table.surface, stored); }

void stored_hunt_crossley(Rows rows, const HuntCrossleyRows& table, StoredEnergy& stored) { add_stored(rows, table.surface, stored); }

}  // namespace plab::response
