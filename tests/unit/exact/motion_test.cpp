// Closed forms against independently computed digits (113-bit arithmetic, or 30-digit formulas).
#include <numbers>

#include "exact/motions.h"
#include "scenes.h"
#include "support/text.h"
#include "world/principal_axes.h"

using namespace plab;
using namespace plab::exact;
using plab::test::attitude_error;
using plab::test::distance;
using plab::test::exact_at;
using plab::test::has;
using plab::test::near;
using plab::test::refusal;
using plab::test::Scene;
using plab::world::principal_axes, plab::world::PrincipalAxes;

namespace
{

std::string lua(const std::string& roles, const std::string& parameters, const std::string& force)
{
    return "<component id='script' type='Script/Lua' " + roles + "><param name='parameters'>" + parameters +
           "</param><param name='code'>function force(t, state) " + force + " end</param></component>";
}

const std::string kOrbit =
    "<component id='planet' type='State/RigidBody' mass='1' inertia='1 1 1' position='0.1 0 0' linear_velocity='0 "
    "4.3588989435406735522 0'/>";

}  // namespace

TEST_CASE("elliptic functions: known values, the limits, and the inverse")
{
    CHECK(near(quarter_period(0.5), 1.85407467730137191843, 1e-15));
    CHECK(near(quarter_period(1), std::numbers::pi / 2, 1e-15));
    CHECK(near(quarter_period(1e-10), 12.8992198263876, 1e-13));  // ln(4/sqrt(mc)) + ...
    const Jacobi j = jacobi(0.7, 0.5);
    CHECK(near(elliptic_f(std::atan2(j.sn, j.cn), 0.5), 0.7, 1e-15));
    CHECK(near(j.dn * j.dn + 0.5 * j.sn * j.sn, 1, 1e-15));
    CHECK(near(jacobi(0.7, 0).sn, std::tanh(0.7), 1e-15));
    CHECK(near(jacobi(0.7, 1).cn, std::cos(0.7), 1e-15));
    CHECK(near(amplitude(9, 0.5) - amplitude(9 - 4 * quarter_period(0.5), 0.5), 2 * std::numbers::pi, 1e-14));
    CHECK(near(elliptic_f(2.5, 0.3), 2 * quarter_period(0.3) - elliptic_f(std::numbers::pi - 2.5, 0.3), 1e-14));
}

TEST_CASE("principal axes of a matrix that is not diagonal")
{
    const Mat3 inertia{{{2, 0.3, -0.2}, {0.3, 3, 0.4}, {-0.2, 0.4, 5}}};
    const PrincipalAxes axes = principal_axes(inertia);
    const Mat3 R = rotation_matrix(axes.q_BP);
    const Mat3 back = R * Mat3::diagonal(axes.moments.x, axes.moments.y, axes.moments.z) * transposed(R);
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) CHECK(near(back(i, k), inertia(i, k), 1e-14));
    CHECK(axes.moments.x < axes.moments.y);
    CHECK(axes.moments.y < axes.moments.z);
    const PrincipalAxes other = reversed(axes);
    CHECK(other.moments.x == axes.moments.z);
    CHECK(near(dot(cross(rotate(other.q_BP, {1, 0, 0}), rotate(other.q_BP, {0, 1, 0})), rotate(other.q_BP, {0, 0, 1})), 1, 1e-15));
}

TEST_CASE("A2: the torque-free box at t = 5 and t = 100")
{
    const Scene s(
        "<component id='shape' type='Shape/Box' half_extents='0.1 0.2 0.3'/>"
        "<component id='box' type='State/RigidBody' mass='1' shape='shape' angular_velocity='1 2 3'/>");
    for (const auto& [t, w_B, q] :
         {std::tuple(5.0, Vec3{0.28086194081460047257, -2.4322669397127980927, 2.7501014800339831926},
                     Quat{-0.36486374298686260041, 0.02356335734258868336, 0.02126200105200739735, -0.93051982491273477482}),
          std::tuple(100.0, Vec3{1.3720842116810150604, -1.4711086382031171752, 3.2213164282561760733},
                     Quat{-.25530488095953154536, -.51834919319232768729, -.09806435894574611863, -.81025731294426601932})})
    {
        const State state = exact_at(s, "torque-free", "box", t);
        CHECK(attitude_error(q, state.orientation) < 1e-14 * (1 + t));
        CHECK(distance(rotate(conjugate(state.orientation), state.angular_velocity), w_B) < 1e-14 * (1 + t));
    }
}

TEST_CASE("A3: close to the separatrix, and the axes in another order")
{
    const Scene s("<component id='nut' type='State/RigidBody' mass='1' inertia='3 2 1' angular_velocity='1e-3 10 1e-3'/>");
    const State state = exact_at(s, "torque-free", "nut", 10);
    const Vec3 w_B = rotate(conjugate(state.orientation), state.angular_velocity);
    CHECK(distance(w_B, {9.1429206965016778e-3, -9.9999876110424964, 1.5772729522424334e-2}) < 1e-9);
    const Scene sphere("<component id='nut' type='State/RigidBody' mass='1' inertia='2 2 2' angular_velocity='1 2 3'/>");
    CHECK(distance(exact_at(sphere, "torque-free", "nut", 3).angular_velocity, {1, 2, 3}) < 1e-15);
    const Scene top("<component id='nut' type='State/RigidBody' mass='1' inertia='1 1 2' angular_velocity='1 0 3'/>");
    // Precession rate of a symmetric top in the body: (I3 - I1) w3 / I1.
    const State turned = exact_at(top, "torque-free", "nut", 0.4);
    const Vec3 w = rotate(conjugate(turned.orientation), turned.angular_velocity);
    CHECK(near(w.x, std::cos(1.2), 1e-14));
    CHECK(near(w.y, std::sin(1.2), 1e-14));
    const Scene middle("<component id='nut' type='State/RigidBody' mass='1' inertia='1 2 3' angular_velocity='0 5 0'/>");
    CHECK(distance(exact_at(middle, "torque-free", "nut", 3).angular_velocity, {0, 5, 0}) < 1e-15);
}

