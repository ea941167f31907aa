// Joints that leave two motions, against closed forms.
//
//   Screw        a nut that falls on its bolt: m z'' + I (2 pi / p)^2 z'' = -m g
//   Cylindrical  a sleeve falls along its rod and turns as it did
//   Planar       a puck on a slope: g sin b along it, and its spin stays
//   Universal    Cardan's joint between two shafts at an angle b: tan psi = tan phi cos b, where phi is counted from the position in which
//                the first cross axis is across the plane of the shafts. Three of the rows of the two bearings and the cross are implied by
//                the others.
//
// | joint       | error, with the default solver at 1/240 s                                      |
// |-------------|-------------------------------------------------------------------------|
// | Screw       | 1e-12 m after 2 s and 64 turns                                          |
// | Cylindrical | 1e-12 m, 1e-12 rad/s                                                    |
// | Planar      | 1e-12 m                                                                 |
// | Universal   | 1e-12 rad after 5 turns; the drive's torque 2e-5 N m                      |
#include <cmath>
#include <numbers>

#include "plab/rotation.h"
#include "support/gravity.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kTurn = 2 * std::numbers::pi;

struct Falls : Scene
{
    explicit Falls(const std::string& joint_text, const std::string& motion = "", const Vec3& g = {0, 0, -kG})
        : Scene("<component id='g' type='Field/Gravity' between='b' acceleration='" + text(g) + "'/>" +
                body("b", 2, {0.02, 0.03, 0.04}, {0.3, 0.2, 1}, motion) + joint_text)
    {
        REQUIRE_MESSAGE(loaded(), error());
    }
};

}  // namespace

TEST_CASE("a nut falls on its bolt as slowly as it has to turn; a left-hand thread turns it the other way")
{
    for (const double lead : {0.05, -0.05, 2.0})
    {
        CAPTURE(lead);
        Falls s(joint("j", "Screw", "", "b", "anchor='0.3 0.2 1' axis='0 0 1' lead='" + text(lead) + "'"));
        s.run(2);
        const double per_metre = kTurn / lead, a = -kG * 2 / (2 + 0.04 * per_metre * per_metre), z = 0.5 * a * 4;
        CHECK(near(s.vec("b", "position").z, 1 + z, 1e-11));
        CHECK(near(s.real("j", "travel"), z, 1e-11));
        CHECK(near(s.real("j", "angle"), z * per_metre, 1e-9));
        CHECK(near(s.vec("b", "angular_velocity").z, a * 2 * per_metre, 1e-10));
        CHECK(s.real("j", "position_error") < 1e-12);
    }
}

TEST_CASE("a sleeve falls along its rod and turns as it did; its weight across the rod is carried")
{
    const double angle = 0.3;
    Falls s(joint("j", "Cylindrical", "", "b", "anchor='0.3 0.2 1' axis='0 0 1'"), "angular_velocity='0 0 5'",
            {kG * std::sin(angle), 0, -kG * std::cos(angle)});
    s.run(1);
    CHECK(near(s.real("j", "travel"), -0.5 * kG * std::cos(angle), 1e-11));
    CHECK(near(s.vec("b", "angular_velocity").z, 5, 1e-11));
    CHECK(near(s.real("j", "angle"), 5, 1e-11));
    CHECK(near(s.vec("j", "force").x, -2 * kG * std::sin(angle), 1e-9));
}

TEST_CASE("a puck on a slope slides down it and keeps its spin")
{
    const double angle = 0.4;
    const Vec3 n{-std::sin(angle), 0, std::cos(angle)}, down{-std::cos(angle), 0, -std::sin(angle)};
    Falls s(joint("j", "Planar", "", "b", "anchor='0.3 0.2 1' axis='" + text(n) + "'"),
            "orientation='axis 0 1 0 " + text(-angle) + "' angular_velocity='" + text(n * 7) + "' linear_velocity='0 1 0'");
    s.run(1);
    const Vec3 due = Vec3{0.3, 1.2, 1} + down * (0.5 * kG * std::sin(angle));
    CHECK(distance(s.vec("b", "position"), due) < 1e-11);
    CHECK(distance(s.vec("b", "angular_velocity"), n * 7) < 1e-11);
    CHECK(near(s.real("j", "angle"), 7, 1e-10));
}

