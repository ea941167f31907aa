// Springs, dampers and servos between jointed bodies that touch something. A manager evaluates each force once in a step and finds how it
// changes together with the impulses of joints and contacts (Phase::Linearize, simulation/rows/force_changes.h), so the step is stable for
// any stiffness. A rotor on a block that stands on a floor without friction is a torsional oscillator of two inertias, with closed forms.
//
//   spring, h w <= 0.08       order 2 in h; energy within (h w)^2 of the swing's (SoftStep: order 1, and loses it)
//   damper, any h c / J       the speed after n steps is exp(-n h c / J), to rounding (exponential fitting)
//   limited servo             exactly its largest torque until it gets near, then exactly its law
//   arm of 2 to 5 links over a box, 10 to 1e6 N m/rad: no faster than in its first swing, joints hold to 1e-4 m, and it comes to rest
#include "support/gravity.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

const char* const kFloor = "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>";
const char* const kBox = "<component id='box' type='Shape/Box' half_extents='0.2 0.2 0.2'/>";
const char* const kSoft = "response.manager='Manager/SoftStep'";
const char* const kManagers[] = {"", "response.manager='Manager/Direct'", "response.manager='Manager/SequentialImpulse'", kSoft};

std::string detection(const std::string& manager, const std::string& friction)
{
    return std::string("<component id='c' type='CDetection/ODE' between='*' ") + (manager.empty() ? "" : "response='Response/Rows' ") +
           manager + " response.friction='" + friction + "'/><component id='g' type='Field/Gravity' between='*'/>";
}

/// kg m^2, about the vertical: of the block and of the rotor; and 1 / J of both against each other.
constexpr double kBlock = 0.08, kRotor = 0.02, kMobility = 1 / kBlock + 1 / kRotor;

/// The rotor turns about the vertical on a block of 1 kg that stands on the floor; `drive`: what acts between them.
std::string rotor_on_block(const std::string& manager, const std::string& drive)
{
    return std::string(kFloor) + kBox + body("b", 1, {kBlock, kBlock, kBlock}, {0, 0, 0.2}, "shape='box'") +
           body("r", 0.5, {kRotor, kRotor, kRotor}, {0, 0, 0.2}) + joint("pin", "Hinge", "b", "r", "axis='0 0 1'") + drive +
           detection(manager, "0");
}

std::string spring(double stiffness, double damping, double rest)
{
    return joint("s", "TorsionSpring", "b", "r",
                 "axis='0 0 1' stiffness='" + text(stiffness) + "' damping='" + text(damping) + "' rest='" + text(rest) + "'");
}

double energy(const Scene& s)
{
    const simulation::Totals totals = s.simulation().totals();
    return totals.kinetic + totals.stored;
}

double relative_speed(const Scene& s) { return s.vec("r", "angular_velocity").z - s.vec("b", "angular_velocity").z; }

constexpr double kSwing = 0.1;  // rad

/// rad: the largest difference from kSwing (1 - cos(w t)) in 2 s.
double error_of(const std::string& manager, int steps_per_second)
{
    const double w = 10;
    Scene s(rotor_on_block(manager, spring(w * w / kMobility, 0, kSwing)), dt(steps_per_second));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double worst = 0;
    for (int i = 1; i <= 2 * steps_per_second; ++i)
    {
        s.step();
        worst = std::fmax(worst, std::fabs(s.real("s", "position") - kSwing * (1 - std::cos(w * s.simulation().time()))));
    }
    return worst;
}

}  // namespace

TEST_CASE("a rotor that swings on a block on the floor: second order, with every algorithm that holds contacts")
{
    for (const char* manager : kManagers)
    {
        CAPTURE(std::string(manager));
        const double coarse = error_of(manager, 120), fine = error_of(manager, 240);
        MESSAGE(std::string(manager) << ": " << coarse << " rad, " << fine << " rad");
        CHECK(coarse < (manager == kSoft ? 1e-2 : 1.3e-3));
        CHECK(coarse / fine > (manager == kSoft ? 1.9 : 3.8));
    }
}

