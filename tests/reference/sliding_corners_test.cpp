// Boxes that slide on their corners in bowls and pipes: pendulums about the middle, of order 2.
#include <vector>

#include "exact/motions.h"
#include "sliding.h"
#include "support/gravity.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

// Turned about y by an angle, on corners in a wall of radius 1 m. Moments are those about y.
constexpr double kReleased = 0.6, kOfBox = (0.1 * 0.1 + 0.12 * 0.12) / 3;  // rad; kg m^2 of 1 kg
constexpr const char* kHollow = "Shape/Bowl' radius='1";
constexpr const char* kPipe = "Shape/Bore' radius='1' height='4' orientation='axis 1 0 0 90 deg";

struct Slider
{
    const char* name;
    const char* wall;
    double length;  ///< m, from the middle of the wall to the centre of mass
    bool of_halves = false;
};

Vec3 place(const Slider& slider, double angle) { return Vec3{std::sin(angle), 0, -std::cos(angle)} * slider.length; }

/// A box, or the half of one.
std::string box(const std::string& id, const Slider& slider, double aside, double half_width, double mass)
{
    return "<component id='" + id + ".shape' type='Shape/Box' half_extents='0.1 " + text(half_width) + " 0.12'/><component id='" + id +
           "' type='State/RigidBody' shape='" + id + ".shape' mass='" + text(mass) + "' position='" +
           text(place(slider, kReleased) + Vec3{0, aside, 0}) + "' orientation='axis 0 1 0 " + text(-kReleased) + "'/>";
}

std::string bodies_of(const Slider& slider)
{
    if (!slider.of_halves) return box("body", slider, 0, 0.07, 1);
    return box("left", slider, -0.035, 0.035, 0.5) + box("right", slider, 0.035, 0.035, 0.5) +
           "<component id='weld' type='Constraint/Fixed' a='left' b='right'/><component id='apart' type='Collision/Exclude' within='left "
           "right'/>";
}

/// m and m/s: error after 1.5 s from rest.
double error_of(const Slider& slider, const std::string& manager, int steps_per_second)
{
    constexpr double kTime = 1.5;
    Scene s("<component id='wall' type='" + std::string(slider.wall) + "'/><component id='ground' type='State/Static' shape='wall'/>" +
                bodies_of(slider) +
                "<component id='weight' type='Field/Gravity' between='*'/><component id='contact' type='CDetection/ODE' between='*' "
                "resolution='Resolution/None' response='Response/Rows' response.manager='Manager/" +
                manager + "'/>",
            "dt='1/" + std::to_string(steps_per_second) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(kTime);
    double angle = 0, speed = 0;
    exact::PendulumMotion(std::sqrt(kG * slider.length / (slider.length * slider.length + kOfBox)), kReleased, 0).at(kTime, angle, speed);
    const Vec3 v = Vec3{std::cos(angle), 0, std::sin(angle)} * (slider.length * speed);
    const std::string body = slider.of_halves ? "left" : "body";
    const Vec3 aside{0, slider.of_halves ? -0.035 : 0.0, 0};
    return distance(s.vec(body, "position"), place(slider, angle) + aside) + distance(s.vec(body, "linear_velocity"), v);
}

}  // namespace

TEST_CASE("boxes slide on their corners in bowls and pipes: order 2")
{
    const double in_bowl = std::sqrt(1 - 0.1 * 0.1 - 0.07 * 0.07) - 0.12, in_pipe = std::sqrt(1 - 0.1 * 0.1) - 0.12;
    for (const Slider& slider : {Slider{"in a bowl", kHollow, in_bowl}, Slider{"in a pipe", kPipe, in_pipe},
                                 Slider{"two halves in a bowl", kHollow, in_bowl, true}})
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
