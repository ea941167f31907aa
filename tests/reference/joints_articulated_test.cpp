// Solver/Articulated: trees of joints in minimal coordinates (Featherstone), against closed forms and against the rows.
#include <algorithm>

#include "reference/pendulums.h"
#include "support/allocation_counter.h"

using namespace plab;
using namespace plab::simulation;
using namespace plab::test;

namespace
{

std::string tight(const std::string& type, const std::string& tolerance = "1e-11")
{
    return "<component id='solver' type='Solver/" + type + "' relative_tolerance='" + tolerance + "' absolute_tolerance='" + tolerance +
           "'/>";
}
std::string link_id(int i) { return "l" + std::to_string(1000 + i); }

/// Links of 0.5 m along x, released level. `held`: the first is joined to the world.
std::string level_chain(const std::string& solver, int n, const std::string& type, bool held = true)
{
    std::string parts = solver + (held ? gravity() : "");
    for (int i = 0; i < n; ++i)
    {
        const std::string turn = held ? "" : " angular_velocity='0.3 " + text(0.1 * i) + " -0.2'";
        parts += body(link_id(i), 1, {.0004, .02, .0202}, {.5 * i + .25, 0, 0}, turn);
        if (i == 0 && !held) continue;
        parts += joint("j" + link_id(i), type, i == 0 ? "" : link_id(i - 1), link_id(i),
                       "anchor='" + text(.5 * i) + " 0 0'" + (type == "Hinge" ? " axis='0 1 0'" : ""));
    }
    return parts;
}

/// All kinds of joints, branches, and a joint whose child is its `a`.
std::string mixed_tree(const std::string& solver, const std::string& more = "")
{
    return solver + gravity() + body("p", 1, {.1, .2, .15}, {.5, 0, 0}) + body("q", 2, {.3, .2, .1}, {1.2, .1, 0}) +
           body("r", .5, {.1, .1, .2}, {1.5, .6, .2}) + body("s", 1.5, {.2, .1, .1}, {.4, -.6, .1}) +
           body("t", .7, {.05, .08, .06}, {1, 1, 1}, "angular_velocity='1 2 3' linear_velocity='0 1 0'") +
           joint("j1", "Hinge", "", "p", "anchor='0 0 0' axis='0.6 0.8 0'") + joint("j2", "Ball", "q", "p", "anchor='0.9 0 0'") +
           joint("j3", "Slider", "q", "r", "axis='0 0.6 0.8'") + joint("j4", "Hinge", "p", "s", "anchor='0.4 -0.3 0' axis='0 0 1'") +
           joint("j5", "Fixed", "t", "u", "") +
           body("u", .3, {.05, .08, .06}, {1.3, 1, 1}, "angular_velocity='1 2 3' linear_velocity='0 1.9 -0.6'") + more;
}
const std::array<const char*, 6> kTreeParts{"p", "q", "r", "s", "t", "u"};

double energy(const Scene& s, int n)
{
    double sum = 0;
    for (int i = 0; i < n; ++i)
    {
        const Quat q = s.quat(link_id(i), "orientation");
        const Vec3 w = rotate_back(q, s.vec(link_id(i), "angular_velocity")), v = s.vec(link_id(i), "linear_velocity");
        sum += .5 * dot(v, v) + .5 * (.0004 * w.x * w.x + .02 * w.y * w.y + .0202 * w.z * w.z) + 9.81 * s.vec(link_id(i), "position").z;
    }
    return sum;
}

std::string resolved(const Scene& s) { return std::get<std::string>(s.get("solver", "resolved")); }

}  // namespace

TEST_CASE("E1: a pendulum in minimal coordinates agrees with its elliptic functions")
{
    for (const std::string type : {"Ball", "Hinge"})
    {
        CAPTURE(type);
        Scene s(pendulum(tight("Articulated"), type), dt(60));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(10);
        CHECK(resolved(s) == "Articulated");
        CHECK(angle_error(s.vec("bob", "position"), kPendulumAt10) < 2e-9);
        CHECK(s.real("j", "position_error") < 1e-14);
    }
}

