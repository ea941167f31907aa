// Gears of extreme ratio, and joints and gears that contradict one another.
#include <limits>

#include "case.h"
#include "pieces.h"
#include "trial.h"

namespace plab::stability
{

namespace
{

std::string shaft(const std::string& id, double speed = 0, const std::string& more = "")
{
    return component(id, "State/Shaft", attribute("inertia", 1) + attribute("angular_velocity", speed) + " " + more);
}
/// A wheel of 1 kg m^2 on a hinge.
std::string wheel(const std::string& id, double x, double speed = 0)
{
    return body(id, 1, {1, 1, 1}, {x, 0, 0}, attribute("angular_velocity", Vec3{0, 0, speed})) +
           component("bearing." + id, "Constraint/Hinge",
                     attribute("b", id) + attribute("anchor", Vec3{x, 0, 0}) + attribute("axis", Vec3{0, 0, 1}));
}
std::string coupling(const std::string& id, const std::string& type, const std::string& a, const std::string& b, double factor)
{
    return component(id, "Constraint/" + type, attribute("driver", a) + attribute("driven", b) + attribute("velocity_factor", factor));
}

struct Coupling
{
    const char* name;
    const char* type;
    bool bodies = false, one_way = false;
};
const std::vector<Coupling>& couplings()
{
    static const std::vector<Coupling> all{{"Assign", "AngularVelocity/Assign", false, true},
                                           {"Impulse", "AngularVelocity/Impulse"},
                                           {"Graph", "AngularVelocity/Graph"},
                                           {"Gear, shafts", "Gear"},
                                           {"Gear, bodies in hinges", "Gear", true}};
    return all;
}
std::vector<std::string> coupling_names()
{
    std::vector<std::string> out;
    for (const Coupling& c : couplings()) out.emplace_back(c.name);
    return out;
}

Case ratios()
{
    const std::vector<double> factors{1e-6, 1e-4, 1, 1e4, 1e6};
    Case c{"gear_ratio",
           "Gear ratios",
           "Two wheels of 1 kg m^2 with a torque of 6 N m on the driver; 1 s at 1/60 s. "
           "With Assign the driver does not feel the driven wheel, and its speed is compared with that of the driver alone. "
           "Error: the larger of the driver's speed against that with the reflected inertia, and the driven speed against the factor times "
           "the driver's; both relative. "
           "Stable to 1e-9, bounded to 1.",
           "coupling",
           "factor",
           coupling_names(),
           brief(factors),
           {},
           {}};
    c.run = [factors](std::size_t r, std::size_t v)
    {
        const Coupling& algorithm = couplings()[r];
        const double f = factors[v];
        const std::string code =
            "<component id=\"torque\" type=\"Script/Lua\" driven=\"a\"><param name=\"code\">function force(t, state) driven:add_torque(" +
            std::string(algorithm.bodies ? "vec(0, 0, 6)" : "6") + ") end</param></component>";
        Trial t((algorithm.bodies ? wheel("a", 0) + wheel("b", 3) : shaft("a") + shaft("b")) +
                    coupling("gear", algorithm.type, "a", "b", f) + code,
                dt(1.0 / 60));
        t.run(1);
        if (!t.loaded()) return t.judge(0, {});
        const auto speed = [&](const char* id)
        { return algorithm.bodies ? t.vec(id, "angular_velocity").z : t.real(id, "angular_velocity"); };
        const double exact = algorithm.one_way ? 6 : 6 / (1 + f * f), a = speed("a"), b = speed("b");
        return t.judge(std::fmax(std::fabs(a / exact - 1), std::fabs(b / (f * a) - 1)), {1e-9, 1});
    };
    c.quick = [](std::size_t, std::size_t v) { return v == 0 || v == 4; };
    return c;
}

struct Mesh
{
    const char *driver, *driven;
    double factor;
};
/// Three in a loop, a loop that almost closes, two on a pair, one between prescribed speeds.
std::vector<Mesh> bad_meshes(std::size_t v)
{
    if (v < 2) return {{"a", "b", 2}, {"b", "c", 3}, {"a", "c", v == 0 ? 5 : 5.9999}};
    if (v == 2) return {{"a", "b", 3}, {"a", "b", -2}};
    return {{"a", "b", 3}};
}

Outcome run_bad_gears(const Coupling& algorithm, std::size_t v)
{
    const bool prescribed = v == 3;
    std::string parts;
    for (const char* id : {"a", "b", "c"})
        parts += algorithm.bodies ? wheel(id, 3 * (id[0] - 'a'), 10)
                                  : shaft(id, 10, prescribed ? attribute("prescribed", std::string("true")) : "");
    const std::vector<Mesh> meshes = bad_meshes(v);
    for (std::size_t i = 0; i < meshes.size(); ++i)
        parts += coupling("g" + std::to_string(i + 1), algorithm.type, meshes[i].driver, meshes[i].driven, meshes[i].factor);
    if (prescribed && algorithm.bodies)
        for (const char* id : {"a", "b"})
            parts += component(std::string("motor.") + id, "Constraint/Motor",
                               attribute("b", std::string(id)) + attribute("axis", Vec3{0, 0, 1}) + attribute("speed", 10));
    Trial t(parts, dt(1.0 / 60));
    t.run(1);
    if (!t.loaded()) return t.judge(0, {});
    const auto speed = [&](const char* id) { return algorithm.bodies ? t.vec(id, "angular_velocity").z : t.real(id, "angular_velocity"); };
    double worst = 0;
    if (v >= 2) worst = std::fabs(speed("c") / 10 - 1);
    for (const Mesh& m : meshes)
        worst = std::fmax(worst, prescribed ? std::fmax(std::fabs(speed("a") / 10 - 1), std::fabs(speed("b") / 10 - 1))
                                            : std::fabs(speed(m.driven) - m.factor * speed(m.driver)) / 10);
    constexpr Bounds kBounds{1e-9, 10};
    const bool silent = (prescribed || worst > kBounds.stable) && !t.warned();
    return t.judge(silent ? std::numeric_limits<double>::infinity() : worst, kBounds);
}

Case bad_gears()
{
    Case c{"gear_contradiction",
           "Gears that contradict one another",
           "Three wheels of 1 kg m^2 that turn with 10 rad/s at first; 1 s at 1/60 s. "
           "They form a loop whose factors multiply to 1.2, or to 1.00002; or two of them are coupled by two different factors; or the "
           "speeds of two are prescribed and do not fit their gear. "
           "Error: the larger of the violation of each gear, and the deviation of each wheel that is prescribed or coupled to no other "
           "from 10 rad/s; both relative to 10 rad/s. "
           "Where both speeds are prescribed no gear can hold, so its violation is not counted. "
           "Stable to 1e-9, bounded to 10; a locked loop comes to rest. Beyond the first bound an event must report it.",
           "coupling",
           "contradiction",
           coupling_names(),
           {"loop of three", "loop just missed", "two on a pair", "both prescribed"},
           {},
           {}};
    c.run = [](std::size_t r, std::size_t v) { return run_bad_gears(couplings()[r], v); };
    c.quick = [](std::size_t, std::size_t) { return true; };
    return c;
}

Case bad_joints()
{
    const auto solvers = algorithms_of("Solver");
    Case c{"joint_contradiction",
           "Joints that contradict one another",
           "A body of 1 kg under its weight; 1 s at 1/240 s. "
           "It is held by rods of 1 m to two points that are 3 m apart; or by two hinges whose axes are not parallel, which lock it with "
           "five redundant rows; or by two motors of 1 and 2 rad/s in one hinge; or by a hinge that gravity turns through a rod at its "
           "dead centre. "
           "Error: largest distance from the start, m. "
           "Stable to 2.1, bounded to 10.",
           "solver",
           "contradiction",
           solvers,
           {"rods too short", "hinges askew", "two motors", "dead centre"},
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        std::string parts = gravity() + body("body", 1, {0.1, 0.1, 0.1}, {1, 0, 0});
        const auto joint = [&](const char* id, const char* type, const std::string& more)
        { parts += component(id, std::string("Constraint/") + type, attribute("b", std::string("body")) + more); };
        const std::string anchor = attribute("anchor", Vec3{}), y = attribute("axis", Vec3{0, 1, 0});
        if (v == 0)
            for (const double x : {0.0, 3.0})
                joint(x > 0 ? "far" : "near", "Distance",
                      attribute("anchor_a", Vec3{x, 0, 0}) + attribute("anchor_b", Vec3{}) + attribute("length", 1));
        if (v >= 1) joint("hinge", "Hinge", anchor + y);
        if (v == 1) joint("askew", "Hinge", anchor + attribute("axis", Vec3{0, 1, 1}));
        if (v == 2)
            for (const double speed : {1.0, 2.0}) joint(speed > 1 ? "fast" : "slow", "Motor", anchor + y + attribute("speed", speed));
        if (v == 3)
            joint("rod", "Distance", attribute("anchor_a", Vec3{-2, 0, 0}) + attribute("anchor_b", Vec3{}) + attribute("length", 3));
        Trial t(parts, dt(1.0 / 240) + attribute("solver", "Solver/" + solvers[r]));
        double worst = 0;
        t.run(1, [&] { worst = std::fmax(worst, length(t.vec("body", "position") - Vec3{1, 0, 0})); });
        return t.judge(worst, {2.1, 10});
    };
    c.quick = [solvers](std::size_t r, std::size_t) { return solvers[r] == "RungeKutta4"; };
    return c;
}

}  // namespace

std::vector<Case> joint_cases() { return {ratios(), bad_gears(), bad_joints()}; }

}  // namespace plab::stability