TEST_CASE("A6: Kepler's ellipse of eccentricity 0.9")
{
    const Scene s(kOrbit + lua("driven='planet'", "<entry name='mu'>1</entry>", ""));
    const State state = exact_at(s, "kepler", "planet", 10);
    CHECK(distance(state.position, {-1.8538537094055792, -.130885404839925551, 0}) < 1e-13);
    CHECK(distance(exact_at(s, "kepler", "planet", 2 * std::numbers::pi).position, {0.1, 0, 0}) < 1e-12);
}

TEST_CASE("B1: the damped oscillator, weak, critical and over-damped")
{
    const std::string mass = "<component id='m' type='State/RigidBody' mass='1' inertia='1 1 1' position='1 0 0'/>";
    const Scene s(mass + lua("driven='m'", "<entry name='stiffness'>100</entry><entry name='damping'>1</entry>", ""));
    CHECK(near(exact_at(s, "oscillator", "m", 0.3).position.x, -.84539188273933843, 1e-14));
    CHECK(near(exact_at(s, "oscillator:damping=20", "m", 0.3).position.x, std::exp(-3.0) * 4, 1e-15));
    // r1, r2 = -2, -50: x = (50 e^-2t - 2 e^-50t)/48.
    const State over = exact_at(s, "oscillator:damping=52", "m", 0.3);
    CHECK(near(over.position.x, (50 * std::exp(-0.6) - 2 * std::exp(-15.0)) / 48, 1e-15));
    CHECK(near(over.velocity.x, 100 * (std::exp(-15.0) - std::exp(-0.6)) / 48, 1e-14));
}

TEST_CASE("a pendulum conserves its energy, is periodic, and rotates if it is fast enough")
{
    const auto scene = [](const std::string& speed)
    {
        return Scene("<component id='a' type='State/Shaft' inertia='2' angle='2.5' angular_velocity='" + speed + "'/>" +
                     lua("driven='a'", "<entry name='weight_moment'>8</entry>", ""));
    };
    const Scene slow = scene("0.3"), fast = scene("3");
    for (const Scene* s : {&slow, &fast})
    {
        const double start = 0.5 * 2 * s->spin("a") * s->spin("a") - 8 * std::cos(2.5);
        for (const double t : {0.1, 1.0, 7.0})
        {
            const State x = exact_at(*s, "pendulum", "a", t), y = exact_at(*s, "pendulum", "a", t + 1e-6);
            CHECK(near(x.speed * x.speed - 8 * std::cos(x.angle), start, 1e-13));
            CHECK(std::fabs((y.angle - x.angle) / 1e-6 - 0.5 * (x.speed + y.speed)) < 1e-8);
        }
        CHECK(near(exact_at(*s, "pendulum", "a", 0).angle, 2.5, 1e-14));
    }
    CHECK(exact_at(fast, "pendulum", "a", 20).angle > 4 * std::numbers::pi);
    // T = 4 K(sin^2(theta0/2)) / w0 for a start at rest.
    const Scene rest = scene("0");
    CHECK(near(exact_at(rest, "pendulum", "a", 4 * quarter_period(std::cos(1.25) * std::cos(1.25)) / 2).angle, 2.5, 1e-13));
}

TEST_CASE("a bouncing ball comes to rest at the sum of its flight times")
{
    const Scene s = Scene::file("scenes/studies/bounce.xml");
    const double first = std::sqrt(2 / 9.81), up = 0.8 * 9.81 * first;
    CHECK(near(exact_at(s, "bounce", "ball", first + 0.1).position.z, 0.1 + up * 0.1 - 0.5 * 9.81 * 0.01, 1e-15));
    // t1 (1 + 2e/(1 - e)) = 9 t1.
    CHECK(exact_at(s, "bounce", "ball", 9.001 * first).velocity.z == 0);
    const auto solution = make_solution("bounce", s.simulation(), 10);
    REQUIRE(solution.ok());
    REQUIRE((*solution)->contacts(1).size() == 1);
    CHECK(near((*solution)->contacts(1)[0].time, first, 1e-15));
}

TEST_CASE("a scene that a closed form does not describe is refused with the reason")
{
    const Scene bounce = Scene::file("scenes/studies/bounce.xml"), box = Scene::file("scenes/studies/free_box.xml");
    CHECK(has(refusal(bounce, "parabola"), "bodies may collide"));
    CHECK(has(refusal(bounce, "slide"), "ball is no box"));
    CHECK(has(refusal(box, "bounce"), "nothing collides"));
    CHECK(has(refusal(box, "kepler"), "mu"));
    CHECK(has(refusal(box, "gears"), "0 couplings"));
    CHECK(has(refusal(box, "torqe-free"), "did you mean 'torque-free'"));
    CHECK(has(refusal(box, "kepler:mu=fast"), "mu=fast"));
    const Scene pushed("<component id='m' type='State/RigidBody' mass='1' inertia='1 1 1'/>" + lua("driven='m'", "", ""));
    CHECK(has(refusal(pushed, "parabola"), "script (Script/Lua) acts too"));
}