TEST_CASE("a torsion spring of any stiffness on a block on the floor makes no energy")
{
    for (const char* manager : kManagers)
        for (const double stiffness : {1.0, 1e2, 1e4, 1e6, 1e8})
        {
            CAPTURE(std::string(manager));
            CAPTURE(stiffness);
            // Small enough that the rotor turns by less than half a turn in a step.
            const double rest = 1e-2 * kSwing;
            Scene s(rotor_on_block(manager, spring(stiffness, 0, rest)));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            const double start = energy(s), swing = 0.5 * stiffness * rest * rest;
            double most = start;
            for (int i = 0; i < 2400; ++i) s.step(), most = std::fmax(most, energy(s));
            MESSAGE(std::string(manager) << " " << stiffness << ": " << (most - start) / swing << " " << (energy(s) - start) / swing);
            CHECK(most - start < 1e-8 * swing + 1e-9);  // J, of the block, which falls by rounding
            if (manager != kSoft) CHECK(energy(s) - start > -1e-5 * swing);
        }
}

TEST_CASE("a damper on a block on the floor slows the rotor down by exp(-h c / J) in each step, however strong it is")
{
    for (const char* manager : kManagers)
        for (const double damping : {1e-3, 0.02, 0.3, 4.0, 50.0, 1e4, 1e8})
        {
            CAPTURE(std::string(manager));
            CAPTURE(damping);
            Scene s(rotor_on_block(manager, spring(0, damping, 0)));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            REQUIRE(s.ask(simulation::SetOperation{"r", "angular_velocity", Vec3{0, 0, 2}}).done);
            double worst = 0;
            for (int i = 1; i <= 24; ++i)
            {
                s.step();
                const double exact = 2 * std::exp(-s.simulation().time() * damping * kMobility);
                worst = std::fmax(worst, std::fabs(relative_speed(s) - exact));
            }
            MESSAGE(std::string(manager) << " " << damping << ": " << worst << " rad/s");
            CHECK(worst < 1e-8);
            // The angle is of order 2 for soft dampers. A stiff one lets the rotor turn by J / c times its speed, far less than in a step.
            const double turned = 2 / (damping * kMobility) * (1 - std::exp(-0.1 * damping * kMobility));
            const double z = damping * kMobility / 240, part = 2.0 / 240;
            CHECK(std::fabs(s.real("s", "position") - turned) < part * std::fmin(2 * z, std::fmin(1.0, 2 / z)));
            CHECK(s.vec("b", "angular_velocity").z * kBlock + s.vec("r", "angular_velocity").z * kRotor == doctest::Approx(2 * kRotor));
        }
}

TEST_CASE("a servo on a block on the floor gives no more than its largest torque, and all of it until it gets near")
{
    // 1e5 N m/rad at 1000 N m s/rad: h c / J is 260. Half a radian at 2 N m takes sqrt(2 x 0.5 / (2 / J)) = 0.09 s without braking.
    for (const char* manager : kManagers)
    {
        CAPTURE(std::string(manager));
        Scene s(
            rotor_on_block(manager, joint("s", "Actuator", "b", "r",
                                          "axis='0 0 1' gain='1e5' bias='0 -1e5 -1000' control='0.5' force_lower='-2' force_upper='2'")));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const double rate = 2 * kMobility;
        while (s.simulation().time() < 0.0375) s.step();
        CHECK(relative_speed(s) == doctest::Approx(rate * s.simulation().time()).epsilon(manager == kSoft ? 2e-3 : 1e-9));
        double fastest = 0;
        for (int i = 0; i < 480; ++i) s.step(), fastest = std::fmax(fastest, std::fabs(relative_speed(s)));
        MESSAGE(std::string(manager) << ": " << s.real("s", "position") << " rad, " << relative_speed(s) << " rad/s");
        CHECK(fastest < std::sqrt(2 * rate * 0.5));
        CHECK(std::fabs(s.real("s", "position") - 0.5) < 1e-4);
        CHECK(std::fabs(relative_speed(s)) < 1e-6);
    }
}

