// Governor/Budget and Governor/Error: what they learn, and how they spend.
#include <memory>

#include "simulation/governed.h"
#include "support/text.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::count_at;
using plab::test::has;
using plab::test::kLadder;
using plab::test::level;
using plab::test::measure;
using plab::test::Scene;
using plab::test::springs_under_budget;

TEST_CASE("a budget: trial steps tell what levels cost and how they err, so the first measured step is enough to leave out a bad one")
{
    Scene s(springs_under_budget(6, ""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    CHECK(count_at(s, 0) == 6);
    const auto errors = std::get<Reals>(s.get("lod", "errors"));
    REQUIRE(errors.size() == 3 * 6);  // of a component that acts on one object, for each level that it may have; first the cheapest one
    CHECK(errors[0] == 1);
    CHECK(errors[1] == 0);
    CHECK(errors[2] == 3);               // trials
    CHECK(errors[3] > 1e4 * errors[4]);  // mean squares
    measure(s, "step_cost", Value(1e-4)), measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 9e-4}));
    s.step();
    CHECK(count_at(s, 1) == 6);  // hardly dearer; the most exact one would take 0.9 ms for each of them
    const LevelInfo told = level(s.simulation().levels().levels(), s, "bob.0.solver");
    CHECK(has(told.reason, "there is room: a step takes 0.1 ms of 1 ms; error "));
    REQUIRE(told.trials.size() == 3);
    CHECK(told.trials[0].text == "Solver/SemiImplicitEuler");
    CHECK(told.trials[0].error.distance > 10 * told.trials[1].error.distance);
}

TEST_CASE("a budget: errors up to the tolerance are not worth a second")
{
    Scene s(springs_under_budget(6, "tolerance=\"1e6\""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    measure(s, "step_cost", Value(1e-5)), measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 2e-6}));
    s.run(1);
    CHECK(count_at(s, 0) == 6);
}

TEST_CASE("a budget: exchanges cost time too, so they are spread over steps that have time for them")
{
    Scene s(springs_under_budget(12, "trials=\"0\""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    measure(s, "every", Value(10.0));
    s.step();
    measure(s, "step_cost", Value(4.5e-4)), measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 9e-4}));
    measure(s, "exchange_cost", Value(Reals{1, 2e-4}));  // taken for 0.1 ms and 0.1 ms for each component; 0.55 ms are left
    for (const std::ptrdiff_t done : {4, 8, 12})
    {
        s.step();
        CHECK(count_at(s, 1) == done);
        s.step(4);  // until it is known what the steps cost with these
        CHECK(count_at(s, 1) == done);
    }
}

TEST_CASE("a budget: the step of an exchange has to have time for the finer levels too")
{
    Scene s(springs_under_budget(12, "trials=\"0\""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    measure(s, "step_cost", Value(3e-4)), measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 4e-5}));
    measure(s, "exchange_cost", Value(Reals{1, 2e-4}));
    s.step();
    // 0.7 ms are left; an exchange takes 0.1 ms and 0.1 ms for each component, whose steps take 39 us longer.
    CHECK(count_at(s, 2) > 0);
    CHECK(count_at(s, 2) <= 4);
}

TEST_CASE("a budget: exchanges for which no step has time are made all at once, but rarely")
{
    Scene s(springs_under_budget(12, "trials=\"0\""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    measure(s, "step_cost", Value(5e-4)), measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 9e-4}));
    measure(s, "exchange_cost", Value(Reals{12, 6e-3}));
    s.step();
    CHECK(count_at(s, 1) == 12);
    for (const char* id : {"bob.0.solver", "bob.5.solver"}) REQUIRE(s.ask(SwapOperation{id, "Solver/SemiImplicitEuler", {}}).done);
    s.step(120);
    CHECK(count_at(s, 0) == 2);
    s.step(20);
    CHECK(count_at(s, 1) == 12);
    // While steps take too long anyway, the cheaper level comes at once.
    measure(s, "budget", Value(4e-4));
    s.step(13);
    CHECK(count_at(s, 0) == 12);
}

