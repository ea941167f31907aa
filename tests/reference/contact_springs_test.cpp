// Springs and dampers on bodies that touch something, whose steps a manager (or Response/Impulse) makes. Forces are evaluated halfway
// through the step, so that a spring is stepped as Stoermer and Verlet do, and islands divide their step where h w is above 1/2
// (simulation/contacts/force_parts.h). References: the harmonic and the damped oscillator; a floor without friction adds nothing.
//
// h w of the spring       position                                  energy, relative to that of the swing
// 0.04                    order 2 in h; SoftStep: order 1           within (h w)^2, however long it swings; SoftStep loses it
// 0.2 .. 19 in the step   blocks stay where they are                at most (1/2)^2 / 4 more at any time, which is not kept
#include "support/gravity.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

const char* const kFloor = "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>";

std::string detection(const std::string& response, const std::string& friction = "0")
{
    return "<component id='c' type='CDetection/ODE' between='*' resolution='Resolution/None' " + response + " response.friction='" +
           friction + "'/><component id='g' type='Field/Gravity' between='*'/>";
}

/// A block of 1 kg on the floor, 0.1 m from where its spring is slack.
std::string block_on_spring(const std::string& response, double stiffness)
{
    return std::string(kFloor) +
           "<component id='box' type='Shape/Box' half_extents='0.2 0.2 0.2'/>"
           "<component id='b' type='State/RigidBody' mass='1' shape='box' position='1.1 0 0.2'/>"
           "<component id='s' type='Constraint/SpringDamper' b='b' anchor_a='0 0 0.2' length='1' stiffness='" +
           text(stiffness) + "'/>" + detection(response);
}

/// Two blocks on the floor with a spring between them, stretched by 0.01 m.
std::string pair_on_spring(const std::string& response, double stiffness, double damping, const std::string& friction)
{
    return std::string(kFloor) +
           "<component id='box' type='Shape/Box' half_extents='0.25 0.25 0.25'/>"
           "<component id='a' type='State/RigidBody' mass='1' shape='box' position='0 0 0.25'/>"
           "<component id='b' type='State/RigidBody' mass='1' shape='box' position='1.01 0 0.25'/>"
           "<component id='s' type='Constraint/SpringDamper' a='a' b='b' length='1' stiffness='" +
           text(stiffness) + "' damping='" + text(damping) + "'/>" + detection(response, friction);
}

double energy(const Scene& s)
{
    const simulation::Totals totals = s.simulation().totals();
    return totals.kinetic + totals.stored;
}

const char* const kDirect = "response='Response/Rows' response.manager='Manager/Direct'";
const char* const kSweeps = "response='Response/Rows' response.manager='Manager/SequentialImpulse'";
const char* const kSoft = "response='Response/Rows' response.manager='Manager/SoftStep'";
const char* const kImpulse = "response='Response/Impulse'";
const char* const kNamed[] = {"", kDirect, kSweeps, kSoft, kImpulse};

/// m: the largest difference from 0.1 cos(w t) in 2 s.
double error_of(const std::string& response, int steps_per_second)
{
    const double w = 10;
    Scene s(block_on_spring(response, w * w), "dt='1/" + std::to_string(steps_per_second) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double worst = 0;
    for (int i = 1; i <= 2 * steps_per_second; ++i)
    {
        s.step();
        worst = std::fmax(worst, std::fabs(s.vec("b", "position").x - 1 - 0.1 * std::cos(w * s.simulation().time())));
    }
    return worst;
}

}  // namespace

TEST_CASE("a block that swings on a floor without friction: second order, with every algorithm that holds contacts")
{
    for (const char* response : kNamed)
    {
        CAPTURE(response);
        const double coarse = error_of(response, 120), fine = error_of(response, 240);
        MESSAGE(response << ": " << coarse << " m, " << fine << " m");
        // SoftStep moves bodies after each kick of its sub-steps.
        CHECK(coarse < (response == kSoft ? 1e-2 : 1e-3));
        CHECK(coarse / fine > (response == kSoft ? 1.9 : 3.8));
    }
}

