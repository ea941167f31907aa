// Solver/Automatic in scenes: which solver it picks, that it gives the same bits as that solver, and that other bodies of the
// scene do not change the result.
//
// scene                                picks               checked
// drag, pendulum, gears, script        RungeKutta4         the state hash of RungeKutta4 in each step
// free bodies                          Exact               each one's bits, alone or among others, with 1, 2 and 3 threads
// spring on a slider, stiff drag       Exponential         the event, its reason; closed form
// all of these in one scene            each its own        the bits of each alone
#include "reference/motion.h"
#include "support/gravity.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string free_body(int i)
{
    const std::string n = std::to_string(i);
    return "<component id=\"free" + n + "\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 2 2.5\" position=\"0 0 " + n +
           "\" linear_velocity=\"0 " + n + " 1\" angular_velocity=\"0.3 " + n + " 0.1\"/>";
}
const std::string kBraked =
    R"(<component id="braked" type="State/RigidBody" mass="1" inertia="1 2 2.5" linear_velocity="3 0 0" angular_velocity="1 2 0"/>
    <component id="drag" type="Field/Drag" between="braked" linear="0.5" quadratic="0.1" rotational="0.1"/>)";
const std::string kPendulum = R"(<component id="bob" type="State/RigidBody" mass="1" inertia="0.1 0.1 0.1" position="0.5 0 0"/>
    <component id="pin" type="Constraint/Ball" b="bob" anchor="0 0 0"/>)";
const std::string kGears =
    R"(<component id="s1" type="State/Shaft" inertia="1" angular_velocity="2"/><component id="s2" type="State/Shaft" inertia="3"/>
    <component id="gear" type="Constraint/AngularVelocity/Graph" driver="s1" driven="s2" velocity_factor="-0.5"/>
    <component id="brake" type="Field/Drag" between="s2" rotational="0.3"/>)";
const std::string kScript =
    R"(<component id="ball" type="State/RigidBody" mass="1" inertia="1 1 1" position="5 0 0" linear_velocity="1 1 0"/>
    <component id="law" type="Script/Lua" driven="ball"><param name="code">
    function force(t, state) driven:add_force(driven.position * -1 + vec(0, 0, math.sin(3 * t))) end</param></component>)";
const std::string kStiff = R"(<component id="mass" type="State/RigidBody" mass="1" inertia="1 1 1" position="0 3 0"/>
    <component id="rail" type="Constraint/Slider" b="mass" anchor="0 3 0" axis="0 0 1"/>
    <component id="spring" type="Constraint/SpringDamper" b="mass" anchor_a="0 3 -1" anchor_b="0 0 0" length="0.99" stiffness="1e6"/>)";

/// Position and attitude of some bodies after 1 s.
std::vector<double> bits(const std::string& components, const std::vector<std::string>& bodies, int threads = 1)
{
    Scene s(solver({"Automatic"}) + components + kGravity, per_second(120) + " solver=\"solver\"", threads);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    std::vector<double> out;
    for (const std::string& b : bodies)
    {
        const Vec3 p = s.vec(b, "position"), w = s.vec(b, "angular_velocity");
        const Quat q = s.quat(b, "orientation");
        out.insert(out.end(), {p.x, p.y, p.z, w.x, w.y, w.z, q.w, q.x, q.y, q.z});
    }
    return out;
}

}  // namespace

TEST_CASE("scenes that are soft and slow have the bits of RungeKutta4")
{
    for (const std::string& components : {kBraked, kPendulum, kGears, kScript})
    {
        CAPTURE(components);
        const auto scene = [&](const std::string& type)
        { return Scene(solver({type}) + components + kGravity, per_second(240) + " solver=\"solver\""); };
        Scene automatic = scene("Automatic"), classical = scene("RungeKutta4");
        REQUIRE_MESSAGE(automatic.loaded(), automatic.error());
        for (int i = 0; i < 100; ++i)
        {
            automatic.step(), classical.step();
            REQUIRE(automatic.hash() == classical.hash());
        }
        CHECK(std::get<std::string>(automatic.get("solver", "resolved")) == "RungeKutta4");
    }
}