namespace
{

const char* const kFreeBox =
    "<component id='box2' type='Shape/Box' half_extents='0.1 0.1 0.1'/>"
    "<component id='free' type='State/RigidBody' mass='1' shape='box2' position='0.5 0 0.1'/>";

/// A row of links, each with a servo at its hinge, told to bend down over what `below` declares.
std::string arm(int links, double stiffness, double damping, const std::string& manager, const std::string& below)
{
    std::string all = "<component id='link' type='Shape/Capsule' radius='0.03' length='0.2'/>" + below;
    const double length = 0.3;
    for (int i = 0; i < links; ++i)
    {
        const std::string id = std::to_string(i), before = i > 0 ? "l" + std::to_string(i - 1) : "";
        const std::string pin = "axis='0 1 0' anchor='" + text(length * i) + " 0 0.3'";
        all += "<component id='l" + id + "' type='State/RigidBody' mass='" + text(1.0 / (i + 1)) + "' shape='link' position='" +
               text(length * (i + 0.5)) + " 0 0.3' orientation='axis 0 1 0 90 deg'/>";
        all += joint("h" + id, "Hinge", before, "l" + id, pin);
        all += joint("m" + id, "Actuator", before, "l" + id,
                     pin + " gain='" + text(stiffness) + "' bias='0 " + text(-stiffness) + " " + text(-damping) + "' control='" +
                         text(i > 0 ? 0.4 : 0.6) + "'");
    }
    return all + detection(manager, "0.6");
}

}  // namespace

TEST_CASE("an arm whose servos press it on a box makes no energy, keeps its joints and comes to rest")
{
    for (const char* manager : kManagers)
        for (const int links : {2, 3, 5})
            for (const auto& [stiffness, damping] : {std::pair{10.0, 1.0}, {100.0, 10.0}, {1e3, 50.0}, {4500.0, 450.0}, {1e6, 1e5}})
            {
                const bool sweeps = std::string(manager).find("Seq") != std::string::npos || manager == kSoft;
                // Sweeps do not hold contacts against servos that are stiffer still, and say so.
                if (sweeps && stiffness > 1e4 && manager != kSoft) continue;
                CAPTURE(std::string(manager));
                CAPTURE(links);
                CAPTURE(stiffness);
                Scene s(arm(links, stiffness, damping, manager, std::string(kFloor) + kFreeBox));
                s.warnings_expected = sweeps;
                REQUIRE_MESSAGE(s.loaded(), s.error());
                double fastest = 0, apart = 0;
                for (int i = 0; i < 720; ++i)
                {
                    s.step();
                    for (int k = 0; k < links; ++k)
                    {
                        const std::string id = std::to_string(k);
                        fastest = std::fmax(fastest, length(s.vec("l" + id, "linear_velocity")));
                        apart = std::fmax(apart, s.real("h" + id, "position_error"));
                    }
                }
                double last = 0;
                for (int k = 0; k < links; ++k) last = std::fmax(last, length(s.vec("l" + std::to_string(k), "linear_velocity")));
                MESSAGE(std::string(manager) << " " << links << " links, " << stiffness << " N m/rad: fastest " << fastest
                                             << " m/s, at last " << last << ", joints apart by " << apart);
                CHECK(fastest < 60);
                CHECK(apart < (sweeps ? 5e-4 : 1e-4));
                if (!(sweeps && manager != kSoft) || stiffness <= 100) CHECK(last < 1e-2);
            }
}

