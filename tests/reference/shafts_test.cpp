// Gears: reduced coordinates, pairwise impulses, one-way copies. F1.. as in the catalogue of reference problems.
#include <algorithm>

#include "reference/shafts.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("F1: a pair accelerates with its reflected inertia")
{
    for (const char* type : {"Graph", "Impulse"})
    {
        CAPTURE(type);
        Scene s(shaft("a", 10) + shaft("b", 100) + gear("g", type, "a", "b", "-0.1") + torque("a", "6"), "dt=\"1/100\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        CHECK(near(s.spin("a"), 6.0 / 11, 1e-13));
        CHECK(near(s.spin("b"), -0.6 / 11, 1e-13));
        CHECK(near(s.angle("a"), 3.0 / 11, 1e-13));
        CHECK(near(s.real("g", "torque"), -100 * 0.6 / 11, 1e-13));
    }
}

TEST_CASE("F1, one way: an assigned shaft follows and does not affect the driver")
{
    Scene s(shaft("a", 10) + shaft("b", 100) + gear("g", "Assign", "a", "b", "-0.1") + torque("a", "6"), "dt=\"1/100\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    CHECK(near(s.spin("a"), 0.6, 1e-13));
    CHECK(near(s.spin("b"), -0.06, 1e-13));
    CHECK(near(s.angle("b"), -0.03, 1e-13));
}

TEST_CASE("F2: six meshes of 10:1, both ways")
{
    Scene down(six_meshes("Graph", "0.1"), "dt=\"1/100\""), up(six_meshes("Graph", "10"), "dt=\"1/100\"");
    REQUIRE_MESSAGE(down.loaded(), down.error());
    down.run(1), up.run(1);
    CHECK(std::fabs(down.spin("s0") * inertia_from(0, 0.1) - 1) < 2e-14);
    CHECK(std::fabs(up.spin("s0") * inertia_from(0, 10) - 1) < 2e-14);
    CHECK(std::fabs(up.spin("s6") / up.spin("s0") / 1e6 - 1) < 1e-14);
}

TEST_CASE("F3: sudden engagement at run time shares the momentum")
{
    Scene s(shaft("a", 1, 100) + shaft("b", 2), "dt=\"1/100\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double before = s.simulation().totals().kinetic;
    const auto compiled =
        test::compile_text(test::whole_scene(gear("g", "Graph", "a", "b", "-0.5")), "add.xml", &s.simulation().world().scene());
    REQUIRE_MESSAGE(compiled.ok(), test::reasons(compiled));
    const auto reply = s.ask(simulation::AddOperation{*compiled});
    REQUIRE_MESSAGE(reply.done, test::first_error(reply.errors));
    s.step();
    CHECK(near(s.spin("a"), 200.0 / 3, 1e-14));
    CHECK(near(s.spin("b"), -100.0 / 3, 1e-14));
    CHECK(near(s.simulation().totals().kinetic - before, -5000.0 / 3, 1e-13));
}

TEST_CASE("F4: a consistent loop and fifty duplicate meshes are redundant, counted, and change nothing")
{
    const std::string three =
        shaft("a", 1) + shaft("b", 2) + shaft("c", 3) + gear("g1", "Graph", "a", "b", "2") + gear("g2", "Graph", "b", "c", "3");
    std::string loop = three + gear("g3", "Graph", "c", "a", "1/6");
    for (int i = 0; i < 50; ++i) loop += gear("h" + std::to_string(i), "Graph", "a", "b", "2");
    Scene tree(three + torque("a", "5")), ring(loop + torque("a", "5"));
    REQUIRE_MESSAGE(ring.loaded(), ring.error());
    CHECK(ring.simulation().stepper().graph().redundant().size() == 51);
    tree.run(1), ring.run(1);
    CHECK(ring.spin("c") == tree.spin("c"));
    CHECK(near(ring.spin("a"), 5.0 / (1 + 4 * 2 + 36 * 3), 1e-13));
}

TEST_CASE("F5: a contradictory loop is refused with its edges and product")
{
    const std::string ring = shaft("a", 1) + shaft("b", 2) + shaft("c", 3) + gear("g1", "Graph", "a", "b", "2") +
                             gear("g2", "Graph", "b", "c", "3") + gear("g3", "Graph", "c", "a", "0.16666388893518441");
    const std::string error = Scene(ring).error();
    CHECK(error.find("g1") != std::string::npos);
    CHECK(error.find("g2") != std::string::npos);
    CHECK(error.find("g3") != std::string::npos);
    CHECK(error.find("0.99998") != std::string::npos);
}

namespace
{

/// The only event of a kind; it must occur exactly once however long the scene runs.
Event only(const Scene& s, const std::string& kind)
{
    REQUIRE(s.count(kind) == 1);
    return *std::find_if(s.events.begin(), s.events.end(), [&](const Event& e) { return e.kind == kind; });
}
std::string prescribed(const std::string& id, double speed)
{
    return "<component id=\"" + id + "\" type=\"State/Shaft\" inertia=\"1\" prescribed=\"true\" angular_velocity=\"" +
           std::to_string(speed) + "\"/>";
}

}  // namespace

TEST_CASE("F5 with Impulse: a contradictory loop reports that once, whether it brakes to a stop or can hardly move")
{
    struct Loop
    {
        std::string parts, closes, product;
        double left;  // of the speed of 1 at the end
    };
    const std::string three = shaft("a", 1, 1) + shaft("b", 2, 2) + shaft("c", 3, 6) + gear("g1", "Impulse", "a", "b", "2") +
                              gear("g2", "Impulse", "b", "c", "3");
    const Loop loops[] = {
        {three + gear("g3", "Impulse", "c", "a", "0.16666388893518441"), "g3", "0.99998", 2},
        {three + gear("g0", "Graph", "c", "a", "0.2"), "g2", "1.2", 1e-9},
        {shaft("a", 1, 1) + shaft("b", 2, 2) + gear("g1", "Impulse", "a", "b", "2") + gear("g2", "Impulse", "a", "b", "-3"), "g2", "1.5",
         1e-9}};
    for (const Loop& loop : loops)
    {
        CAPTURE(loop.parts);
        Scene s(loop.parts);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.run(1);
        CHECK(s.count("coupling.not_converged") == 0);
        const Event e = only(s, "constraint.contradiction");
        CHECK(e.component == s.simulation().world().find(loop.closes));
        CHECK(e.message.find("contradiction: the loop g") != std::string::npos);
        CHECK(e.message.find("change a factor or remove one of them") != std::string::npos);
        CHECK(e.values.size() == 2);
        CHECK(std::fabs(s.spin("a")) < loop.left);
    }
}

TEST_CASE("an Impulse between prescribed shafts that disagree reports that, and again when it recurs")
{
    Scene s(prescribed("a", 10) + prescribed("b", 20) + gear("g", "Impulse", "a", "b", "3"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    s.run(1);
    const Event e = only(s, "constraint.contradiction");
    CHECK(e.component == s.simulation().world().find("g"));
    CHECK(e.message.find("an error of 10 rad/s remains") != std::string::npos);
    CHECK(s.spin("b") == 20);
    const auto set = [&](double factor)
    {
        const auto reply = s.ask(simulation::SetOperation{"g", "velocity_factor", factor});
        REQUIRE_MESSAGE(reply.done, test::first_error(reply.errors));
        s.run(s.simulation().time() + 0.1);
    };
    set(2);
    CHECK(s.count("constraint.contradiction") == 1);
    set(3);
    CHECK(s.count("constraint.contradiction") == 2);
}

TEST_CASE("a train too long for the sweeps of Impulse reports that once and names the better type; one that converges reports nothing")
{
    const auto train = [](int n)
    {
        std::string parts;
        for (int i = 0; i < n; ++i) parts += shaft("s" + std::to_string(100 + i), 1, i == 0 ? 100 : 0);
        for (int i = 0; i + 1 < n; ++i)
            parts += gear("g" + std::to_string(100 + i), "Impulse", "s" + std::to_string(100 + i), "s" + std::to_string(101 + i), "-1");
        return parts;
    };
    Scene s(train(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    s.run(0.2);
    const Event e = only(s, "coupling.not_converged");
    CHECK(e.message.find("after 1000 sweeps") != std::string::npos);
    CHECK(e.message.find("Constraint/AngularVelocity/Graph") != std::string::npos);
    REQUIRE(e.values.size() == 2);
    CHECK(e.values[1] > 1e-9);
    Scene fine(train(10));
    REQUIRE_MESSAGE(fine.loaded(), fine.error());
    fine.run(0.2);
    CHECK(fine.count("coupling.not_converged") == 0);
}

TEST_CASE("F7: a line of 1000 gears has no drift at all")
{
    const GearLine line(1000, "Graph");
    Scene s(line.parts, "dt=\"1/100\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(2000);
    const auto& world = s.simulation().world();
    for (int i = 0; i < 1000; ++i)
        CHECK(std::fabs(world.host().shafts.ratio[world.component(world.find(GearLine::id(i))).host_index] /
                            line.ratios[static_cast<std::size_t>(i)] -
                        1) < 1e-12);
    CHECK(GearLine::drift(s) == 0);
    CHECK(line.phase(s) < 1e-12);
}
