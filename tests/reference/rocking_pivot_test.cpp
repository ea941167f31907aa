// A body that pivots about an edge or a corner which stays in place: a physical pendulum that stands upside down.
//
//   I_o phi'' = m g R sin(phi)      phi: from the vertical to the arm R from the edge to the centre of mass
//
// Reference: Runge-Kutta in small steps. What a step is held to is the midpoint rule (interactions/managers/problem.h), of order 2; with
// levers of the start of the step the body leaves the ground by O(h^2) in each step, falls back on it, and is of order 1.
#include <array>
#include <cmath>

#include "rocking.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr Vec3 kHalf{0.1, 0.2, 0.3};
constexpr double kGravity = 9.81, kEnd = 0.2, kLean = -0.25, kSpin = 1.2;
const double kArm = std::hypot(kHalf.x, kHalf.z);

struct Motion
{
    double angle = 0, spin = 0;  ///< rad, rad/s
};

Motion reference(Motion m, double duration)
{
    constexpr int kSteps = 20000;
    const double h = duration / kSteps, rate = kGravity / (4.0 / 3 * kArm);  // I_o = 4/3 m R^2
    for (int i = 0; i < kSteps; ++i)
    {
        const auto rise = [&](double angle) { return rate * std::sin(angle); };
        const double a1 = rise(m.angle), a2 = rise(m.angle + 0.5 * h * m.spin), a3 = rise(m.angle + 0.5 * h * m.spin + 0.25 * h * h * a1),
                     a4 = rise(m.angle + h * m.spin + 0.5 * h * h * a2);
        m.angle += h * m.spin + h * h / 6 * (a1 + a2 + a3);
        m.spin += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return m;
}

/// A block that leans on its edge along y at the origin, and rises over it. `carried`: m/s, the velocity of everything.
std::string leaning(const std::string& ground, const std::string& shape, const std::string& contact, const Vec3& carried)
{
    const double corner = std::atan2(kHalf.x, kHalf.z), turn = kLean + corner;
    const Vec3 arm{kArm * std::sin(kLean), 0, kArm * std::cos(kLean)};
    return "<component id='gravity' type='Field/Gravity' between='block'/>" + ground +
           "<component id='block' type='State/RigidBody' mass='2' inertia='" +
           text(Vec3{2.0 / 3 * (0.04 + 0.09), 2.0 / 3 * (0.01 + 0.09), 2.0 / 3 * (0.01 + 0.04)}) + "' center_of_mass='0 0 0' position='" +
           text(arm) + "' orientation='axis 0 1 0 " + text(turn) + "' angular_velocity='0 " + text(kSpin) + " 0' linear_velocity='" +
           text(carried + cross({0, kSpin, 0}, arm)) + "' " + shape +
           "/><component id='contact' type='CDetection/ODE' between='block ground' " + "response.friction='2' " + contact + "/>";
}

std::string hull()
{
    std::string points;
    for (int i = 0; i < 8; ++i)
        points += text(Vec3{i & 1 ? kHalf.x : -kHalf.x, i & 2 ? kHalf.y : -kHalf.y, i & 4 ? kHalf.z : -kHalf.z}) + " ";
    return "shape='Shape/ConvexHull' shape.points='" + points + "'";
}

/// Errors of angle (rad) and spin (rad/s) at the end, and how far the edge has moved, m.
std::array<double, 3> errors(const std::string& scene, double h, const Vec3& carried)
{
    Scene s(scene, "dt='" + text(h) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(kEnd);
    const Motion exact = reference({kLean, kSpin}, kEnd);
    const Quat q = s.quat("block", "orientation");
    const double corner = std::atan2(kHalf.x, kHalf.z), angle = 2 * std::atan2(q.y, q.w) - corner;
    const Vec3 edge = s.vec("block", "position") - carried * kEnd - Vec3{kArm * std::sin(angle), 0, kArm * std::cos(angle)};
    return {std::fabs(angle - exact.angle), std::fabs(s.vec("block", "angular_velocity").y - exact.spin), length(edge)};
}

}  // namespace

TEST_CASE("a block that pivots about an edge is stepped with order 2, on every ground and with every exact manager")
{
    const std::string plane = "<component id='ground' type='State/Static' shape='Shape/Plane'/>",
                      box = "' position='0.5 0 -0.5' shape='Shape/Box' shape.half_extents='2 2 0.5'/>",
                      is_box = "shape='Shape/Box' shape.half_extents='" + text(kHalf) + "'";
    const Vec3 carried{1, 0.5, 0};
    struct Case
    {
        std::string name, ground, shape;
        Vec3 carried;
    };
    const std::array cases{
        Case{"plane", plane, is_box, {}}, Case{"hull", plane, hull(), {}},
        Case{"box", "<component id='ground' type='State/Static" + box, is_box, {}},
        Case{"moving box", "<component id='ground' type='State/Kinematic' linear_velocity='" + text(carried) + box, is_box, carried}};
    for (const Case& c : cases)
        for (const std::string manager : {"Direct", "SequentialImpulse", "Automatic"})
            for (const std::string resolution : {"None", "LocalRoot"})
            {
                CAPTURE(c.name);
                CAPTURE(manager + " " + resolution);
                const std::string scene = leaning(
                    c.ground, c.shape,
                    "resolution='Resolution/" + resolution + "' response='Response/Rows' " + "response.manager='Manager/" + manager + "'",
                    c.carried);
                const auto coarse = errors(scene, 0.005, c.carried), fine = errors(scene, 0.0025, c.carried);
                MESSAGE(c.name << " " << manager << " " << resolution << ": angle " << fine[0] << ", spin " << fine[1] << ", edge "
                               << fine[2]);
                CHECK(fine[0] < 1e-5);
                CHECK(fine[1] < 5e-5);
                CHECK(fine[2] < 2e-6);
                CHECK(coarse[1] / fine[1] > 3);
            }
}

TEST_CASE("a wheel that walks on its edges makes no energy from nothing, and no corner that lands falls again")
{
    for (const std::string resolution : {"None", "Speculative", "LocalRoot"})
    {
        CAPTURE(resolution);
        constexpr double h = 1.0 / 240;
        Scene s(wheel({resolution.c_str(), "Rows"}), "dt=\"" + text(h) + "\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        // The spin drops in an impact, which may take two steps, and by less than this in any other step.
        constexpr double kDrop = 0.02;
        double before = s.vec("wheel", "angular_velocity").y, worst = 0;
        int quiet = 1000, walked = 0, again = 0;
        while (s.simulation().time() < 8)
        {
            s.step();
            const double spin = s.vec("wheel", "angular_velocity").y;
            const bool drops = spin < before - kDrop;
            before = spin;
            if (drops && quiet > 1 && quiet < 60) ++again;
            if (drops && quiet >= 60) ++walked;
            quiet = drops ? 0 : quiet + 1;
            const simulation::Totals totals = s.simulation().totals();
            worst = std::max(worst, std::fabs(totals.kinetic - s.simulation().kinetic_at_start() - totals.work));
        }
        MESSAGE(resolution << ": unexplained " << worst << " J, walked " << walked << ", again " << again);
        CHECK(worst < 2.6e-6);
        CHECK(walked >= 7);
        CHECK(again == 0);
    }
}
