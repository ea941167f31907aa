// C22, Painleve's rod: slender, 1 kg, 1 m, at 60 degrees, its lower end dragged towards -x at 3 m/s with mu = 1.5. There sliding
// has no acceleration: 1 + 3 cos^2 - 3 mu sin cos = -.19856 < 0. What answers is an impact without collision: an impulse that ends
// the slip at once. About its end the rod keeps its angular momentum, so it goes on with w = 3/2 v sin(theta) / L = 3.8971 rad/s.
// Dragged the other way (the mirror image) it slides on, without paradox.
//
// | rung                         | bound                                                                           |
// |------------------------------|---------------------------------------------------------------------------------|
// | Impulse, any resolution      | named once; w after the first step to g h; energy never rises                   |
// | Rows/Direct, any resolution  | the same (Newton's method does not converge there and says so; sweeps answer)   |
// | Rows/SequentialImpulse       | named; finite; it hops, and energy may rise by 0.25 J of 8.76 J, said as not converged |
// | Rows/SoftStep                | named; finite; energy never above the start                                     |
// | Penalty                      | no paradox: the spring gives way (not shown here)                               |
#include <algorithm>
#include <numbers>

#include "impacts.h"

using namespace plab;
using namespace plab::test;

namespace
{
constexpr double kAngle = std::numbers::pi / 3, kFriction = 1.5;

struct Dragged
{
    double spin = 0;  ///< rad/s after the first step
    double rise = 0;  ///< J, most above the start
    double gain = 0;  ///< J, most in one step
    double end = 0;   ///< J, at the end
    bool finite = true;
    std::size_t told = 0;  ///< contact.paradox
};

Dragged drag(const Rung& rung, bool ahead)
{
    const double side = ahead ? 1 : -1, half = std::numbers::pi / 4 - 0.5 * kAngle, radius = 1e-3;
    const Vec3 centre{0.5 * std::cos(kAngle) * side, 0, radius + 0.5 * std::sin(kAngle)};
    Scene s(std::string(kGround) + "<component id=\"rod.shape\" type=\"Shape/Capsule\" radius=\"" + text(radius) + "\" length=\"1\"/>" +
                "<component id=\"rod\" type=\"State/RigidBody\" shape=\"rod.shape\" center_of_mass=\"0 0 0\" inertia=\"" +
                text(Vec3{1.0 / 12, 1.0 / 12, 1e-4}) + "\" orientation=\"" + text(std::cos(half)) + " 0 " + text(side * std::sin(half)) +
                " 0\" " + at(centre, {-3, 0, 0}) + "/>" + gravity("rod") + contact("rod ground", rung, 0, kFriction),
            "dt=\"1/1000\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    const double start = energy(s);
    double before = start;
    Dragged out;
    for (int i = 0; i < 2000; ++i)
    {
        s.step();
        if (i == 0) out.spin = std::fabs(s.vec("rod", "angular_velocity").y);
        out.end = energy(s);
        out.finite = out.finite && std::isfinite(out.end) && std::isfinite(length(s.vec("rod", "angular_velocity")));
        out.rise = std::max(out.rise, out.end - start), out.gain = std::max(out.gain, out.end - before);
        before = out.end;
    }
    out.told = s.count("contact.paradox");
    return out;
}
}  // namespace

TEST_CASE("C22: Painleve's rod: an impulse ends the slip, it is said, and energy does not rise")
{
    for (const Rung& rung : {Rung{"None", "Impulse"}, Rung{"LocalBisection", "Impulse"}, Rung{"LocalRoot", "Impulse"},
                             Rung{"ConservativeAdvancement", "Impulse"}, Rung{"None", "Rows"}, Rung{"Speculative", "Rows"},
                             Rung{"LocalRoot", "Rows"}, Rung{"None", "Rows", "SequentialImpulse"}, Rung{"None", "Rows", "SoftStep"}})
    {
        CAPTURE(rung.name());
        const Dragged ahead = drag(rung, true), behind = drag(rung, false);
        CHECK(ahead.finite);
        CHECK(behind.finite);
        CHECK(ahead.told >= 1);
        CHECK(ahead.told <= 3);
        CHECK(behind.told == 0);
        CHECK(ahead.end < 0.02);  // it lies
        CHECK(behind.end < 0.02);
        const std::string manager = rung.rows() ? rung.manager : "";
        CHECK(ahead.rise < (manager == "SequentialImpulse" ? 0.25 : 1e-12));
        CHECK(behind.rise < (manager == "SequentialImpulse" ? 0.25 : 1e-12));
        MESSAGE(rung.name(), ": w ", ahead.spin, " gain ", ahead.gain, " ", behind.gain, " rise ", ahead.rise, " ", behind.rise, " told ",
                ahead.told, " ", behind.told);
        if (manager == "SequentialImpulse" || manager == "SoftStep") continue;
        CHECK(std::fabs(ahead.spin - 1.5 * 3 * std::sin(kAngle)) < 3 * 9.81e-3);
        CHECK(behind.spin < 0.1);
        CHECK(ahead.gain < 1e-4);
    }
}
