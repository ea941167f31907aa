// Solids that slide on corners and round ends in bowls and pipes: pendulums about the middle, of order 2.
#include <vector>

#include "exact/motions.h"
#include "sliding.h"
#include "support/gravity.h"
#include "support/mechanical_energy.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

// Turned about y by an angle, in a wall of radius 1 m. Moments are those about y, of 1 kg.
constexpr double kReleased = 0.6;                                      // rad
constexpr double kOfBox = (0.1 * 0.1 + 0.12 * 0.12) / 3;               // kg m^2
constexpr double kOfCapsule = 0.02, kEndRadius = 0.06, kEndsAt = 0.2;  // kg m^2, m, m: as given
constexpr const char* kRoundBowl = "Shape/Bowl' radius='1";
constexpr const char* kPipe = "Shape/Bore' radius='1' height='4' orientation='axis 1 0 0 90 deg";

enum class Kind
{
    Box,
    TwoHalves,
    Capsule,
};

struct Slider
{
    const char* name;
    Kind kind;
    const char* wall;
    double length;                         ///< m, from the middle of the wall to the centre of mass
    double wall_speed = 0, wall_spin = 0;  ///< m/s along y, rad/s about y: of a wall with a prescribed motion
};

double moment_of(const Slider& slider) { return slider.kind == Kind::Capsule ? kOfCapsule : kOfBox; }
Vec3 place(const Slider& slider, double angle) { return Vec3{std::sin(angle), 0, -std::cos(angle)} * slider.length; }

std::string body(const std::string& id, const Slider& slider, double aside, const std::string& shape, const std::string& mass)
{
    return "<component id='" + id + ".shape' type='" + shape + "'/><component id='" + id + "' type='State/RigidBody' shape='" + id +
           ".shape' " + mass + " linear_velocity='0 " + text(slider.wall_speed) + " 0' position='" +
           text(place(slider, kReleased) + Vec3{0, aside, 0}) + "' orientation='axis 0 1 0 " + text(-kReleased) + "'/>";
}

std::string bodies_of(const Slider& slider)
{
    const auto box = [](double half_width) { return "Shape/Box' half_extents='0.1 " + text(half_width) + " 0.12"; };
    switch (slider.kind)
    {
        case Kind::Box:
            return body("body", slider, 0, box(0.07), "mass='1'");
        case Kind::Capsule:
            return body(
                "body", slider, 0,
                "Shape/Capsule' radius='" + text(kEndRadius) + "' length='" + text(2 * kEndsAt) + "' orientation='axis 0 1 0 90 deg",
                "mass='1' inertia='0.004 " + text(kOfCapsule) + " " + text(kOfCapsule) + "'");
        default:
            return body("body", slider, -0.035, box(0.035), "mass='0.5'") + body("right", slider, 0.035, box(0.035), "mass='0.5'") +
                   "<component id='weld' type='Constraint/Fixed' a='body' b='right'/>"
                   "<component id='apart' type='Collision/Exclude' within='body right'/>";
    }
}

/// The id of a wall that moves comes before those of the bodies, so these are second in their contacts.
std::string ground(const Slider& slider)
{
    if (slider.wall_speed == 0 && slider.wall_spin == 0) return "<component id='ground' type='State/Static' shape='wall'/>";
    return "<component id='a wall' type='State/Kinematic' shape='wall' linear_velocity='0 " + text(slider.wall_speed) +
           " 0' angular_velocity='0 " + text(slider.wall_spin) + " 0'/>";
}

/// m and m/s: error after 1.5 s from rest.
double error_of(const Slider& slider, const std::string& manager, int steps_per_second)
{
    constexpr double kTime = 1.5;
    Scene s("<component id='wall' type='" + std::string(slider.wall) + "'/>" + ground(slider) + bodies_of(slider) +
                "<component id='weight' type='Field/Gravity' between='*'/><component id='contact' type='CDetection/ODE' between='*' "
                "resolution='Resolution/None' response='Response/Rows' response.manager='Manager/" +
                manager + "'/>",
            "dt='1/" + std::to_string(steps_per_second) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(kTime);
    double angle = 0, speed = 0;
    exact::PendulumMotion(std::sqrt(kG * slider.length / (slider.length * slider.length + moment_of(slider))), kReleased, 0)
        .at(kTime, angle, speed);
    const Vec3 v = Vec3{std::cos(angle), 0, std::sin(angle)} * (slider.length * speed);
    const Vec3 aside{0, (slider.kind == Kind::TwoHalves ? -0.035 : 0.0) + kTime * slider.wall_speed, 0}, along{0, slider.wall_speed, 0};
    return distance(s.vec("body", "position"), place(slider, angle) + aside) + distance(s.vec("body", "linear_velocity"), v + along);
}

}  // namespace

TEST_CASE("solids slide on corners and round ends in bowls and pipes: order 2")
{
    const double in_bowl = std::sqrt(1 - 0.1 * 0.1 - 0.07 * 0.07) - 0.12, in_pipe = std::sqrt(1 - 0.1 * 0.1) - 0.12,
                 on_ends = std::sqrt((1 - kEndRadius) * (1 - kEndRadius) - kEndsAt * kEndsAt);
    for (const Slider& slider :
         {Slider{"box in a bowl", Kind::Box, kRoundBowl, in_bowl}, Slider{"box in a pipe", Kind::Box, kPipe, in_pipe},
          Slider{"two halves of a box in a bowl", Kind::TwoHalves, kRoundBowl, in_bowl},
          Slider{"capsule in a bowl", Kind::Capsule, kRoundBowl, on_ends}, Slider{"capsule in a pipe", Kind::Capsule, kPipe, on_ends},
          Slider{"box in a bowl that moves", Kind::Box, kRoundBowl, in_bowl, 0.5},
          Slider{"box in a pipe that turns", Kind::Box, kPipe, in_pipe, 0, 1}})
        for (const char* manager : {"Direct", "Automatic"})
        {
            CAPTURE(std::string(slider.name));
            CAPTURE(std::string(manager));
            std::vector<double> errors;
            for (const int n : {60, 120, 240}) errors.push_back(error_of(slider, manager, n));
            MESSAGE("error " << errors.back());
            check_order(errors, 1e-4);
        }
}

TEST_CASE("a can slides on its end over a dome as a box does: no energy is made")
{
    for (const char* shape : {"Shape/Cylinder' radius='0.1' height='0.15", "Shape/Box' half_extents='0.1 0.1 0.075"})
    {
        CAPTURE(std::string(shape));
        Scene s(
            "<component id='dome' type='Shape/Sphere' radius='1'/><component id='ground' type='State/Static' shape='dome'/><component "
            "id='form' type='" +
                std::string(shape) +
                "'/><component id='body' type='State/RigidBody' shape='form' mass='1' position='0 0 1.075' linear_velocity='0.3 0 0'/>"
                "<component id='weight' type='Field/Gravity' between='body'/><component id='contact' type='CDetection/ODE' between='body "
                "ground'/>",
            "dt='1/60'");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const double before = mechanical_energy(s);
        double most = 0;
        for (int i = 1; i <= 60; ++i)
        {
            s.run(i / 60.0);
            most = std::max(most, mechanical_energy(s) - before);
        }
        MESSAGE("made " << most << " J");
        CHECK(most < 5e-4);
        CHECK(s.vec("body", "position").z < 0.9);  // it has slid off
    }
}
