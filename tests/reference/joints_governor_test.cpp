// A flyball governor with stiff springs (catalogue: B6): a loop of rods, sleeve and springs on a free shaft. Digits: 113-bit
// integration of the symmetric mechanism in three coordinates, its angular momentum kept to 1e-28.
#include <numbers>

#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kSpin = 2 * std::numbers::pi, kSide = .05;
constexpr double kHeightAt1 = .50142092237956765, kSpinAt1 = 6.2711257418765548;
constexpr double kHeightAt10 = .61962291706136566, kSpinAt10 = 5.5482036226549266, kTurnedAt10 = 55.935409909102379;

/// A rod of 0.3 kg with a ball of 5 kg at its end is one body; `at`: its centre of mass along it.
std::string arm(const std::string& id, double sign)
{
    constexpr double at = (.3 * .5 + 5) / 5.3;
    constexpr double across = .3 * (1 + 1e-4) / 12 + .3 * (at - .5) * (at - .5) + 5 * (1 - at) * (1 - at);
    const double down = std::numbers::pi / 6, turn = sign > 0 ? down : std::numbers::pi - down;
    const Vec3 pivot{sign * kSide, 0, 1}, c = pivot + at * Vec3{sign * std::cos(down), 0, -std::sin(down)};
    return body(id, 5.3, {5e-6, across, across}, c,
                "orientation='" + text(std::cos(turn / 2)) + " 0 " + text(std::sin(turn / 2)) + " 0' angular_velocity='0 0 " + text(kSpin) +
                    "' linear_velocity='0 " + text(kSpin * c.x) + " 0'") +
           joint("pivot_" + id, "Hinge", "shaft", id, "anchor='" + text(pivot) + "' axis='0 1 0'") +
           joint(
               "spring_" + id, "SpringDamper", id, "sleeve",
               "anchor_a='" + text(.5 - at) + " 0 0' anchor_b='" + text(sign * kSide) + " 0 0' length='0.5' stiffness='8e5' damping='4e4'");
}

std::string governor(const std::string& solver)
{
    constexpr double half = .3 * (1 + 1e-4) / 12;
    const std::string turning = "angular_velocity='0 0 " + text(kSpin) + "'";
    return "<component id='solver' type='Solver/" + solver + "/>" + gravity() + body("shaft", .3, {half, half, 5e-6}, {0, 0, .5}, turning) +
           body("sleeve", 3, {.005, .005, .005}, {0, 0, .5}, turning) +
           joint("bearing", "Hinge", "", "shaft", "anchor='0 0 0' axis='0 0 1'") +
           joint("guide", "Slider", "shaft", "sleeve", "anchor='0 0 0.5' axis='0 0 1'") + arm("right", 1) + arm("left", -1);
}

double height_error_at_1(const std::string& solver, int per_second)
{
    Scene s(governor(solver), dt(per_second));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    CHECK(s.real("pivot_left", "position_error") < 1e-12);
    return std::fabs(s.vec("sleeve", "position").z - kHeightAt1);
}

}  // namespace

TEST_CASE("B6: a stiff governor with error control: the sleeve after 10 s")
{
    Scene s(governor("DormandPrince54' relative_tolerance='1e-6' absolute_tolerance='1e-8'"), dt(20));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(10);
    const double z = s.vec("sleeve", "position").z - kHeightAt10, w = s.vec("shaft", "angular_velocity").z - kSpinAt10;
    const double turned = s.real("bearing", "angle") - kTurnedAt10;
    MESSAGE("errors: height ", z, ", spin ", w, ", turned ", turned);
    CHECK(std::fabs(z) < 1e-9);
    CHECK(std::fabs(w) < 1e-8);
    CHECK(std::fabs(turned) < 1e-8);
    CHECK(s.real("guide", "position_error") < 1e-12);
}

TEST_CASE("B6: the stiff solver needs the fewest evaluations for a millionth of a metre")
{
    Scene s(governor("Radau5' relative_tolerance='1e-6' absolute_tolerance='1e-8'"), dt(2));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(10);
    CHECK(std::fabs(s.vec("sleeve", "position").z - kHeightAt10) < 1e-6);
    CHECK(std::fabs(s.vec("shaft", "angular_velocity").z - kSpinAt10) < 1e-5);
}

TEST_CASE("B6: fixed steps: within these bounds after 1 s, and in their order")
{
    const double coarse = height_error_at_1("RungeKutta4'", 4000), fine = height_error_at_1("RungeKutta4'", 8000);
    CHECK(fine < 1e-10);
    CHECK(std::log2(coarse / fine) > 3.8);
    CHECK(height_error_at_1("StoermerVerlet'", 4000) < 2e-7);
    // Implicit: stable at any step, first wrong and then not.
    CHECK(height_error_at_1("ImplicitMidpoint'", 200) < 1e-3);
}