TEST_CASE("an error: what has not been measured yet has the most exact level until its turn comes")
{
    std::string scene = springs_under_budget(12, "");
    scene = scene.substr(0, scene.rfind("<component id=\"lod\"")) +
            "<component id=\"lod\" type=\"Governor/Error\" watches=\"*.solver\" levels=\"" + kLadder +
            "\" bound=\"10\" looks=\"4\" every=\"1\" interval=\"1\" dwell=\"0\"/>";
    Scene s(scene);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    CHECK(count_at(s, 0) == 4);
    CHECK(count_at(s, 2) == 8);
    s.step(240);
    CHECK(count_at(s, 0) == 8);
    CHECK(count_at(s, 2) == 4);
    s.step(480);  // two of four measurements of a look are for promises that are due
    CHECK(count_at(s, 0) == 12);
}

TEST_CASE("an error: with a limit of trial steps a sample is measured, and all get the level that it keeps the bound with")
{
    constexpr int kCount = 60, kSteps = 12 * 40;
    const auto run = [&](const char* bound)
    {
        std::string scene = springs_under_budget(kCount, "");
        scene = scene.substr(0, scene.rfind("<component id=\"lod\"")) +
                "<component id=\"lod\" type=\"Governor/Error\" watches=\"*.solver\" levels=\"" + kLadder +
                "\" looks=\"60\" every=\"0.05\" dwell=\"0\" share=\"0.25\" bound=\"" + bound + "\"/>";
        auto s = std::make_unique<Scene>(scene);
        REQUIRE_MESSAGE(s->loaded(), s->error());
        s->step();
        // 60 components in 12 steps, of which a quarter: 180 trial steps, in trials of 15 steps for each of two levels or three.
        const auto measured = std::get<std::int64_t>(s->get("lod", "measured"));
        CHECK(measured > 0);
        CHECK(measured < 20);
        CHECK(count_at(*s, 2) == kCount);  // nothing is known yet, and those that are sampled get what the others get, or better
        s->step(kSteps);
        return s;
    };
    const auto loose = run("10"), tight = run("1e-13");
    CHECK(count_at(*loose, 0) == kCount);
    CHECK(count_at(*tight, 2) == kCount);
    // Each measured error takes trials of at most two levels.
    CHECK(std::get<std::int64_t>(loose->get("lod", "measured")) * 15 < 0.25 * kCount * kSteps * 1.5);
    CHECK(loose->real("lod", "confidence") > 0.95);
    CHECK(loose->real("lod", "patience") > 4);  // 2 % longer with each promise that was kept
}

TEST_CASE("an error: what a coupling errs is what it makes of the interval, whichever of the two the gears have")
{
    // Graph feels the inertia of what it drives, 4 + 2^2 0.5 kg m^2, and Assign does not: 0.5 and 0.75 rad/s^2.
    constexpr double kInterval = 0.25, kDifference = 2 * 0.5 * 0.25 * kInterval * kInterval;
    for (const char* present : {"Assign", "Graph"})
    {
        Scene s(std::string("<component id=\"motor\" type=\"State/Shaft\" inertia=\"4\" angular_velocity=\"2\"/>"
                            "<component id=\"second\" type=\"State/Shaft\" inertia=\"0.5\" angular_velocity=\"-4\"/>"
                            "<component id=\"gear\" type=\"Constraint/AngularVelocity/") +
                present +
                "\" driver=\"motor\" driven=\"second\" velocity_factor=\"-2\"/>"
                "<component id=\"torque\" type=\"Field/Load\" between=\"motor\" shaft_torque=\"3\"/>");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);  // far from where the gears engaged
        auto& simulation = s.simulation();
        const Level assign{"Constraint/AngularVelocity/Assign", {}, ""}, graph{"Constraint/AngularVelocity/Graph", {}, ""};
        const std::uint64_t before = s.hash();
        const LevelError told = simulation.try_level(simulation.world().find("gear"), assign, graph, kInterval);
        CHECK_MESSAGE(told.angle == doctest::Approx(kDifference).epsilon(0.05), present);
        CHECK(s.hash() == before);
    }
}