TEST_CASE("A tree of all kinds of joints moves as its rows do")
{
    Scene minimal(mixed_tree(tight("Articulated")), dt(240)), rows(mixed_tree(tight("DormandPrince54")), dt(240));
    REQUIRE_MESSAGE(minimal.loaded(), minimal.error());
    REQUIRE(rows.loaded());
    for (int i = 0; i < 4; ++i)
    {
        minimal.step(60), rows.step(60);
        for (const std::string id : kTreeParts)
        {
            CAPTURE(id);
            CHECK(length(minimal.vec(id, "position") - rows.vec(id, "position")) < 1e-8);
            CHECK(length(minimal.vec(id, "angular_velocity") - rows.vec(id, "angular_velocity")) < 1e-7);
        }
        for (const std::string id : {"j1", "j2", "j3", "j4", "j5"})
        {
            CAPTURE(id);
            CHECK(minimal.real(id, "position_error") < 1e-13);
        }
    }
    CHECK(resolved(minimal) == "Articulated");
}

TEST_CASE("Chains of 20 links keep their energy with the tolerance")
{
    for (const std::string type : {"Hinge", "Ball"})
    {
        double before = 0;
        for (const std::string tolerance : {"1e-5", "1e-7", "1e-9"})
        {
            CAPTURE(type);
            CAPTURE(tolerance);
            Scene s(level_chain(tight("Articulated", tolerance), 20, type), dt(60));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(1);
            const double drift = std::fabs(energy(s, 20)) / (9.81 * 100);
            CHECK(drift < 2e-5);
            if (before > 0) CHECK(drift < .1 * before);
            before = drift;
        }
    }
}

