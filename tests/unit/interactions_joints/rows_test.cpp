// Each joint's rows against finite differences: J is the derivative of the error, and bias that of -J at constant speeds.
#include "rows.h"

using namespace plab;
using namespace plab::test;

namespace
{

const std::string kBodies = body("a", 2, {.2, .3, .4}, {.3, .1, -.2}, "orientation='0.8 0.4 0.2 0.4'") +
                            body("b", 3, {.5, .6, .7}, {1, .4, .5}, "orientation='0.1 0.5 -0.7 0.5'") +
                            body("c", 1, {.2, .2, .3}, {-1, .2, .1}, "orientation='0.5 0.5 0.5 -0.5'") +
                            "<component id='s' type='State/Shaft' inertia='2'/><component id='t' type='State/Shaft' inertia='3'/>";

struct Case
{
    const char *type, *more;
    bool inside = true;  ///< an action on two bodies, and its reaction
};
const Case kCases[] = {
    {"Ball", "a='a' b='b' anchor='0.7 0.2 0.1'"},
    {"Ball", "b='b' anchor='0.7 0.2 0.1'", false},
    {"Hinge", "a='a' b='b' anchor='0.7 0.2 0.1' axis='0.6 0 0.8'"},
    {"Slider", "a='a' b='b' anchor='0.7 0.2 0.1' axis='0 0.6 0.8'"},
    {"Cylindrical", "a='a' b='b' anchor='0.7 0.2 0.1' axis='0 0.6 0.8'"},
    {"Cylindrical", "b='b' anchor='0.7 0.2 0.1' axis='0 0.6 0.8'", false},
    {"Screw", "a='a' b='b' anchor='0.7 0.2 0.1' axis='0 0.6 0.8' lead='0.4'"},
    {"Screw", "b='b' anchor='0.7 0.2 0.1' axis='0.6 0 0.8' lead='-1.5'", false},
    {"Planar", "a='a' b='b' anchor='0.7 0.2 0.1' axis='0 0.6 0.8'"},
    {"Universal", "a='a' b='b' anchor='0.7 0.2 0.1' axis='0.6 0 0.8' axis_b='0 1 0'"},
    {"Universal", "a='a' b='b' anchor='0.7 0.2 0.1' axis='0.6 0 0.8' axis_b='0.28 0 0.96'"},
    {"Universal", "b='b' anchor='0.7 0.2 0.1' axis='1 0 0' axis_b='0 0.6 0.8'", false},
    {"Fixed", "a='a' b='b' anchor='0.7 0.2 0.1'"},
    {"Distance", "a='a' b='b' anchor_a='0.1 0.2 0.3' anchor_b='-0.2 0.1 0.4'"},
    {"Motor", "a='a' b='b' axis='0.6 0 0.8' mode='servo' target='1' speed='inf' gain='3'"},
    {"Motor", "a='a' b='b' along='slide' anchor_a='0.1 0.2 0.3' anchor_b='-0.2 0.1 0.4' axis='0.6 0 0.8' speed='2'"},
    {"Motor", "a='a' b='b' along='distance' anchor_a='0.1 0.2 0.3' anchor_b='-0.2 0.1 0.4' speed='2'"},
    {"Gear", "driver='a' driven='b' carrier='c' velocity_factor='-2.5' driver_axis='0.6 0 0.8' driven_axis='0 0.6 0.8'"},
    {"Gear", "driver='a' driven='s' velocity_factor='3' driver_axis='0 0 1'", false},
    {"Planetary", "sun='a' ring='s' carrier='t' sun_teeth='20' ring_teeth='80' sun_axis='0.6 0.8 0'", false},
    {"Pulley",
     "a='a' b='b' carrier='c' wheel_a='0.4 0.6 0.3' wheel_b='-0.2 0.5 1.1' anchor_a='0.1 0.2 0.3' anchor_b='-0.2 0.1 0.4' ratio='3'"},
    {"Pulley", "a='a' b='b' wheel_a='0.4 0.6 0.3' wheel_b='-0.2 0.5 1.1' anchor_b='-0.2 0.1 0.4'", false},
    {"Rack", "pinion='a' rack='b' carrier='c' radius='0.7' rack_axis='0.6 0 0.8' pinion_axis='0 0.6 0.8'"},
    {"Rack", "pinion='s' rack='b' carrier='c' radius='1.7' rack_axis='0.6 0 0.8'", false},
    {"Rack", "pinion='a' rack='b' radius='0.7' rack_axis='0.6 0 0.8'", false},
    {"Coupler",
     "driver='a' driven='b' carrier='c' driver_along='slide' driven_along='slide' factor='-1.5' driver_axis='0.6 0 0.8' "
     "driven_axis='0 0.6 0.8'"},
    {"Coupler", "driver='a' driven='b' carrier='c' in_chain='true' factor='0.7' driver_axis='0.6 0 0.8' driven_axis='0 0.6 0.8'"},
    {"Coupler", "driver='a' driven='b' in_chain='true' driven_along='slide' factor='0.7' driver_axis='0.6 0 0.8' driven_axis='0 0.6 0.8'",
     false},
    {"Coupler", "driver='s' driven='t' factor='0.7'", false},
    {"Rolling", "a='a' b='b' semi_axes='0.3 0.2 0.1' centre='0.02 0.01 -0.03' normal='0.6 0 0.8'"},
    {"Rolling", "b='b' semi_axes='0.3 0.2 0.1' axes='0.8 0 0.6 0'", false},
    {"Rolling", "a='a' b='b' semi_axes='0.2 0.2 0.2' on='sphere' radius='0.7' centre='0.02 0.01 -0.03' normal='0 0.6 0.8'"},
    {"Rolling", "a='a' b='b' semi_axes='0.2 0.2 0.2' on='sphere' radius='0.7' inside='true' point='0.9 0.3 0.1'"},
    {"Rolling", "a='a' b='b' semi_axes='0.2 0.2 0.2' on='cylinder' radius='0.7' axis='0 0.6 0.8' point='0.3 0.5 0.1'"},
    {"Rolling", "b='b' semi_axes='0.2 0.2 0.2' on='cylinder' radius='0.7' inside='true' axis='0 0.6 0.8' normal='1 0 0' parallel='true'",
     false},
};

constexpr double kApart = 1e-4;  // s

/// Calls note() at five times around the present one, kApart from one another, and comes back.
template <class Note>
void note_around(RowProbe& probe, const Note& note)
{
    probe.move(-2 * kApart);
    for (int i = -2; i <= 2; ++i, probe.move(kApart)) note();
    probe.move(-3 * kApart);
}

/// The derivative at the middle one of those times, by differences of fourth order.
template <class Value>
double slope(const Value& value)
{
    return (value(0) - 8 * value(1) + 8 * value(3) - value(4)) / (12 * kApart);
}

}  // namespace

