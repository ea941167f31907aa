// Numbers with rates: what a solver makes of declared state whose derivatives scripts give.
#include "support/scene.h"

using namespace plab;
using plab::test::distance;
using plab::test::Scene;

namespace
{

Reals values(Scene& s, const std::string& id)
{
    return std::get<Reals>(s.simulation().world().get(s.simulation().world().find(id), "values"));
}

/// z1' = z2, z2' = -z1 from (1, 0), to t = 2.
double oscillator_error(int per_second)
{
    Scene s(R"(<component id="z" type="State/Quantities" values="1 0"><component id="s" type="Solver/RungeKutta4"/></component>
               <component id="law" type="Script/Lua" between="z"><param name="code">
               function force(t, state)
                   local z = between[1]
                   z:add_rate(1, z:value(2))
                   z:add_rate(2, -z:value(1))
               end</param></component>)",
            "dt=\"1/" + std::to_string(per_second) + "\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    const Reals z = values(s, "z");
    return std::hypot(z[0] - std::cos(2.0), z[1] + std::sin(2.0));
}

}  // namespace

TEST_CASE("an oscillator of two quantities, fourth order")
{
    const double coarse = oscillator_error(20), fine = oscillator_error(40);
    CHECK(fine < 1e-7);
    CHECK(std::log2(coarse / fine) == doctest::Approx(4).epsilon(0.02));
}

TEST_CASE("a quantity and a body that affect each other advance as one group, at the same stages")
{
    // Thrust T = 3 z while fuel burns: z' = -z/2, v' = 3 z: v = 6 (1 - e^{-t/2}), x = 6 t - 12 (1 - e^{-t/2}).
    const auto error = [](int per_second)
    {
        Scene s(R"(<component id="fuel" type="State/Quantities" values="1"/>
                   <component id="rocket" type="State/RigidBody" mass="1" inertia="1 1 1"/>
                   <component id="engine" type="Script/Lua" driven="rocket" between="fuel"><param name="code">
                   function force(t, state)
                       local z = between[1]:value(1)
                       between[1]:add_rate(1, -z / 2)
                       driven:add_force(vec(3 * z, 0, 0))
                   end</param></component>)",
                "dt=\"1/" + std::to_string(per_second) + "\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(2);
        const double burnt = 1 - std::exp(-1.0);
        return distance(s.vec("rocket", "position"), {12 - 12 * burnt, 0, 0}) + std::fabs(values(s, "fuel")[0] - std::exp(-1.0));
    };
    const double coarse = error(10), fine = error(20);
    CHECK(fine < 1e-7);
    CHECK(std::log2(coarse / fine) == doctest::Approx(4).epsilon(0.05));
}

TEST_CASE("a wrong use of quantities by a script fails with a message that says what would be right")
{
    const auto failure = [](const std::string& line)
    {
        Scene s(R"(<component id="z" type="State/Quantities" values="1 0"/>
                   <component id="law" type="Script/Lua" between="z"><param name="code">function force(t, state) )" +
                line + " end</param></component>");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true, s.keep_events = true;
        s.step();
        return s.events.empty() ? std::string() : s.events.front().message;
    };
    CHECK(failure("between[1]:add_rate(3, 1)").find("values 1 to 2") != std::string::npos);
    CHECK(failure("between[1]:add_force(vec(1, 0, 0))").find("add_rate") != std::string::npos);
    CHECK(failure("between[1]:add_rate(1, 0/0)").find("not finite") != std::string::npos);
    CHECK(failure("local x = between[1].position").find("quantities have count") != std::string::npos);
}

TEST_CASE("quantities need a number")
{
    Scene s(R"(<component id="z" type="State/Quantities" values=""/>)");
    CHECK(s.error().find("at least one number") != std::string::npos);
}

TEST_CASE("quantities that overflow are frozen and reported once, and continue when they are set")
{
    // z grows beyond all numbers if it is positive; the clock, of the same script, continues. A script finds them by id.
    Scene s(R"(<component id="z" type="State/Quantities" values="1"/><component id="zclock" type="State/Quantities" values="0"/>
               <component id="law" type="Script/Lua" between="z zclock"><param name="code">
               function force(t, state)
                   local z = between[1]
                   if z:value(1) > 0 then z:add_rate(1, 1e200) else z:add_rate(1, 1) end
                   between[2]:add_rate(1, 1)
               end</param></component>)",
            "dt=\"1/20\" solver=\"Solver/RungeKutta4\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true, s.keep_events = true;
    s.run(3);
    CHECK(s.count("state.not_finite") == 1);
    REQUIRE(!s.events.empty());
    CHECK(s.events.front().message.find("z left the range of numbers") != std::string::npos);
    CHECK(values(s, "z")[0] == 1);
    CHECK(values(s, "zclock")[0] == doctest::Approx(3).epsilon(1e-12));

    s.events.clear();
    REQUIRE(s.ask(simulation::SetOperation{"z", "values", std::string("-5")}).done);
    s.run(4);
    CHECK(values(s, "z")[0] == doctest::Approx(-4).epsilon(1e-12));
    CHECK(values(s, "zclock")[0] == doctest::Approx(4).epsilon(1e-12));
    CHECK(s.count("state.not_finite") == 0);
    // Without a trial, which would refuse that.
    simulation::Request again;
    again.operations = {simulation::SetOperation{"z", "values", std::string("2")}};
    again.trial.budget = simulation::TrialChoice::Budget::None;
    REQUIRE(s.simulation().carry_out_now(again).done);
    s.run(6);
    CHECK(s.count("state.not_finite") == 1);
    CHECK(values(s, "z")[0] == 2);
}