TEST_CASE("each group is advanced as if it were alone, with any number of threads")
{
    std::string all = kBraked + kPendulum + kStiff;
    std::vector<std::string> names{"braked", "bob", "mass"};
    std::vector<double> alone;
    const auto add = [&](const std::vector<double>& more) { alone.insert(alone.end(), more.begin(), more.end()); };
    add(bits(kBraked, {"braked"})), add(bits(kPendulum, {"bob"})), add(bits(kStiff, {"mass"}));
    for (int i = 0; i < 6; ++i)
    {
        const std::string name = "free" + std::to_string(i);
        all += free_body(i), names.push_back(name), add(bits(free_body(i), {name}));
    }
    for (const int threads : {1, 2, 3})
    {
        CAPTURE(threads);
        CHECK(bits(all, names, threads) == alone);
    }
}

TEST_CASE("groups with forces are advanced together until one of them needs another method, with the bits of each alone")
{
    // Nine on soft springs; one is hit by a stiff one, one spins fast.
    std::string all;
    std::vector<std::string> names;
    std::vector<double> alone;
    for (int i = 0; i < 9; ++i)
    {
        const std::string n = std::to_string(i), name = "body" + n, spin = i == 4 ? "0 0 40" : "0.1 0.2 0.3";
        const std::string one = "<component id=\"" + name + "\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1.5 2\" position=\"" + n +
                                " 0 0\" angular_velocity=\"" + spin + "\"/><component id=\"spring" + n +
                                "\" type=\"Constraint/SpringDamper\" b=\"" + name + "\" anchor_a=\"" + n +
                                " 0 3\" anchor_b=\"0.1 0 0\" length=\"2.9\" stiffness=\"" + (i == 6 ? "1e5" : "50") + "\" damping=\"1\"/>";
        all += one, names.push_back(name);
        const std::vector<double> b = bits(one, {name});
        alone.insert(alone.end(), b.begin(), b.end());
    }
    for (const int threads : {1, 2}) CHECK(bits(all, names, threads) == alone);
    Scene s(solver({"Automatic"}) + all + kGravity, per_second(120) + " solver=\"solver\"");
    s.run(1);
    CHECK(std::get<std::string>(s.get("solver", "resolved")).find("RungeKutta4, RotationSplitting, ") == 0);
    double work = 0;
    for (const double w : s.simulation().stepper().work()) work += w;
    const double before = 8 * 0.5 * (0.01 + 1.5 * 0.04 + 2 * 0.09) + 0.5 * 2 * 1600;
    CHECK(s.simulation().totals().kinetic - before == doctest::Approx(work).epsilon(1e-5));
}

TEST_CASE("it reports once what it picked and why")
{
    Scene s(solver({"Automatic"}) + free_body(1) + kBraked + kStiff + kGravity, per_second(120) + " solver=\"solver\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.run(1);
    REQUIRE(s.count("solver.chosen") == 1);
    CHECK(std::get<std::string>(s.get("solver", "resolved")) == "Exact, RungeKutta4, Exponential");
    CHECK(std::get<std::string>(s.get("solver", "reason")).find("Exponential: |h lambda| = ") == 0);
    const double expected = -0.01 - 9.81e-6;
    CHECK(s.vec("mass", "position").z == doctest::Approx(expected * (1 - std::cos(1000.0))).epsilon(1e-9));
}

TEST_CASE("a spring that is stiffened during the run changes the method in the same step")
{
    Scene s(spring_scene({"Automatic"}, 100, 0), per_second(100));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.5);
    CHECK(std::get<std::string>(s.get("solver", "resolved")) == "RungeKutta4");
    simulation::Request request;
    request.operations.push_back(simulation::SetOperation{"spring", "stiffness", 1e8});
    REQUIRE(s.simulation().carry_out_now(request).done);
    const double x = s.vec("mass", "position").x, v = s.vec("mass", "linear_velocity").x;
    for (int i = 0; i < 50; ++i)
    {
        s.step();
        const double now = s.vec("mass", "position").x, speed = s.vec("mass", "linear_velocity").x;
        REQUIRE(speed * speed + 1e8 * now * now == doctest::Approx(v * v + 1e8 * x * x).epsilon(1e-9));
    }
    CHECK(std::get<std::string>(s.get("solver", "resolved")) == "Exponential");
}