TEST_CASE("rows: J and bias agree with central differences, and the error with the rate of its row")
{
    for (const Case& c : kCases)
    {
        CAPTURE(std::string(c.type));
        CAPTURE(std::string(c.more));
        RowProbe probe(kBodies + "<component id='j' type='Constraint/" + c.type + "' " + c.more + "/>");
        probe.throw_about(1);
        const auto at = probe.rows();
        std::vector<std::vector<ConstraintRow>> around;
        std::vector<std::vector<double>> speeds;
        note_around(probe,
                    [&]
                    {
                        around.push_back(probe.rows());
                        speeds.emplace_back();
                        for (const ConstraintRow& row : around.back()) speeds.back().push_back(probe.speed(row) - row.rate);
                    });
        REQUIRE(!at.empty());
        for (std::size_t r = 0; r < at.size(); ++r)
        {
            CAPTURE(r);
            const double bias = -slope([&](std::size_t i) { return speeds[i][r]; });
            CAPTURE(at[r].bias);
            CAPTURE(bias);
            CHECK(near(at[r].bias, bias, 1e-8));
            if (at[r].kind != RowKind::Equality) continue;
            const double rate = slope([&](std::size_t i) { return around[i][r].error; });
            CHECK(near(speeds[2][r], rate, 1e-8));
        }
    }
}

