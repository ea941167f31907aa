// Constraint/Grab: a damped spring between hand and body, with limits; what is let go keeps its momentum.
#include <numbers>

#include "plab/rotation.h"
#include "support/gravity.h"
#include "users/hands.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kStep = 1.0 / 1000;
const std::string kMilliseconds = "dt='1/1000'";
const double kW = 2 * std::numbers::pi * 8;  // rad/s, of the default frequency

std::string cup(const std::string& position, const std::string& more = "", const std::string& id = "cup")
{
    return "<component id='" + id + "' type='State/RigidBody' mass='2' inertia='0.02 0.03 0.04' position='" + position + "' " + more + "/>";
}
std::string grab(const std::string& more = "", const std::string& user = "hand", const std::string& body = "cup",
                 const std::string& id = "grab")
{
    return "<component id='" + id + "' type='Constraint/Grab' user='" + user + "' body='" + body + "' " + more + "/>";
}
std::string solver() { return "<component id='solver' type='Solver/RungeKutta4'/>"; }

/// Keeps the hand where it is.
void hold_still(Scene& scene, int steps, double grip, const Vec3& at = {}, const Quat& turned = {})
{
    const std::int64_t first = std::get<std::int64_t>(scene.get("hand", "sample")) + 1;
    for (int n = 0; n < steps; ++n) send(scene, {first + n, at, turned, {}, {}, grip}), scene.step();
}

}  // namespace

TEST_CASE("a named body swings to the hand as a critically damped spring of its frequency does")
{
    Scene scene(solver() + hand() + cup("0.1 0 0") + grab("hold='cup' max_force='1e9'"), kMilliseconds);
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    for (int n = 1; n <= 100; ++n)
    {
        hold_still(scene, 1, 0);
        const double t = n * kStep;
        CHECK(std::fabs(scene.vec("cup", "position").x - 0.1 * (1 + kW * t) * std::exp(-kW * t)) < 1e-7);
        const double v = -0.1 * kW * kW * t * std::exp(-kW * t), x = 0.1 * (1 + kW * t) * std::exp(-kW * t);
        CHECK(std::fabs(scene.vec("grab", "force").x - 2 * (-kW * kW * x - 2 * kW * v)) < 1e-3);
        CHECK(distance(scene.vec("hand", "force"), -scene.vec("grab", "force")) < 1e-12);
    }
}

TEST_CASE("under its weight the body hangs g / w^2 below the hand, which carries m g")
{
    Scene scene(solver() + hand() + cup("0 0 0") + grab("hold='cup'") + kGravity, kMilliseconds);
    hold_still(scene, 1000, 0);
    CHECK(near(scene.vec("cup", "position").z, -kG / (kW * kW), 1e-9));
    CHECK(near(scene.real("grab", "distance"), kG / (kW * kW), 1e-9));
    CHECK(distance(scene.vec("hand", "force"), {0, 0, -2 * kG}) < 1e-6);
}

TEST_CASE("a given stiffness k: m g / k")
{
    Scene scene(solver() + hand() + cup("0 0 0") + grab("hold='cup' stiffness='900'") + kGravity, kMilliseconds);
    hold_still(scene, 2000, 0);
    CHECK(near(scene.vec("cup", "position").z, -2 * kG / 900, 1e-8));
}

TEST_CASE("the force is limited: a body that is far away is pulled with max_force")
{
    Scene scene(solver() + hand() + cup("100 0 0") + grab("hold='cup' max_force='6'"), kMilliseconds);
    hold_still(scene, 1000, 0);
    CHECK(near(scene.vec("cup", "position").x, 100 - 0.5 * 3 * 1, 1e-9));
    CHECK(near(length(scene.vec("grab", "force")), 6, 1e-12));
}