TEST_CASE("an error: what a quarter of the interval tells of a solver is near what the whole interval shows")
{
    // A stiff spring, whose mass swings two and a half times in the interval, and a soft one that hardly moves.
    for (const char* stiffness : {"4000", "40", "1"})
    {
        const auto scene = [&](const char* solver)
        {
            return std::string(
                       "<component id=\"post\" type=\"State/Static\"/><component id=\"bob\" type=\"State/RigidBody\" mass=\"1\" "
                       "inertia=\"1 1 1\" position=\"1.5 0 0\" linear_velocity=\"0 2 0\" solver=\"Solver/") +
                   solver + "\"/><component id=\"spring\" type=\"Constraint/SpringDamper\" a=\"post\" b=\"bob\" length=\"1\" stiffness=\"" +
                   stiffness + "\"/>";
        };
        Scene cheap(scene("SemiImplicitEuler")), fine(scene("RungeKutta4"));
        REQUIRE_MESSAGE(cheap.loaded(), cheap.error());
        const Level euler{"Solver/SemiImplicitEuler", {}, ""}, runge_kutta{"Solver/RungeKutta4", {}, ""};
        auto& simulation = cheap.simulation();
        const auto tell = [&](double interval)
        { return simulation.try_level(simulation.world().find("bob.solver"), euler, runge_kutta, interval).distance; };
        const double told = tell(0.25), told_of_eight = tell(8.0 / 240);
        double largest = 0;
        for (int k = 0; k < 60; ++k)
        {
            cheap.step(), fine.step();
            largest = std::max(largest, test::distance(cheap.vec("bob", "position"), fine.vec("bob", "position")));
            if (k == 7) CHECK(told_of_eight / largest == doctest::Approx(1).epsilon(1e-6));  // all of these steps are tried
        }
        CHECK_MESSAGE(told > 0.9 * largest, stiffness);
        CHECK_MESSAGE(told < 5 * largest, stiffness);
    }
}

TEST_CASE("an error: a trial ends in the step in which the courses depart further than whoever asks needs to know")
{
    const auto scene = [](const char* solver)
    {
        return std::string(
                   "<component id=\"post\" type=\"State/Static\"/><component id=\"bob\" type=\"State/RigidBody\" mass=\"1\" "
                   "inertia=\"1 1 1\" position=\"1.5 0 0\" linear_velocity=\"0 2 0\" solver=\"Solver/") +
               solver +
               "\"/><component id=\"spring\" type=\"Constraint/SpringDamper\" a=\"post\" b=\"bob\" length=\"1\" stiffness=\"400\"/>";
    };
    Scene cheap(scene("SemiImplicitEuler")), fine(scene("RungeKutta4"));
    REQUIRE_MESSAGE(cheap.loaded(), cheap.error());
    const Level euler{"Solver/SemiImplicitEuler", {}, ""}, runge_kutta{"Solver/RungeKutta4", {}, ""};
    auto& simulation = cheap.simulation();
    const std::uint32_t bob = simulation.world().find("bob.solver");
    const std::uint64_t before = cheap.hash();
    const auto tell = [&](double enough) { return simulation.try_level(bob, euler, runge_kutta, 0.25, {enough, NAN, NAN}).distance; };
    const double all = tell(NAN), first = tell(0), much = tell(1e3);
    CHECK(cheap.hash() == before);
    CHECK(much == all);
    cheap.step(), fine.step();
    const double departure = test::distance(cheap.vec("bob", "position"), fine.vec("bob", "position"));
    CHECK(first == doctest::Approx(60 * departure).epsilon(1e-9));  // one of 60 steps was made
    CHECK(std::fabs(first / all - 1) > 0.01);
}

TEST_CASE("an error: an impact within the interval is foreseen, though the coming step shows nothing of it")
{
    // Falls from 0.05 m, so it meets the ground after 0.1 s: without a resolution it sinks in by up to what it falls in a step.
    const auto level_of_ball = [](const char* interval)
    {
        Scene s(std::string("<component id=\"floor\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"floor\"/>"
                            "<component id=\"form\" type=\"Shape/Sphere\" radius=\"0.1\"/>"
                            "<component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" shape=\"form\" position=\"0 0 0.15\" "
                            "linear_velocity=\"0 0 -1\"/><component id=\"weight\" type=\"Field/Gravity\" between=\"ball\"/>"
                            "<component id=\"contact\" type=\"CDetection/ODE\" between=\"ball ground\" resolution=\"Resolution/None\" "
                            "response=\"Response/Impulse\" response.restitution=\"0.8\" response.friction=\"0\"/>"
                            "<component id=\"lod\" type=\"Governor/Error\" watches=\"*resolution\" bound=\"1e-4\" every=\"1\" "
                            "levels=\"Resolution/None; Resolution/LocalBisection\" interval=\"") +
                interval + "\"/>");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step();
        const auto levels = s.simulation().levels().levels();
        REQUIRE(levels.size() == 1);
        return levels.front().level;
    };
    CHECK(level_of_ball("0.02") == 0);
    CHECK(level_of_ball("0.1") == 1);
}

