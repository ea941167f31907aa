// Penalty contacts that begin at any phase of a step (B2), Hunt and Crossley's damping, the energy balance within a contact,
// stiction that does not creep.
#include <numbers>

#include "support/gravity.h"
#include "swaps.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// A ball of 1 kg, `away` above a floor that it hits with `v`.
std::string falling(double away, double v, const std::string& response)
{
    return solid("a", "Sphere' radius='0.1'", 1, {0, 0, 0.1 + away}, "linear_velocity='0 0 " + text(-v) + "'") +
           ground_and_contact("None", response.substr(0, response.find(' ')), response.substr(response.find(' ') + 1));
}

/// Speed of the ball after the contact, divided by the one before.
double restitution(double h, double phase, double v, double half_period, const std::string& response)
{
    Scene s(falling((1 + phase) * h * v, v, response), "dt='" + text(h) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(static_cast<std::int64_t>(std::ceil(half_period / h)) + 4);
    return s.vec("a", "linear_velocity").z / v;
}

}  // namespace

TEST_CASE("B2: fifty phases of the step at every h w, undamped and damped, give the same restitution")
{
    // m = 1, k = 1e6: w = 1e3, the contact lasts pi ms.
    const std::string plain = "Penalty response.restitution='1' response.stiffness='1e6'", damped = plain + " response.damping_ratio='0.1'";
    double worst = 0, worst_damped = 0;
    for (const double hw : {0.1, 0.5, 1.9, 2.5, 16.0})
        for (int i = 0; i < 50; ++i)
        {
            const double h = hw * 1e-3, phase = i / 50.0;
            worst = std::max(worst, std::fabs(restitution(h, phase, 1, std::numbers::pi * 1e-3, plain) - 1));
            if (i % 5 == 0)
                worst_damped =
                    std::max(worst_damped, std::fabs(restitution(h, phase, 1, std::numbers::pi * 1e-3, damped) - 0.72924761428767));
        }
    // Reached: 2e-10 undamped, with 200 pieces per contact.
    CHECK(worst <= 3e-10);
    CHECK(worst_damped <= 1e-9);
}

TEST_CASE("Hunt and Crossley: the restitution obeys (1 + e) s = ln((1 + s) / (1 - e s)), s = dissipation * speed")
{
    // Roots by mpmath, 20 digits; whatever stiffness, mass and exponent.
    const std::pair<double, double> known[] = {
        {0.1, 0.93747557994990506052}, {0.5, 0.74843493159743415812}, {1, 0.59362426004004009232}, {5, 0.19698024528051888505}};
    for (const auto& [s, e] : known)
        for (const double v : {0.5, 4.0})
            for (const char* law : {"response.stiffness='1e7'", "response.stiffness='1e5' response.exponent='2'"})
            {
                CAPTURE(s);
                CAPTURE(v);
                CAPTURE(law);
                const std::string response =
                    "HuntCrossley response.restitution='1' " + std::string(law) + " response.dissipation='" + text(s / v) + "'";
                CHECK(std::fabs(restitution(1.0 / 60, 0.4, v, 0.3, response) - e) <= 2e-7);
            }
}

TEST_CASE("also within a contact, kinetic and stored energy add up to the initial energy")
{
    for (const char* response :
         {"Penalty response.restitution='1' response.stiffness='1e4'", "HuntCrossley response.restitution='1' response.stiffness='1e6'"})
    {
        CAPTURE(response);
        Scene s(falling(1e-3, 1, response) + "<component id='solver' type='Solver/RungeKutta4'/>", dt(1000));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        double most = 0;
        for (int i = 0; i < 60; ++i)
        {
            s.step();
            const double stored = s.real("contact.response", "stored");
            most = std::max(most, stored);
            CHECK(std::fabs(s.simulation().totals().kinetic + stored - 0.5) <= 1e-7);
            CHECK(std::fabs(s.simulation().totals().kinetic - 0.5 - s.simulation().totals().work) <= 1e-9);
        }
        CHECK(most > 0.45);  // a step ended near the largest depth
    }
}

TEST_CASE("a heavy load on Hunt and Crossley's law without rebound settles, in a bounded number of pieces")
{
    Scene s(
        gravity() + solid("a", "Box' half_extents='0.1 0.1 0.1'", 100, {0, 0, 0.1001}) +
            ground_and_contact("None", "HuntCrossley", "response.stiffness='1e6' response.restitution='0' response.steps_per_contact='10'"),
        dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    std::uint64_t most = 0;
    for (int i = 0; i < 240; ++i)
    {
        s.step();
        most = std::max(most, s.simulation().stepper().report().evaluations);
    }
    CHECK(most < 5000);
    const double depth = std::pow(100 * kG / 4 / 1e6, 2.0 / 3);
    CHECK(std::fabs(0.1 - s.vec("a", "position").z - depth) <= 0.06 * depth);  // overdamped: it creeps with a time constant of 1.5 s
}

TEST_CASE("stiction has a memory: a block on a slope of 30 degrees does not move")
{
    Scene s = block_on_a_slope();
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;
    s.run(4);
    const Vec3 settled = s.vec("a", "position");
    s.run(12);
    CHECK(distance(s.vec("a", "position"), settled) <= 1e-11);
}
