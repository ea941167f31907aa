// Closed forms of joints, springs, gears and contacts against independent digits: mpmath, 30 digits, by quadrature or from the
// formula given with each; never from this code.
#include <numbers>

#include "scenes.h"
#include "support/text.h"

using namespace plab;
using namespace plab::exact;
using plab::test::distance;
using plab::test::exact_at;
using plab::test::has;
using plab::test::near;
using plab::test::refusal;
using plab::test::Scene;

namespace
{

std::vector<double> contact_times(const Scene& scene, const std::string& name, double until)
{
    const auto solution = make_solution(name, scene.simulation(), until);
    REQUIRE(solution.ok());
    std::vector<double> out;
    for (const ContactStart& c : (*solution)->contacts(until)) out.push_back(c.time);
    return out;
}

/// w/J = g/1 m: half a metre to the centre of mass, 0.25 kg m^2 about it.
Scene hung(const std::string& joint, const std::string& more = "")
{
    return Scene("<component id='bob' type='State/RigidBody' mass='1' inertia='0.25 0.25 0.25' position='0.5 0 0' " + more +
                 "/><component id='weight' type='Field/Gravity' between='bob'/><component id='joint' type='" + joint +
                 "' b='bob' anchor='0 0 0'/>");
}

const std::string kFloor =
    "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>"
    "<component id='weight' type='Field/Gravity' between='box'/>";

/// A box of 1 kg on a slope of 20 degrees (gravity is tilted), mu = 0.6 and a speed.
Scene slope(const std::string& velocity, const std::string& friction = "0.6")
{
    return Scene(
        "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>"
        "<component id='form' type='Shape/Box' half_extents='0.2 0.2 0.05'/>"
        "<component id='box' type='State/RigidBody' mass='1' shape='form' position='0 0 0.05' linear_velocity='" +
        velocity +
        "'/><component id='weight' type='Field/Gravity' between='box' acceleration='3.3552176060248105 0 -9.218384609909762'/>"
        "<component id='contact' type='CDetection/ODE' between='box ground' resolution='Resolution/None' response='Response/Impulse' "
        "response.friction='" +
        friction + "'/>");
}

}  // namespace

TEST_CASE("a body on a hinge or a ball joint is the pendulum of its inertia: period 4 K(1/2) / sqrt(g/L) from the horizontal")
{
    const double period = 2.36784194757623745;
    for (const std::string joint : {"Constraint/Ball", "Constraint/Hinge' axis='0 1 0"})
    {
        const Scene s = hung(joint);
        CHECK(distance(exact_at(s, "pendulum", "bob", period).position, {0.5, 0, 0}) < 1e-14);
        CHECK(distance(exact_at(s, "pendulum", "bob", period / 2).position, {-0.5, 0, 0}) < 1e-14);
        const State low = exact_at(s, "pendulum", "bob", period / 4);
        CHECK(distance(low.position, {0, 0, -0.5}) < 1e-14);
        CHECK(near(length(low.velocity), 0.5 * std::sqrt(2 * 9.81), 1e-14));
        // From the vertical: 0.469575371957878769 rad past it.
        const State past = exact_at(s, "pendulum", "bob", 0.7);
        CHECK(near(past.position.x, -0.5 * std::sin(0.469575371957878769), 1e-14));
        CHECK(near(past.position.z, -0.5 * std::cos(0.469575371957878769), 1e-14));
        CHECK(distance(past.velocity, cross(past.angular_velocity, past.position)) < 1e-15);
    }
    const Scene round = hung("Constraint/Hinge' axis='0 1 0", "angular_velocity='0 -9 0' linear_velocity='0 0 4.5'");
    const State start = exact_at(round, "pendulum", "bob", 0);
    CHECK(distance(start.velocity, {0, 0, 4.5}) < 1e-14);
    CHECK(distance(start.angular_velocity, {0, -9, 0}) < 1e-14);
}

