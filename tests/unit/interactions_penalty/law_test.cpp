// The laws of contacts that are springs: force, damping for a restitution, friction's cone, energy.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "response/penalty.h"
#include "response/penalty_law.h"
#include "support/random_poses.h"

using namespace plab;
using namespace plab::response;
using namespace plab::test;

namespace
{

/// A ball of 1 kg on a fixed floor, and one contact between them.
struct Bench
{
    Bodies bodies;
    Shafts shafts;
    Wrenches wrenches;
    Contact contact;

    Bench()
    {
        bodies.motion = {Motion::Dynamic, Motion::Static};
        bodies.position = {{0, 0, 0.1}, {}}, bodies.orientation.resize(2), bodies.velocity.resize(2), bodies.angular_velocity.resize(2);
        bodies.angular_momentum.resize(2), bodies.mass = {1, 1}, bodies.inverse_mass = {1, 0}, bodies.needle = {0, 0};
        bodies.inertia_B.assign(2, Mat3::identity()), bodies.inverse_inertia_B = {Mat3::identity(), Mat3{}}, bodies.center_B.resize(2);
        bodies.material = {0, 0}, bodies.shapes.resize(2);
        wrenches.bind(bodies, shafts);
        wrenches.force.assign(2, {}), wrenches.torque.assign(2, {});
        contact.a = {Facet::Body, 0}, contact.b = {Facet::Body, 1};
        contact.normal = {0, 0, -1}, contact.restitution = 1;
    }
    template <class Table>
    Table make()
    {
        Table table;
        Schema schema;
        table.describe(schema);
        for (ColumnBase* c : schema.columns()) c->resize(1);
        for (const Field& f : schema.fields())
            if (f.fallback.index() != 0 && f.kind == FieldKind::Param) f.column->set(0, f.fallback);
        return table;
    }
    /// Force on the ball.
    template <auto Touch, class Table>
    Vec3 push(Table& table)
    {
        wrenches.force.assign(2, {}), wrenches.torque.assign(2, {});
        Impact impact;
        Contact c = contact;
        impact.dt = 1, impact.contacts = {&c, 1};
        Touch({}, 0, table, bodies, wrenches, impact);
        out = c;
        CHECK(length(wrenches.force[0] + c.impulse) <= 1e-15 * length(c.impulse));
        CHECK(wrenches.force[1] == Vec3{});
        return wrenches.force[0];
    }
    Contact out;
};

/// Share of the approach speed that m x'' = -f(x, x') returns, by RK4 with n steps per 1/w until `over` reports the end.
template <class Force, class Over>
double rebound(Force f, Over over)
{
    double x = 0, v = 1;
    const double h = 1e-4;
    const auto slope = [&](double xx, double vv) { return -f(xx, vv); };
    for (int i = 0; i < 10'000'000; ++i)
    {
        const double a1 = slope(x, v), a2 = slope(x + 0.5 * h * v, v + 0.5 * h * a1);
        const double a3 = slope(x + 0.5 * h * (v + 0.5 * h * a1), v + 0.5 * h * a2);
        const double a4 = slope(x + h * (v + 0.5 * h * a2), v + h * a3);
        const double nx = x + h * v + h * h / 6 * (a1 + a2 + a3), nv = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
        if (v < 0 && over(nx, nv)) return -nv;
        x = nx, v = nv;
    }
    return NAN;
}

}  // namespace

TEST_CASE("damping ratio for a restitution: closed form and the oscillator itself")
{
    CHECK(ratio_for_restitution(1) == 0);
    CHECK(ratio_for_restitution(0) == 1);
    CHECK(ratio_for_restitution(0.72924761428767) == doctest::Approx(0.1).epsilon(1e-13));
    for (const double e : {0.9, 0.5, 0.2, 0.05})
    {
        CAPTURE(e);
        const double z = ratio_for_restitution(e), y = ratio_for_restitution_without_pull(e), s = loss_for_restitution(e);
        CHECK(rebound([&](double x, double v) { return x + 2 * z * v; }, [](double x, double) { return x <= 0; }) ==
              doctest::Approx(e).epsilon(2e-4));
        CHECK(rebound([&](double x, double v) { return x + 2 * y * v; }, [&](double x, double v) { return x + 2 * y * v <= 0; }) ==
              doctest::Approx(e).epsilon(2e-4));
        CHECK(rebound([&](double x, double v) { return x <= 0 ? 0 : std::pow(x, 1.5) * (1 + s * v); },
                      [](double x, double) { return x <= 0; }) == doctest::Approx(e).epsilon(2e-4));
    }
    CHECK(ratio_for_restitution_without_pull(1) == 0);
    CHECK(loss_for_restitution(1) == 0);
    CHECK(ratio_for_restitution_without_pull(std::exp(-2.0)) == doctest::Approx(1).epsilon(1e-7));
}