TEST_CASE("an error: a trial makes 256 steps at most, so what comes later is not foreseen, however long the interval")
{
    // Moves at 1 m/s and meets the ground in step 240, or in step 288.
    for (const double height : {1.1, 1.3})
    {
        Scene s(
            "<component id=\"floor\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"floor\"/>"
            "<component id=\"form\" type=\"Shape/Sphere\" radius=\"0.1\"/>"
            "<component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" shape=\"form\" position=\"0 0 " +
                std::to_string(height - 1e-3) +
                "\" linear_velocity=\"0 0 -1\"/>"
                "<component id=\"contact\" type=\"CDetection/ODE\" between=\"ball ground\" resolution=\"Resolution/None\" "
                "response=\"Response/Impulse\" response.restitution=\"0.8\" response.friction=\"0\"/>",
            "dt=\"1/240\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        auto& simulation = s.simulation();
        const Level none{"Resolution/None", {}, ""}, located{"Resolution/LocalBisection", {}, ""};
        const LevelError told = simulation.try_level(simulation.world().find("contact.resolution"), none, located, 2.0);
        CHECK((told.distance > 1e-6) == (height < 1.2));
    }
}

TEST_CASE("a budget: while steps take too long a level is given up at once, however long it was to be kept")
{
    Scene s(springs_under_budget(12, "trials=\"0\""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    measure(s, "dwell", Value(10.0));
    s.step();
    measure(s, "step_cost", Value(5e-4)), measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 9e-4}));
    s.step();
    CHECK(count_at(s, 1) == 12);
    measure(s, "budget", Value(4e-4));
    s.step(13);
    CHECK(count_at(s, 0) == 12);
}

TEST_CASE("a budget: where 99 of 100 steps take up to 2.2 times what is usual, the usual one costs half of the budget")
{
    for (const double spread : {1.0, 2.2})
    {
        Scene s(springs_under_budget(12, "trials=\"0\""));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step();
        measure(s, "step_cost", Value(3e-4)), measure(s, "spread", Value(spread));
        measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 4e-5}));
        s.step();
        // The most exact level costs 39 us more for each of them; 625 us are left for that, or 162 us.
        if (spread == 1)
            CHECK(count_at(s, 2) == 12);
        else
            CHECK(count_at(s, 2) <= 4);
        CHECK(count_at(s, 2) > 0);
    }
}

TEST_CASE("a budget: what was chosen is given up at once if the next steps show that it costs too much, and before the next look")
{
    Scene s(springs_under_budget(12, "trials=\"0\""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    measure(s, "step_cost", Value(3e-4)), measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 4e-5}));
    s.step();
    CHECK(count_at(s, 2) == 12);
    CHECK(s.real("lod", "cost") > 6e-4);  // 0.77 ms, until it is measured
    measure(s, "every", Value(10.0)), measure(s, "dwell", Value(10.0));
    s.step(4);
    CHECK(count_at(s, 2) == 12);
    measure(s, "step_cost", Value(1.5e-3));  // instead of 0.77 ms
    s.step();
    CHECK(count_at(s, 2) < 12);
}