TEST_CASE("declared springs: on a slider, hanging, and about an axle")
{
    // x = -mg/k + e^(-2t) (mg/k) (cos wt + (2/w) sin wt), w^2 = 396, at t = 0.3.
    const Scene slider(
        "<component id='m' type='State/RigidBody' mass='2' inertia='1 1 1' position='0 0 3'/>"
        "<component id='weight' type='Field/Gravity' between='m'/><component id='guide' type='Constraint/Slider' b='m' axis='0 0 1'/>"
        "<component id='spring' type='Constraint/TorsionSpring' b='m' along='slide' axis='0 0 1' stiffness='800' damping='8'/>");
    CHECK(near(exact_at(slider, "oscillator", "m", 0.3).position.z, 3 - 0.0121372861589947097, 1e-15));
    const Scene hanging(
        "<component id='m' type='State/RigidBody' mass='2' inertia='1 1 1' position='0 0 2'/>"
        "<component id='weight' type='Field/Gravity' between='m'/>"
        "<component id='spring' type='Constraint/SpringDamper' b='m' anchor_a='0 0 3' anchor_b='0 0 0' stiffness='800' damping='8'/>");
    CHECK(near(exact_at(hanging, "oscillator", "m", 0.3).position.z, 2 - 0.0121372861589947097, 1e-15));
    const Scene shaft(
        "<component id='a' type='State/Shaft' inertia='2' angle='1.5'/>"
        "<component id='spring' type='Constraint/TorsionSpring' b='a' stiffness='8' rest='0.5'/>");
    CHECK(near(exact_at(shaft, "oscillator", "a", std::numbers::pi / 2).angle, -0.5, 1e-15));
    const Scene aside(
        "<component id='m' type='State/RigidBody' mass='2' inertia='1 1 1' position='1 0 0'/>"
        "<component id='weight' type='Field/Gravity' between='m'/>"
        "<component id='spring' type='Constraint/SpringDamper' b='m' anchor_a='0 0 0' anchor_b='0 0 0' stiffness='800'/>");
    CHECK(has(refusal(aside, "oscillator"), "weight pulls it off"));
}

TEST_CASE("gears: six meshes of ten to one both ways, a ring that closes, an engagement")
{
    const auto train = [](const std::string& factor)
    {
        std::string body;
        for (int i = 1; i <= 7; ++i) body += "<component id='s" + std::to_string(i) + "' type='State/Shaft' inertia='0.001'/>";
        for (int i = 1; i <= 6; ++i)
            body += "<component id='g" + std::to_string(i) + "' type='Constraint/AngularVelocity/Graph' driver='s" + std::to_string(i) +
                    "' driven='s" + std::to_string(i + 1) + "' velocity_factor='" + factor + "'/>";
        return Scene(body + "<component id='load' type='Field/Load' between='s1' shaft_torque='1'/>");
    };
    const Scene down = train("0.1"), up = train("10");
    CHECK(near(1 / exact_at(down, "gears", "s1", 1).speed, 0.001010101010101, 1e-18));
    CHECK(near(1 / exact_at(up, "gears", "s1", 1).speed, 1010101010.101, 1e-15));
    CHECK(near(exact_at(up, "gears", "s7", 2).angle, 2e6 / 1010101010.101, 1e-15));
    const std::string two =
        "<component id='a' type='State/Shaft' inertia='1' angular_velocity='100'/><component id='b' type='State/Shaft' inertia='2'/>"
        "<component id='g' type='Constraint/AngularVelocity/Graph' driver='a' driven='b' velocity_factor='-0.5'/>";
    const Scene engaged(two);
    CHECK(near(exact_at(engaged, "gears", "a", 1).speed, 200.0 / 3, 1e-15));
    CHECK(near(exact_at(engaged, "gears", "b", 1).speed, -100.0 / 3, 1e-15));
    const Scene twice(two + "<component id='h' type='Constraint/AngularVelocity/Graph' driver='b' driven='a' velocity_factor='-2'/>");
    CHECK(near(exact_at(twice, "gears", "a", 1).speed, 200.0 / 3, 1e-15));
    const std::string three = two + "<component id='c' type='State/Shaft' inertia='1'/>";
    const auto gear = [](const char* id, const char* driver, const char* driven, const char* factor)
    {
        return std::string("<component id='") + id + "' type='Constraint/Gear' driver='" + driver + "' driven='" + driven +
               "' velocity_factor='" + factor + "'/>";
    };
    const Scene closed(three + gear("h", "b", "c", "-2") + gear("i", "a", "c", "1"));
    CHECK(near(exact_at(closed, "gears", "c", 1).speed, 40.0, 1e-15));
    const Scene broken(three + gear("h", "b", "c", "-2") + gear("i", "a", "c", "2"));
    CHECK(has(refusal(broken, "gears"), "is contradictory"));
}

TEST_CASE("a box on a slope: sliding down, up and back, at rest, and across")
{
    const double p = 3.3552176060248105, f = 0.6 * 9.218384609909762;
    CHECK(near(exact_at(slope("2 0 0"), "slide", "box", 0.5).position.x, 1 + 0.125 * (p - f), 1e-15));
    const State held = exact_at(slope("-2 0 0"), "slide", "box", 5);
    CHECK(near(held.position.x, -2 / (p + f), 1e-15));
    CHECK(length(held.velocity) == 0);
    // mu = 0.2 does not hold: up for 2/(p + f), then down with p - f.
    const double slip = 0.2 * 9.218384609909762, stop = 2 / (p + slip);
    const State back = exact_at(slope("-2 0 0", "0.2"), "slide", "box", 2);
    CHECK(near(back.velocity.x, (p - slip) * (2 - stop), 1e-15));
    CHECK(near(back.position.x, -2 / (p + slip) + 0.5 * (p - slip) * (2 - stop) * (2 - stop), 1e-14));
    CHECK(near(exact_at(slope("0 0 0", "0.2"), "slide", "box", 2).position.x, 2 * (p - slip), 1e-15));
    CHECK(exact_at(slope("0 0 0"), "slide", "box", 2).position.x == 0);
    // Across: Taylor series of the equations of motion, 18 digits.
    const State across = exact_at(slope("0.5 1.5 0"), "slide", "box", 0.3);
    CHECK(distance(across.position, {0.171996423236580551, 0.241732556382433475, 0.05}) < 1e-12);
    CHECK(distance(across.velocity, {0.482780191945166828, 0.248267313542715482, 0}) < 1e-12);
    CHECK(length(exact_at(slope("0.5 1.5 0"), "slide", "box", 5).velocity) == 0);
    const State begin = exact_at(slope("0.5 -1.5 0"), "slide", "box", 0);
    CHECK(distance(begin.velocity, {0.5, -1.5, 0}) < 1e-12);
}