TEST_CASE("a block that swings on a floor for 100 periods makes no energy")
{
    for (const char* response : kNamed)
    {
        CAPTURE(response);
        Scene s(block_on_spring(response, 100));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const double start = energy(s), swing = 0.5 * 100 * 0.01;
        double most = start;
        for (int i = 0; i < 240 * 63; ++i) s.step(), most = std::fmax(most, energy(s));
        MESSAGE(response << ": " << (most - start) / swing << " " << (energy(s) - start) / swing << " of the swing's energy");
        const double bound = 100.0 / (240 * 240);
        CHECK(most - start < bound * swing);
        if (response != kSoft) CHECK(energy(s) - start > -bound * swing);
    }
}

TEST_CASE("a weight that a slider guides on a block swings for 100 periods without gaining energy")
{
    // The block of 1 kg slides on the floor, against the weight of 1 kg: h w = 0.06.
    Scene s(std::string(kFloor) +
            "<component id='box' type='Shape/Box' half_extents='0.2 0.2 0.2'/>"
            "<component id='b' type='State/RigidBody' mass='1' shape='box' position='0 0 0.2'/>"
            "<component id='w' type='State/RigidBody' mass='1' inertia='0.1 0.1 0.1' position='0.1 0 0.2'/>"
            "<component id='rail' type='Constraint/Slider' a='b' b='w' axis='1 0 0'/>"
            "<component id='s' type='Constraint/SpringDamper' a='b' b='w' anchor_a='-0.5 0 0' length='0.5' stiffness='100'/>" +
            detection(""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double start = energy(s), swing = 0.5 * 100 * 0.01;
    double most = start, least = start;
    for (int i = 0; i < 240 * 44; ++i) s.step(), most = std::fmax(most, energy(s)), least = std::fmin(least, energy(s));
    MESSAGE("energy: " << (most - start) / swing << " " << (least - start) / swing << " of the swing's energy");
    const double bound = 200.0 / (240 * 240);
    CHECK(most - start < bound * swing);
    CHECK(least - start > -bound * swing);
}

TEST_CASE("a spring of any stiffness between blocks on the ground makes no energy")
{
    for (const char* response : kNamed)
        for (const double stiffness : {1e3, 1e4, 1e5, 1e6, 1e7})
        {
            CAPTURE(response);
            CAPTURE(stiffness);
            Scene s(pair_on_spring(response, stiffness, 0, "0.5"));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            const double start = energy(s), swing = 0.5 * stiffness * 1e-4;
            double most = start;
            for (int i = 0; i < 240; ++i) s.step(), most = std::fmax(most, energy(s));
            MESSAGE(response << " " << stiffness << ": " << (most - start) / swing);
            CHECK(most - start < 0.0625 * swing);
            CHECK(energy(s) - start < -0.1 * swing);  // friction takes it
            CHECK(length(s.vec("a", "position") - Vec3{0, 0, 0.25}) < 0.02);
        }
}

TEST_CASE("a strong damper between blocks on the ground takes their energy and gives none")
{
    // h c / m = 0.1 to 6; the blocks part at 2 m/s, and the damper stops that within exp(-2 c t / m).
    for (const double damping : {24.0, 240.0, 1400.0})
    {
        CAPTURE(damping);
        Scene s(pair_on_spring("", 0, damping, "0"));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        REQUIRE(s.ask(simulation::SetOperation{"b", "linear_velocity", Vec3{2, 0, 0}}).done);
        double last = 2;
        for (int i = 0; i < 120; ++i)
        {
            s.step();
            const double apart = s.vec("b", "linear_velocity").x - s.vec("a", "linear_velocity").x;
            CHECK(std::fabs(apart) <= std::fabs(last) + 1e-12);
            last = apart;
        }
        CHECK(std::fabs(last) < 1e-9);
        CHECK(s.vec("a", "linear_velocity").x == doctest::Approx(1).epsilon(1e-9));
    }
}

TEST_CASE("a block on stiff feet rides on a platform that moves: it is where the platform is in each part of the step")
{
    // The platform rises with 0.5 m/s; the weight on the spring of 2e5 N/m (h w = 1.9) rides along.
    Scene s(
        "<component id='plate' type='Shape/Box' half_extents='1 1 0.05'/><component id='box' type='Shape/Box' half_extents='0.2 0.2 0.2'/>"
        "<component id='lift' type='State/Kinematic' shape='plate' position='0 0 -0.05' linear_velocity='0 0 0.5'/>"
        "<component id='b' type='State/RigidBody' mass='1' shape='box' position='0 0 0.2' linear_velocity='0 0 0.5'/>"
        "<component id='w' type='State/RigidBody' mass='1' position='0 0 0.7' inertia='0.1 0.1 0.1' linear_velocity='0 0 0.5'/>"
        "<component id='s' type='Constraint/SpringDamper' a='b' b='w' length='0.5' stiffness='2e5' damping='20'/>"
        "<component id='c' type='CDetection/ODE' between='b' against='lift' resolution='Resolution/None'/>"
        "<component id='g' type='Field/Gravity' between='b w'/>");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double worst = 0;
    for (int i = 0; i < 240; ++i)
    {
        s.step();
        worst = std::fmax(worst, std::fabs(s.vec("b", "position").z - s.vec("lift", "position").z - 0.25));
    }
    MESSAGE("gap or overlap: " << worst << " m");
    CHECK(worst < 1e-5);
    CHECK(s.vec("w", "linear_velocity").z == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("a cloth of stiff springs falls on a ball and makes no energy")
{
    const int n = 8;
    const double apart = 0.1;
    std::string all = std::string(kFloor) +
                      "<component id='dot' type='Shape/Sphere' radius='0.02'/><component id='round' type='Shape/Sphere' radius='0.3'/>"
                      "<component id='ball' type='State/Static' shape='round' position='0.35 0.35 0.3'/>";
    const auto name = [](int i, int j) { return "p" + std::to_string(i) + "." + std::to_string(j); };
    const auto spring = [&](int i, int j, int k, int l)
    {
        if (k >= n || l >= n || l < 0) return;
        all += "<component type='Constraint/SpringDamper' id='" + name(i, j) + "-" + name(k, l) + "' a='" + name(i, j) + "' b='" +
               name(k, l) + "' stiffness='2000' damping='0.02'/>";
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            all += "<component id='" + name(i, j) + "' type='State/RigidBody' mass='0.005' shape='dot' position='" + text(apart * i) + " " +
                   text(apart * j) + " 0.65'/>";
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) spring(i, j, i + 1, j), spring(i, j, i, j + 1), spring(i, j, i + 1, j + 1), spring(i, j, i + 1, j - 1);
    Scene s(all + detection("", "0.3"));
    s.warnings_expected = true;  // a solver that takes short internal steps says so
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double start = energy(s);
    double most = start, longest = 0;
    for (int i = 0; i < 240; ++i)
    {
        s.step(), most = std::fmax(most, energy(s));
        for (int k = 0; k + 1 < n; ++k)
            longest = std::fmax(longest, length(s.vec(name(k, 3), "position") - s.vec(name(k + 1, 3), "position")));
    }
    MESSAGE("energy from " << start << " J to " << energy(s) << " J, most " << most << " J; longest side " << longest << " m");
    // Where the first points have met the ball by the end of a step, correcting their overlap of up to 4 mm stretches springs.
    CHECK(most < start + 6e-3);
    CHECK(energy(s) < start - 0.1);
    CHECK(longest < 1.1 * apart);
}

TEST_CASE("a force that no number of parts makes stable is told, once")
{
    Scene s(pair_on_spring("", 1e9, 0, "0.5"));
    s.warnings_expected = s.keep_events = true;
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(5);
    int told = 0;
    for (const Event& e : s.events)
        if (e.kind == "force.stiff")
        {
            ++told;
            CHECK(e.component == s.simulation().world().find("s"));
            CHECK(has(e.message, "divided into"));
        }
    CHECK(told == 1);
}