TEST_CASE("A chain that floats keeps its momentum and its angular momentum")
{
    Scene s(level_chain(tight("Articulated"), 10, "Ball", false), dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const auto momenta = [&]
    {
        std::array<Vec3, 2> sum{};
        for (int i = 0; i < 10; ++i)
        {
            const Quat q = s.quat(link_id(i), "orientation");
            const Vec3 w = rotate_back(q, s.vec(link_id(i), "angular_velocity")), v = s.vec(link_id(i), "linear_velocity");
            sum[0] += v;
            sum[1] += rotate(q, Vec3{.0004 * w.x, .02 * w.y, .0202 * w.z}) + cross(s.vec(link_id(i), "position"), v);
        }
        return sum;
    };
    s.step();  // the first step makes the speeds fit the joints
    const auto before = momenta();
    s.run(3);
    const auto after = momenta();
    CHECK(length(before[1]) > .05);
    CHECK(length(after[0] - before[0]) < 1e-8);
    CHECK(length(after[1] - before[1]) < 1e-8);
}

TEST_CASE("The solver is swapped in and out of a moving chain, and the motion goes on")
{
    Scene s(level_chain(tight("DormandPrince54"), 12, "Hinge"), dt(240)),
        alone(level_chain(tight("DormandPrince54"), 12, "Hinge"), dt(240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    for (const std::string type : {"Articulated", "DormandPrince54", "Articulated"})
    {
        s.step(30), alone.step(30);
        std::vector<double> before;
        for (int i = 0; i < 12; ++i) before.push_back(s.vec(link_id(i), "position").z);
        REQUIRE(s.ask(SwapOperation{"solver", "Solver/" + type, {}}).done);
        for (int i = 0; i < 12; ++i) CHECK(s.vec(link_id(i), "position").z == before[static_cast<std::size_t>(i)]);
    }
    s.step(30), alone.step(30);
    for (int i = 0; i < 12; ++i) CHECK(length(s.vec(link_id(i), "position") - alone.vec(link_id(i), "position")) < 1e-8);
}

TEST_CASE("What is no tree of lower pairs stays with its rows, bit for bit, and the reason is told")
{
    const std::string loop = joint("loop", "Ball", "", "r", "anchor='1.5 0.6 0.2'");
    const std::string limit = joint("limit", "Motor", "", "p", "axis='0.6 0.8 0' speed='1'");
    const std::string rod = joint("rod", "Distance", "t", "s", "");
    for (const auto& [more, reason] : {std::pair{loop, "loop"}, std::pair{limit, "motor"}, std::pair{rod, "degrees of freedom"}})
    {
        CAPTURE(reason);
        Scene minimal(mixed_tree(tight("Articulated"), more), dt(240)), rows(mixed_tree(tight("DormandPrince54"), more), dt(240));
        REQUIRE_MESSAGE(minimal.loaded(), minimal.error());
        minimal.keep_events = minimal.warnings_expected = rows.warnings_expected = true;
        minimal.step(20), rows.step(20);
        CHECK(minimal.count("solver.fell_back") == 1);
        const auto told = [&](const Event& e) { return e.message.find(reason) != std::string::npos; };
        CHECK(std::any_of(minimal.events.begin(), minimal.events.end(), told));
        for (const std::string id : {"p", "q", "r", "s"}) CHECK(minimal.vec(id, "position") == rows.vec(id, "position"));
    }
}

TEST_CASE("Any number of threads, the same bits")
{
    std::string scene = level_chain(solver_is("Articulated"), 20, "Ball") + body("z", 1, {1, 1, 1}, {0, 9, 0});
    Scene one(scene, dt(240), 1), four(scene, dt(240), 4);
    REQUIRE_MESSAGE(one.loaded(), one.error());
    one.step(100), four.step(100);
    CHECK(one.hash() == four.hash());
}

TEST_CASE("One internal step per step: the error falls with the fifth power of the step")
{
    const auto end_after = [](const std::string& solver, int per_second)
    {
        Scene s(level_chain(solver, 3, "Ball"), dt(per_second));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(.5);
        return s.vec(link_id(2), "position");
    };
    const Vec3 exact = end_after(tight("Articulated", "1e-13"), 240);
    std::vector<double> errors;
    for (const int per_second : {80, 160, 320}) errors.push_back(distance(end_after(tight("Articulated", "1e3"), per_second), exact));
    CAPTURE(errors[0]);
    CAPTURE(errors[1]);
    CAPTURE(errors[2]);
    CHECK(errors[0] > 1e-9);
    for (const std::size_t i : {0u, 1u}) CHECK(std::log2(errors[i] / errors[i + 1]) == doctest::Approx(5).epsilon(.12));
}

TEST_CASE("A pendulum's hinge carries the centripetal force and the weight that it does not yield to")
{
    Scene s(pendulum(tight("Articulated"), "Hinge"), dt(240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    for (int i = 0; i < 5; ++i)
    {
        s.step(60);
        const Vec3 r = s.vec("bob", "position"), w = s.vec("bob", "angular_velocity"), weight{0, 0, -3 * 9.81};
        const Vec3 turn = (1 / 1.5) * cross(r, weight);  // 1.5 kg m^2 about the pivot
        const Vec3 acceleration = cross(turn, r) + cross(w, cross(w, r));
        CHECK(length(s.vec("j", "force") - (3 * acceleration - weight)) < 1e-7);
    }
}

TEST_CASE("Reactions of all kinds of joints agree with the multipliers of their rows")
{
    Scene minimal(mixed_tree(tight("Articulated")), dt(240)), rows(mixed_tree(tight("DormandPrince54")), dt(240));
    REQUIRE_MESSAGE(minimal.loaded(), minimal.error());
    minimal.step(60), rows.step(60);
    for (const std::string id : {"j1", "j2", "j3", "j4", "j5"})
    {
        CAPTURE(id);
        CHECK(length(rows.vec(id, "force")) > 1e-2);
        CHECK(length(minimal.vec(id, "force") - rows.vec(id, "force")) < 1e-5);
        CHECK(length(minimal.vec(id, "torque") - rows.vec(id, "torque")) < 1e-5);
    }
}

TEST_CASE("A chain of 20 hinges that whips for 10 s keeps its energy")
{
    Scene s(level_chain(tight("Articulated", "1e-10"), 20, "Hinge"), dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(10);
    const double drift = std::fabs(energy(s, 20)) / (9.81 * 100);
    CAPTURE(drift);
    CHECK(drift < 1e-7);
    for (int i = 0; i < 20; ++i) CHECK(s.real("j" + link_id(i), "position_error") < 1e-13);
}

TEST_CASE("A restored snapshot goes on with the same bits, and a warm step allocates nothing")
{
    Scene whole(level_chain(solver_is("Articulated"), 20, "Ball"), dt(240)), again(solver_is("Articulated") + body("x", 1, {1, 1, 1}, {}));
    REQUIRE_MESSAGE(whole.loaded(), whole.error());
    whole.step(50);
    const Snapshot middle = whole.simulation().capture();
    whole.step(50);
    REQUIRE(again.simulation().restore(middle).ok());
    again.step(50);
    CHECK(again.hash() == whole.hash());
    const long now = allocations;
    whole.simulation().step();
    CHECK(allocations == now);
}