TEST_CASE("a stop and a weak motor on a block on the floor hold against a servo that is far stiffer than the block and the rotor")
{
    // h (h k + c) is 300 times 1 / (1 / kBlock + 1 / kRotor). The servo is told to turn to 0.5 rad, and the stop is at 0.2 rad.
    const std::string servo =
        joint("s", "Actuator", "b", "r", "axis='0 0 1' gain='1e4' bias='0 -1e4 -1000' control='0.5' force_lower='-20' force_upper='20'");
    const std::string stop = joint("stop", "Limit", "b", "r", "axis='0 0 1' upper='0.2' manager='m'");
    // 2 N m against the servo's damping, 50 N m s/rad: it turns at 0.04 rad/s, not at the 1 rad/s that it is told.
    const std::string damper = spring(0, 50, 0);
    const std::string motor = joint("motor", "Motor", "b", "r", "axis='0 0 1' speed='1' max_effort='2' manager='m'");
    for (const char* type : {"Automatic", "Direct", "SequentialImpulse", "SoftStep"})
    {
        CAPTURE(std::string(type));
        const std::string manager = "<component id='m' type='Manager/" + std::string(type) + "'/>";
        const char* const named = "response.manager='m'";
        Scene stopped(manager + rotor_on_block(named, servo + stop));
        REQUIRE_MESSAGE(stopped.loaded(), stopped.error());
        stopped.run(1);
        MESSAGE(std::string(type) << ": " << stopped.real("s", "position") - 0.2 << " rad, " << relative_speed(stopped) << " rad/s");
        CHECK(std::fabs(stopped.real("s", "position") - 0.2) < 1e-6);
        CHECK(std::fabs(relative_speed(stopped)) < 1e-6);
        CHECK(stopped.vec("stop", "torque").z == doctest::Approx(-20).epsilon(1e-4));
        Scene driven(manager + rotor_on_block(named, damper + motor));
        REQUIRE_MESSAGE(driven.loaded(), driven.error());
        driven.run(1);
        MESSAGE(std::string(type) << ": " << relative_speed(driven) << " rad/s");
        CHECK(relative_speed(driven) == doctest::Approx(0.04).epsilon(type == std::string("SoftStep") ? 1e-3 : 1e-6));
    }
}

TEST_CASE("a stiff arm that touches nothing is stepped by its joints: implicitly, and as exactly as by many short steps")
{
    for (const int links : {2, 6})
    {
        CAPTURE(links);
        Scene usual(arm(links, 1e3, 50, "", "")),
            fine(solver_is("DormandPrince54' relative_tolerance='1e-12") + arm(links, 1e3, 50, "", ""));
        REQUIRE_MESSAGE(usual.loaded(), usual.error());
        REQUIRE_MESSAGE(fine.loaded(), fine.error());
        usual.run(0.25), fine.run(0.25);
        double apart = 0;
        for (int i = 0; i < links; ++i)
        {
            const std::string id = "l" + std::to_string(i);
            apart = std::fmax(apart, length(usual.vec(id, "position") - fine.vec(id, "position")));
        }
        MESSAGE(links << " links: " << apart << " m, " << std::get<std::string>(usual.get("solver", "reason")));
        CHECK(apart < 1e-7);
        constexpr std::int64_t kExplicit = 32 + 64;  // DormandPrince54, and RungeKutta4 in parts
        CHECK((std::get<std::int64_t>(usual.get("solver", "methods")) & kExplicit) == 0);
    }
}

// A manager leaves speeds that fit the hinges where these were when it collected their rows. The next impact projects them onto the hinges
// of its time (0.25 J of 129 J here).
TEST_CASE("an arm that hits a falling box again in a step in which a manager held both loses no energy that the ledger does not explain")
{
    Scene s(arm(6, 1e3, 50, "", kFreeBox));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.run(0.25);
    const simulation::Totals totals = s.simulation().totals();
    MESSAGE("kinetic ", totals.kinetic, " J, work ", totals.work, " J");
    CHECK(s.count("contact.impact") > 1);
    CHECK(std::fabs(totals.kinetic - totals.work) < 1e-3);
}