TEST_CASE("the torque is limited: a large turn is made with max_torque")
{
    Scene scene(solver() + hand() + cup("0 0 0") + grab("hold='cup' max_torque='0.04'"), kMilliseconds);
    hold_still(scene, 1, 0);
    hold_still(scene, 99, 0, {}, exp_rotation({0, 0, 2}));
    // 0.04 N m on 0.04 kg m^2: 1 rad/s^2 about z. In the step in which the hand turns, its spin may weigh more or less than the angle.
    CHECK(std::fabs(scene.vec("cup", "angular_velocity").z - 0.099) < 3e-3);
    CHECK(near(scene.vec("grab", "torque").z, 0.04, 1e-12));
}

TEST_CASE("the body turns with the hand, and is held by the point where the hand was when it closed")
{
    Scene scene(solver() + hand() + cup("0.04 0 0", "") + grab("reach='0.1'"), kMilliseconds);
    scene.keep_events = true;
    hold_still(scene, 10, 0);
    CHECK(std::get<std::string>(scene.get("grab", "held")).empty());
    hold_still(scene, 10, 1);
    CHECK(std::get<std::string>(scene.get("grab", "held")) == "cup");
    CHECK(distance(scene.vec("grab", "point"), {-0.04, 0, 0}) < 1e-12);
    hold_still(scene, 1000, 1, {}, exp_rotation({0, 0, 1}));
    CHECK(distance(scene.vec("cup", "position"), rotate(exp_rotation({0, 0, 1}), {0.04, 0, 0})) < 1e-6);
    CHECK(attitude_error(scene.quat("cup", "orientation"), exp_rotation({0, 0, 1})) < 1e-6);
    CHECK(scene.count("grab.holds") == 1);
}

TEST_CASE("what is let go keeps its momentum, bit for bit")
{
    Scene scene(solver() + hand() + cup("0 0 0") + grab("reach='0.1'"), kMilliseconds);
    scene.keep_events = true;
    std::int64_t number = 0;
    const auto move = [&](double t, double grip) { send(scene, {++number, {0.3 * t, 0, 0}, {}, {0.3, 0, 0}, {0, 0, 2}, grip}); };
    for (int n = 0; n < 500; ++n) move(n * kStep, n < 5 ? 0 : 1), scene.step();
    const Vec3 v = scene.vec("cup", "linear_velocity"), w = scene.vec("cup", "angular_velocity");
    CHECK(near(v.x, 0.3, 1e-3));
    move(0.5, 0.2);
    scene.step(100);
    CHECK(std::get<std::string>(scene.get("grab", "held")).empty());
    CHECK(scene.count("grab.released") == 1);
    CHECK(scene.vec("cup", "linear_velocity") == v);
    CHECK(distance(scene.vec("cup", "angular_velocity"), w) < 1e-15);
    CHECK(scene.vec("hand", "force") == Vec3{});
}

TEST_CASE("a user who vanishes, or is silent for too long, lets go, and the body flies on")
{
    for (const bool says_so : {true, false})
    {
        CAPTURE(says_so);
        Scene scene(solver() + hand("hand", "patience='0.3' extrapolation='0.5'") + cup("0 0 0") + grab("hold='cup'"), kMilliseconds);
        scene.keep_events = true;
        for (int n = 0; n < 500; ++n) send(scene, {n + 1, {0.3 * n * kStep, 0, 0}, {}, {0.3, 0, 0}}), scene.step();
        CHECK(near(scene.vec("cup", "linear_velocity").x, 0.3, 1e-3));
        if (says_so)
            CHECK(scene.ask(simulation::SetOperation{"hand", "present", Value(false)}).done);
        else
            scene.step(302);
        scene.step(1);
        CHECK(std::get<std::string>(scene.get("grab", "held")).empty());
        CHECK(scene.count("grab.released") == 1);
        const Vec3 v = scene.vec("cup", "linear_velocity");
        CHECK(near(v.x, 0.3, 1e-3));
        scene.step(500);
        CHECK(scene.vec("cup", "linear_velocity") == v);
    }
}