TEST_CASE("Cardan's joint: a shaft that turns evenly turns the other one unevenly")
{
    const double bend = 0.6, speed = 16;
    const Vec3 out{std::cos(bend), std::sin(bend), 0}, across{-std::sin(bend), std::cos(bend), 0};
    // The second shaft lies along `out`, and its moment of inertia about that axis is the same at any turn.
    Scene s(body("p", 1, {0.01, 0.02, 0.02}, {-0.5, 0, 0}, "angular_velocity='" + text(Vec3{speed, 0, 0}) + "'") +
            body("q", 1, {0.01, 0.02, 0.02}, out * 0.5,
                 "orientation='axis 0 0 1 " + text(bend) + "' angular_velocity='" + text(out * (speed * std::cos(bend))) + "'") +
            joint("drive", "Motor", "", "p", "axis='1 0 0' speed='" + text(speed) + "'") +
            joint("jp", "Hinge", "", "p", "anchor='-0.5 0 0' axis='1 0 0'") +
            joint("jq", "Hinge", "", "q", "anchor='" + text(out * 0.5) + "' axis='" + text(out) + "'") +
            joint("cross", "Universal", "p", "q", "anchor='0 0 0' axis='0 0 1' axis_b='" + text(across) + "'"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    const double phi = s.real("jp", "angle");
    CHECK(near(phi, 2 * speed, 1e-9));
    const double turns = std::round(phi / std::numbers::pi) * std::numbers::pi, c = std::cos(bend);
    CHECK(near(s.real("jq", "angle"), turns + std::atan(std::tan(phi - turns) * c), 1e-12));
    const double across_plane = std::pow(std::cos(phi), 2) + std::pow(std::sin(phi) * c, 2), psi_rate = speed * c / across_plane;
    CHECK(near(length(s.vec("q", "angular_velocity")), psi_rate, 1e-9));
    // The motor gives what the second shaft takes up: torque speed = J psi' psi''.
    const double psi_rate_rate = speed * speed * c * std::sin(2 * phi) * (1 - c * c) / (across_plane * across_plane);
    CHECK(near(s.vec("drive", "torque").x, 0.01 * psi_rate * psi_rate_rate / speed, 5e-5));  // of the last stage
    std::int64_t implied = 0;
    for (const char* const id : {"cross", "jp", "jq"}) implied += std::get<std::int64_t>(s.get(id, "redundant"));
    CHECK(implied == 3);
}

TEST_CASE("the two angles of a universal joint are those of its cross")
{
    Scene s(body("a", 1, {0.02, 0.02, 0.02}, {}) + joint("hold", "Fixed", "", "a", "") +
            body("b", 1, {0.02, 0.03, 0.04}, {}, "angular_velocity='0.5 0.8 0'") +
            joint("j", "Universal", "a", "b", "anchor='0 0 0' axis='1 0 0' axis_b='0 1 0'"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.5);
    // b is what turning about x by the first angle, then about the y axis of the cross by the second one, makes of it.
    const Quat due = exp_rotation({s.real("j", "first_angle"), 0, 0}) * exp_rotation({0, s.real("j", "second_angle"), 0});
    CHECK(length(log_rotation(s.quat("b", "orientation") * conjugate(due))) < 1e-9);
    CHECK(std::fabs(s.real("j", "first_angle")) > 0.1);
    CHECK(std::fabs(s.real("j", "second_angle")) > 0.1);
    CHECK(s.real("j", "position_error") < 1e-13);
}

TEST_CASE("a hinge that has turned becomes a screw, a sleeve, a slider and a hinge again: the body goes on from where it is")
{
    Falls s(joint("j", "Hinge", "", "b", "anchor='0.3 0.2 1' axis='0 0 1'"), "angular_velocity='0 0 5'");
    s.run(1);
    const auto exchange = [&](const std::string& type, const std::string& parameter, const std::string& value)
    {
        const Vec3 before = s.vec("b", "position");
        simulation::SwapOperation swap{"j", "Constraint/" + type, {}};
        if (!parameter.empty()) swap.values.push_back({parameter, value});
        REQUIRE(s.ask(swap).done);
        const double down = std::fabs(s.vec("b", "linear_velocity").z);
        s.step();
        CHECK(distance(s.vec("b", "position"), before) < (down + 0.2) / 200);
        s.run(s.simulation().time() + 0.2);
        CHECK(s.real("j", "position_error") < 1e-11);
    };
    exchange("Screw", "lead", "0.1");
    exchange("Cylindrical", "", "");
    exchange("Slider", "", "");
    exchange("Planar", "", "");
    exchange("Hinge", "", "");
}

TEST_CASE("a universal joint with parallel axes is refused")
{
    const Scene s(body("b", 1, {0.02, 0.03, 0.04}, {}) + joint("j", "Universal", "", "b", "axis='0 1 0'"));
    CHECK(s.error().find("must not be parallel") != std::string::npos);
}