TEST_CASE("a budget: one level is tried at a boundary, and where no step has time for that only rarely")
{
    Scene s(springs_under_budget(12, "trials=\"100\" tolerance=\"1e6\""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    const auto trials = [&] { return std::get<Reals>(s.get("lod", "errors"))[2]; };
    CHECK(trials() == 3);  // before the first step
    measure(s, "every", Value(10.0));
    measure(s, "step_cost", Value(5e-4)), measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 4e-5}));
    s.step();  // a look
    s.step();
    CHECK(std::get<Reals>(s.get("lod", "partial")).size() == 2);  // one of two levels below the most exact one
    CHECK(trials() == 3);
    s.step();
    CHECK(trials() == 4);
    measure(s, "trial_time", Value(Reals{1, 4e-4, 5e-4}));  // 0.4 ms, and the step after it was a usual one: it fits
    s.step(4);
    CHECK(trials() == 6);
    measure(s, "trial_time", Value(Reals{2, 4e-4, 9e-4}));  // 0.4 ms for each, with what the step after them was longer
    s.step(4);
    CHECK(trials() == 8);
    measure(s, "trial_time", Value(Reals{1, 4e-4, 9e-4}));  // 0.8 ms do not fit
    s.step(128);
    CHECK(std::get<Reals>(s.get("lod", "partial")).size() == 2);
    CHECK(trials() == 8);
    s.step();
    CHECK(trials() == 9);
}

TEST_CASE("an error: each time is looked at, however long the time between two looks was to be")
{
    std::string scene = springs_under_budget(12, "");
    scene = scene.substr(0, scene.rfind("<component id=\"lod\"")) +
            "<component id=\"lod\" type=\"Governor/Error\" watches=\"*.solver\" levels=\"" + kLadder +
            "\" bound=\"10\" looks=\"4\" every=\"1\" interval=\"0.25\" dwell=\"0\"/>";
    Scene s(scene);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    for (const std::ptrdiff_t measured : {4, 8, 12})
    {
        s.step();
        CHECK(count_at(s, 0) == measured);
        s.step(59);
        CHECK(count_at(s, 0) == measured);
    }
}

TEST_CASE("an error: half of the measurements of a look are for promises that are due, while others wait to be measured at all")
{
    std::string scene = springs_under_budget(12, "");
    scene = scene.substr(0, scene.rfind("<component id=\"lod\"")) +
            "<component id=\"lod\" type=\"Governor/Error\" watches=\"*.solver\" levels=\"" + kLadder +
            "\" bound=\"10\" looks=\"4\" every=\"0.25\" interval=\"0.25\" dwell=\"0\"/>";
    Scene s(scene);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    measure(s, "patience", Value(1.0));  // promises are judged at the next look
    s.step();
    CHECK(count_at(s, 0) == 4);
    s.step(60);
    CHECK(std::get<std::int64_t>(s.get("lod", "judged")) == 2);
    CHECK(count_at(s, 0) == 6);
}

TEST_CASE("an error: where promises of many are broken at the same time no other one is trusted, and they count as one")
{
    constexpr int kCount = 40;
    std::string scene = springs_under_budget(kCount, "");
    scene = scene.substr(0, scene.rfind("<component id=\"lod\"")) +
            "<component id=\"lod\" type=\"Governor/Error\" watches=\"*.solver\" levels=\"" + kLadder +
            "\" bound=\"0.05\" looks=\"16\" every=\"0.05\" interval=\"0.25\" dwell=\"0\"/>";
    Scene s(scene);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(200);
    REQUIRE(count_at(s, 0) == kCount);
    const double safety = s.real("lod", "safety"), patience = s.real("lod", "patience");
    const auto judged = std::get<std::int64_t>(s.get("lod", "judged")), held = std::get<std::int64_t>(s.get("lod", "held"));
    for (int k = 0; k < kCount; ++k) REQUIRE(s.ask(SetOperation{"spring." + std::to_string(k), "stiffness", Value(4e4)}).done);
    s.keep_events = true;
    s.step(5);  // to the next look and over it
    const auto broken = std::get<std::int64_t>(s.get("lod", "judged")) - judged - (std::get<std::int64_t>(s.get("lod", "held")) - held);
    CHECK(broken > 1);
    CHECK(broken <= 16);
    CHECK(count_at(s, 0) == 0);
    CHECK(s.real("lod", "safety") < 1.3 * std::max(1.0, safety));
    CHECK(s.real("lod", "patience") == doctest::Approx(std::max(1.0, 0.5 * patience)).epsilon(0.4));
}