TEST_CASE("many users at once: each holds its own, as if it were alone")
{
    const auto one = [](const std::string& k)
    { return hand("hand" + k) + cup("0.1 " + k + " 0", "", "cup" + k) + grab("hold='cup" + k + "'", "hand" + k, "cup" + k, "grab" + k); };
    std::string all = solver() + kGravity;
    for (int k = 0; k < 8; ++k) all += one(std::to_string(k));
    Scene together(all, kMilliseconds);
    REQUIRE_MESSAGE(together.loaded(), together.error());
    const auto sample = [](int k, int n) { return Sample{n, {0.1 * std::sin(0.01 * n), 1.0 * k, 0.02 * k}, {}, {}, {}, 0}; };
    for (int n = 1; n <= 300; ++n)
    {
        for (int k = 0; k < 8; ++k) send(together, sample(k, n), "hand" + std::to_string(k));
        together.step();
    }
    for (int k = 0; k < 8; ++k)
    {
        const std::string id = std::to_string(k);
        Scene alone(solver() + "<component id='g' type='Field/Gravity' between='*'/>" + one(id), kMilliseconds);
        for (int n = 1; n <= 300; ++n) send(alone, sample(k, n), "hand" + id), alone.step();
        CHECK(alone.vec("cup" + id, "position") == together.vec("cup" + id, "position"));
        CHECK(alone.vec("hand" + id, "force") == together.vec("hand" + id, "force"));
    }
}

TEST_CASE("a hand grabs what it touches, among several, and lifts it from a table; any number of threads, a snapshot and a replay agree")
{
    const std::string table =
        "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>"
        "<component id='cube' type='Shape/Box' half_extents='0.1 0.1 0.1'/>"
        "<component id='left' type='State/RigidBody' mass='1' shape='cube' position='-0.5 0 0.1'/>"
        "<component id='right' type='State/RigidBody' mass='1' shape='cube' position='0.5 0 0.1'/>"
        "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/None' response='Response/Rows' "
        "response.friction='0.5'/>";
    const std::string text = hand("hand", "position='1 0 0.1'") + table + grab("", "hand", "left right") + kGravity;
    const auto sample = [](int n)
    {
        // From the side against the right cube, which it pushes by 1 cm; closing there, and up.
        const double x = n < 240 ? 1 - 0.36 * n / 240.0 : 0.64, z = n < 300 ? 0.1 : 0.1 + 0.5 * (n - 300) / 240.0;
        const Vec3 v{n < 240 ? -0.36 : 0.0, 0, n < 300 ? 0.0 : 0.5};
        return Sample{n, {x, 0, z}, {}, v, {}, n < 238 ? 0.0 : 1.0};
    };
    const auto run = [&](int threads, int cut)
    {
        Scene scene(text, "dt='1/240'", threads);
        REQUIRE_MESSAGE(scene.loaded(), scene.error());
        std::vector<std::uint64_t> hashes;
        for (int n = 1; n <= 500; ++n)
        {
            if (n == cut) REQUIRE(scene.simulation().restore(scene.simulation().capture()).ok());
            if (n % 2 == 0) send(scene, sample(n));
            scene.step();
            hashes.push_back(scene.hash());
        }
        CHECK(std::get<std::string>(scene.get("grab", "held")) == "right");
        CHECK(scene.vec("right", "position").z > 0.4);
        CHECK(std::fabs(scene.vec("left", "position").z - 0.1) < 1e-4);
        return hashes;
    };
    const auto hashes = run(1, 0);
    CHECK(run(2, 0) == hashes);
    CHECK(run(1, 250) == hashes);
    CHECK(run(1, 400) == hashes);
}

TEST_CASE("a body that may not be held is refused by name")
{
    Scene scene(hand() + cup("0 0 0") + cup("3 0 0", "", "other") + grab());
    scene.keep_events = scene.warnings_expected = true;
    CHECK(scene.ask(simulation::SetOperation{"grab", "hold", std::string("other")}).done);
    hold_still(scene, 3, 0);
    CHECK(scene.count("grab.refused") == 1);
    CHECK(std::get<std::string>(scene.get("grab", "held")).empty());
}