TEST_CASE("a rocking block: times of impact by quadrature, Housner's factor, and rest at the end")
{
    const Scene s = Scene::file("scenes/studies/rocking_block.xml");
    const std::vector<double> times = contact_times(s, "rocking", 1.6);
    REQUIRE(times.size() == 3);
    CHECK(near(times[0], 0.351119854285176024, 1e-13));
    CHECK(near(times[1], 0.960606577324697059, 1e-13));
    CHECK(near(times[2], 1.50197788137162709, 1e-13));
    const auto tilt = [&](double t) { return 2 * exact_at(s, "rocking", "block", t).orientation.y; };
    CHECK(near(tilt(0), 2 * std::sin(0.05), 1e-15));
    CHECK(near(tilt(0.655863215804936542), -2 * std::sin(0.5 * 0.0843380236142950377), 1e-13));
    CHECK(near(tilt(1.23129222934816207), 2 * std::sin(0.5 * 0.0720548723145059452), 1e-13));
    // No jump of the position at an impact; the angular speed is multiplied by 0.9423...
    const State before = exact_at(s, "rocking", "block", times[0] - 1e-9), after = exact_at(s, "rocking", "block", times[0] + 1e-9);
    CHECK(distance(before.position, after.position) < 1e-8);
    CHECK(near(after.angular_velocity.y / before.angular_velocity.y, 0.942307692307692308, 1e-7));
    const Scene squat(
        "<component id='form' type='Shape/Box' half_extents='0.5 0.5 0.1'/>"
        "<component id='box' type='State/RigidBody' mass='1' shape='form' position='0 0 0.1'/>" +
        kFloor +
        "<component id='contact' type='CDetection/ODE' between='box ground' resolution='Resolution/None' response='Response/Impulse' "
        "response.friction='1'/>");
    CHECK(has(refusal(squat, "rocking"), "lies flat"));
    CHECK(exact_at(squat, "rest", "box", 3).position.z == 0.1);
}

TEST_CASE("a ball on a contact spring: time of contact, depth, and speed of separation")
{
    const Scene s = Scene::file("scenes/studies/contact_spring.xml");
    const double touch = 0.451523640985730904, lasts = 0.0319950863080954309;
    CHECK(near(contact_times(s, "spring-bounce", 1).front(), touch, 1e-15));
    CHECK(near(exact_at(s, "spring-bounce", "ball", touch + 0.01).position.z, 0.0648149271856732252, 1e-14));
    CHECK(near(exact_at(s, "spring-bounce", "ball", touch + lasts).velocity.z, 3.51804021448791167, 1e-13));
    CHECK(near(exact_at(s, "spring-bounce", "ball", 1).position.z, 0.608578888109610100, 1e-14));
    CHECK(has(refusal(Scene::file("scenes/studies/bounce.xml"), "spring-bounce"), "no Response/Penalty"));
}

TEST_CASE("statics: columns are accepted; scenes that topple, hang or move are refused")
{
    CHECK(exact_at(Scene::file("scenes/studies/stack.xml"), "rest", "cube20", 2).position.z == 19.5);
    const auto pair = [](const std::string& upper)
    {
        return Scene(
            "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>"
            "<component id='cube' type='Shape/Box' half_extents='0.5 0.5 0.5'/>"
            "<component id='low' type='State/RigidBody' mass='1' shape='cube' position='0 0 0.5'/>"
            "<component id='high' type='State/RigidBody' mass='1' shape='cube' " +
            upper +
            "/><component id='weight' type='Field/Gravity' between='low high'/>"
            "<component id='contact' type='CDetection/ODE' between='low high' against='ground' resolution='Resolution/None' "
            "response='Response/Impulse'/>");
    };
    CHECK(refusal(pair("position='0.4 0 1.5'"), "rest") == "none");
    CHECK(has(refusal(pair("position='0.6 0 1.5'"), "rest"), "high topples"));
    CHECK(has(refusal(pair("position='0 0 1.6'"), "rest"), "high is not supported"));
    CHECK(has(refusal(pair("position='0 0 1.5' linear_velocity='1 0 0'"), "rest"), "high moves"));
}