TEST_CASE("a linear contact pushes with k depth + c speed, and stores k depth^2 / 2")
{
    Bench b;
    auto rows = b.make<PenaltyRows>();
    rows.stiffness[0] = 1e4, rows.damping[0] = 7, rows.damping_ratio[0] = 0.1;
    b.contact.depth = 2e-3, b.contact.point = {0, 0, 0};
    b.bodies.velocity[0] = {0, 0, -0.5};
    const Vec3 f = b.push<evaluate_penalty>(rows);
    CHECK(f.z == doctest::Approx(1e4 * 2e-3 + (7 + 0.2 * 100) * 0.5).epsilon(1e-14));
    CHECK(rows.surface.stored[0] == doctest::Approx(0.5 * 1e4 * 4e-6).epsilon(1e-14));
    b.bodies.velocity[0] = {0, 0, 10};
    CHECK(b.push<evaluate_penalty>(rows).z < 0);
    rows.pulls[0] = false;
    CHECK(b.push<evaluate_penalty>(rows).z == 0);
    b.bodies.velocity[0] = {}, b.contact.rest_depth = 2e-3, b.contact.preload = 9.81;
    CHECK(b.push<evaluate_penalty>(rows).z == 9.81);
}

TEST_CASE("a Hertzian contact pushes with k depth^1.5 and never pulls")
{
    Bench b;
    auto rows = b.make<HuntCrossleyRows>();
    rows.stiffness[0] = 1e6, rows.dissipation[0] = 0.3;
    b.contact.depth = 1e-4;
    b.bodies.velocity[0] = {0, 0, -0.5};
    CHECK(b.push<evaluate_hunt_crossley>(rows).z == doctest::Approx(1 * (1 + 0.15)).epsilon(1e-13));
    CHECK(rows.surface.stored[0] == doctest::Approx(1e6 * 1e-10 / 2.5).epsilon(1e-13));
    b.bodies.velocity[0] = {0, 0, 100};
    CHECK(b.push<evaluate_hunt_crossley>(rows).z == 0);
    b.contact.depth = -1e-4;
    CHECK(b.push<evaluate_hunt_crossley>(rows).z == 0);
    b.bodies.velocity[0] = {}, b.contact.rest_depth = -1e-4, b.contact.preload = 9.81;
    CHECK(b.push<evaluate_hunt_crossley>(rows).z == doctest::Approx(9.81).epsilon(1e-14));
}

TEST_CASE("stiction springs stay in Coulomb's cone, equally in all directions")
{
    Bench b;
    auto rows = b.make<PenaltyRows>();
    rows.stiffness[0] = 1e4, rows.surface.tangential_damping_ratio[0] = 0;
    b.contact.depth = 1e-3, b.contact.friction = 0.5;  // 10 N across, 5 N along at the most
    for (int i = 0; i < 12; ++i)
    {
        const double angle = i * std::numbers::pi / 6;
        const Vec3 along{std::cos(angle), std::sin(angle), 0};
        b.contact.stretch = along * 4e-4;
        const Vec3 held = b.push<evaluate_penalty>(rows);
        CHECK(length(Vec3{held.x, held.y, 0} - along * 4.0) < 1e-14);
        CHECK(b.out.stretch == b.contact.stretch);
        b.contact.stretch = along * 7e-4;
        const Vec3 slips = b.push<evaluate_penalty>(rows);
        CHECK(length(Vec3{slips.x, slips.y, 0} - along * 5.0) < 1e-14);
        CHECK(length(b.out.stretch - along * 5e-4) < 1e-18);
    }
}

TEST_CASE("a stiction spring and its damper never give energy, wherever the point goes and however Coulomb's bound changes")
{
    std::uint64_t seed = 3;
    double least = HUGE_VAL;
    for (int run = 0; run < 200; ++run)
    {
        const double k = uniform(seed, 1, 100), c = uniform(seed, 0, 20), h = 1e-5;
        Vec3 stretch, slip = random_vector(seed, 1);
        double lost = 0;
        for (int i = 0; i < 2000; ++i)
        {
            if (i % 100 == 0) slip = random_vector(seed, 1);
            slip.z = 0;
            const double limit = 0.01 * (1 + std::sin(0.02 * i + run));
            const double before = 0.5 * k * length_squared(stretch);
            const SurfaceForce f = surface_force(k, c, limit, stretch + slip * h, slip);
            CHECK(length(f.force) <= limit * (1 + 1e-14));
            CHECK(f.stored == 0.5 * k * length_squared(f.stretch));
            // Work of the bodies against the force, less what the spring has taken up. The spring is loaded within the step: its mean
            // force is within h of the present one.
            const double taken = -dot(f.force, slip) * h - (f.stored - before);
            least = std::min(least, (taken + 0.5 * k * length_squared(slip) * h * h) / h);
            lost += taken;
            stretch = f.stretch;
        }
        CHECK(lost > 0);
    }
    CHECK(least >= -1e-12);
}