TEST_CASE("rows between bodies are action and reaction: no net force and no net moment remains")
{
    for (const Case& c : kCases)
    {
        if (!c.inside) continue;
        CAPTURE(std::string(c.type));
        RowProbe probe(kBodies + "<component id='j' type='Constraint/" + c.type + "' " + c.more + "/>");
        for (const ConstraintRow& row : probe.rows())
        {
            Vec3 force, moment;
            for (std::uint32_t k = 0; k < row.count; ++k)
            {
                const RowBlock& b = row.blocks[k];
                force += b.linear, moment += cross(probe.host().bodies.position[b.participant.index], b.linear) + b.angular;
            }
            CHECK(length(force) < 1e-15);
            CHECK(length(moment) < 1e-15);
        }
    }
}

TEST_CASE("the change that a force tells is its derivative: by displacements, and by speeds")
{
    const Case cases[] = {
        {"SpringDamper", "a='a' b='b' anchor_a='0.1 0.2 0.3' anchor_b='-0.2 0.1 0.4' length='0.5' stiffness='30' damping='4'"},
        {"SpringDamper", "b='b' anchor_a='0.1 0.2 0.3' anchor_b='-0.2 0.1 0.4' length='0.5' stiffness='30' damping='4'"},
        {"TorsionSpring", "a='a' b='b' axis='0.6 0 0.8' stiffness='30' damping='4'"},
        {"TorsionSpring", "a='s' b='t' stiffness='30' damping='4'"},
        {"TorsionSpring", "a='a' b='b' along='slide' anchor='0.7 0.2 0.1' axis='0.6 0 0.8' stiffness='30' damping='4'"},
        {"Actuator", "a='a' b='b' axis='0.6 0 0.8' gain='5' control='3' bias='2 -30 -4' gear='-1.5'"},
        {"Actuator", "a='a' b='b' along='slide' anchor='0.7 0.2 0.1' axis='0 0.6 0.8' gain='5' control='3' bias='2 -30 -4' gear='1.5'"},
        {"Actuator", "a='a' b='b' along='distance' anchor_a='0.1 0.2 0.3' anchor_b='-0.2 0.1 0.4' gain='5' control='3' bias='2 -30 -4'"},
    };
    for (const Case& c : cases)
    {
        CAPTURE(std::string(c.type));
        CAPTURE(std::string(c.more));
        RowProbe probe(kBodies + "<component id='j' type='Constraint/" + c.type + "' " + c.more + "/>");
        probe.throw_about(1);
        const ConstraintRow change = probe.change();
        CHECK(change.kind == RowKind::ForceChange);
        CHECK(change.rate == probe.speed(change));
        CHECK(change.bias == 0);
        std::vector<double> forces, speeds;
        note_around(probe,
                    [&]
                    {
                        const ConstraintRow now = probe.change();
                        forces.push_back(probe.force_along(now)), speeds.push_back(probe.speed(now));
                    });
        const double force_rate = slope([&](std::size_t i) { return forces[i]; });
        const double acceleration = slope([&](std::size_t i) { return speeds[i]; });
        CHECK(near(force_rate, -change.stiffness * change.rate - change.damping * acceleration, 1e-7));
        for (Vec3& v : probe.host().bodies.velocity) v *= 2;
        for (Vec3& w : probe.host().bodies.angular_velocity) w *= 2;
        for (double& s : probe.host().shafts.speed) s *= 2;
        CHECK(near(probe.force_along(change) - forces[2], -change.damping * change.rate, 1e-12));
    }
}

TEST_CASE("the change of an actuator at its limit starts from the force that it would have without")
{
    for (const double gear : {1.5, -1.5})
    {
        CAPTURE(gear);
        const std::string law =
            "<component id='j' type='Constraint/Actuator' a='a' b='b' axis='0.6 0 0.8' gain='50' control='3' bias='2 -30 -4' gear='" +
            text(gear) + "' ";
        RowProbe free(kBodies + law + "/>"), limited(kBodies + law + "force_lower='-2' force_upper='7'/>");
        free.throw_about(1), limited.throw_about(1);
        const ConstraintRow change = limited.change();
        const double force = limited.force_along(change), wanted = free.force_along(free.change());
        CHECK(force == doctest::Approx(7 * gear));
        CHECK(change.bias == doctest::Approx(wanted - force));
        CHECK(change.lower == doctest::Approx(gear > 0 ? -9 * gear : 0));
        CHECK(change.upper == doctest::Approx(gear > 0 ? 0 : -9 * gear));
    }
}
