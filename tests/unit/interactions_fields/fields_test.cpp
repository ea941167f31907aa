/// Fields against their closed forms, which bodies they do not affect, and what they report to the ledger.
#include <doctest/doctest.h>

#include <functional>
#include <numbers>

#include "interactions/fields/airflow.h"
#include "interactions/fields/gravity.h"
#include "interactions/fields/loads.h"
#include "plab/plugin.h"
#include "unit/objects/table.h"

using namespace plab;
using namespace plab::fields;
using namespace plab::test;

extern "C" void plab_plugin_register(plab::Registrar& registrar);

namespace
{

constexpr Row kFirst[] = {0};

/// One dynamic body, one static one and one shaft, and the sums of the forces on them.
struct HostTables
{
    Bodies bodies = make_bodies(2);
    Shafts shafts = make_shafts(1);
    Wrenches wrenches{bodies, shafts};
    std::vector<double> power = {0};

    HostTables()
    {
        bodies.motion = {Motion::Dynamic, Motion::Static};
        bodies.mass = {2, 0};
        shafts.motion = {Motion::Dynamic};
        clear();
        wrenches.power = &power;
    }
    void clear()
    {
        wrenches.force.assign(2, {}), wrenches.torque.assign(2, {}), wrenches.shaft_torque.assign(1, 0);
        power[0] = 0;
    }
};

const RefList kBothBodies{{Facet::Body, 0}, {Facet::Body, 1}};

/// Classical Runge-Kutta for v' = a(v), z' = v: the motion that RungeKutta4 computes for a force on one body.
std::pair<double, double> fall(double time, int steps, const std::function<double(double)>& a)
{
    const double h = time / steps;
    double v = 0, z = 0;
    for (int n = 0; n < steps; ++n)
    {
        const double k1 = a(v), k2 = a(v + h / 2 * k1), k3 = a(v + h / 2 * k2), k4 = a(v + h * k3);
        z += h * v + h * h / 6 * (k1 + k2 + k3);
        v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return {v, z};
}

}  // namespace

TEST_CASE("gravity pulls with m g at the centre, and on dynamic bodies only")
{
    HostTables scene;
    TableFixture<GravityRows> gravity;
    gravity.rows.between[0] = kBothBodies;
    scene.bodies.velocity[0] = {0, 1, -3};
    apply_gravity(gravity.context(), kFirst, gravity.rows, scene.bodies, scene.wrenches);
    CHECK(scene.wrenches.force[0] == Vec3{0, 0, -19.62});
    CHECK(scene.wrenches.torque[0] == Vec3{});
    CHECK(scene.wrenches.force[1] == Vec3{});
    CHECK(scene.power[0] == doctest::Approx(58.86).epsilon(1e-15));
}

TEST_CASE("fields do not act on bodies that are not being advanced")
{
    HostTables scene;
    const std::vector<std::uint8_t> inactive = {0, 0};
    TableFixture<GravityRows> gravity;
    TableFixture<DragRows> drag;
    gravity.rows.between[0] = drag.rows.between[0] = kBothBodies;
    drag.rows.between[0].push_back({Facet::Shaft, 0});
    drag.rows.linear[0] = drag.rows.rotational[0] = 1;
    scene.bodies.velocity[0] = {1, 0, 0};
    scene.shafts.speed[0] = 1;
    StepContext context = gravity.context();
    context.active_bodies = inactive, context.active_shafts = inactive;
    apply_gravity(context, kFirst, gravity.rows, scene.bodies, scene.wrenches);
    apply_drag(context, kFirst, drag.rows, scene.bodies, scene.shafts, scene.wrenches);
    CHECK(scene.wrenches.force[0] == Vec3{});
    CHECK(scene.wrenches.shaft_torque[0] == 0);
}

TEST_CASE("drag is linear and quadratic in the velocity against the medium")
{
    HostTables scene;
    TableFixture<DragRows> drag;
    drag.rows.between[0] = {{Facet::Body, 0}, {Facet::Body, 1}, {Facet::Shaft, 0}};
    drag.rows.linear[0] = 0.5;
    drag.rows.quadratic[0] = 0.2;
    drag.rows.rotational[0] = 0.3;
    drag.rows.rotational_quadratic[0] = 0.1;
    drag.rows.medium_velocity[0] = {1, 0, 0};
    scene.bodies.velocity[0] = {4, 4, 0};
    scene.bodies.angular_velocity[0] = {0, 0, -2};
    scene.shafts.speed[0] = -3;
    apply_drag(drag.context(), kFirst, drag.rows, scene.bodies, scene.shafts, scene.wrenches);
    CHECK(length(scene.wrenches.force[0] - Vec3{-4.5, -6, 0}) < 1e-15);  // |r| = 5: c = 0.5 + 0.2 * 5
    CHECK(length(scene.wrenches.torque[0] - Vec3{0, 0, 1}) < 1e-15);     // (0.3 + 0.2) 2
    CHECK(scene.wrenches.force[1] == Vec3{});
    CHECK(scene.wrenches.shaft_torque[0] == doctest::Approx(1.8).epsilon(1e-15));  // (0.3 + 0.3) 3
    CHECK(scene.power[0] == doctest::Approx(-42 - 2 - 5.4).epsilon(1e-15));

    scene.clear();
    scene.shafts.motion[0] = Motion::Kinematic;
    apply_drag(drag.context(), kFirst, drag.rows, scene.bodies, scene.shafts, scene.wrenches);
    CHECK(scene.wrenches.shaft_torque[0] == 0);
}

TEST_CASE("a load acts in full on each dynamic body and shaft")
{
    HostTables scene;
    TableFixture<LoadRows> load;
    load.rows.between[0] = {{Facet::Body, 0}, {Facet::Body, 1}, {Facet::Shaft, 0}};
    load.rows.force[0] = {1, 2, 3};
    load.rows.torque[0] = {0, -4, 0};
    load.rows.shaft_torque[0] = 5;
    scene.bodies.velocity[0] = {2, 0, 1};
    scene.bodies.angular_velocity[0] = {0, 1, 0};
    scene.shafts.speed[0] = 3;
    apply_load(load.context(), kFirst, load.rows, scene.bodies, scene.shafts, scene.wrenches);
    CHECK(scene.wrenches.force[0] == Vec3{1, 2, 3});
    CHECK(scene.wrenches.torque[0] == Vec3{0, -4, 0});
    CHECK(scene.wrenches.force[1] == Vec3{});
    CHECK(scene.wrenches.shaft_torque[0] == 5);
    CHECK(scene.power[0] == 5.0 - 4 + 15);

    scene.clear();
    scene.shafts.motion[0] = Motion::Kinematic;
    apply_load(load.context(), kFirst, load.rows, scene.bodies, scene.shafts, scene.wrenches);
    CHECK(scene.wrenches.shaft_torque[0] == 0);
}

TEST_CASE("a falling body with quadratic drag reaches its terminal velocity")
{
    // m v' = m g - c v |v|: v = v_t tanh(g t / v_t), z = v_t^2/g ln cosh(g t / v_t).
    HostTables scene;
    scene.bodies.mass[0] = 1;
    TableFixture<GravityRows> gravity;
    TableFixture<DragRows> drag;
    gravity.rows.between[0] = drag.rows.between[0] = {{Facet::Body, 0}};
    gravity.rows.acceleration[0] = {0, 0, 9.81};
    drag.rows.quadratic[0] = 0.01;
    const auto [v, z] = fall(5, 500,
                             [&](double speed)
                             {
                                 scene.clear();
                                 scene.bodies.velocity[0] = {0, 0, speed};
                                 apply_gravity(gravity.context(), kFirst, gravity.rows, scene.bodies, scene.wrenches);
                                 apply_drag(drag.context(), kFirst, drag.rows, scene.bodies, scene.shafts, scene.wrenches);
                                 return scene.wrenches.force[0].z;
                             });
    CHECK(std::fabs(v - 28.7023194557054083) < 1e-9);
    CHECK(std::fabs(z - 91.5600402510837169) < 1e-9);
}

TEST_CASE("the air of a jet: full at the fan, a cone far from it, nothing outside and far behind")
{
    const Jet jet{{1, 0, 0}, {1, 0, 0}, 8, 0.5, 0.2};
    const auto at = [&](double z, double across) { return air_at(jet, {1 + z, across, 0}); };
    CHECK(at(0, 0).share == 1);
    CHECK(at(0, 0).velocity_W == Vec3{8, 0, 0});
    CHECK(at(3, 0).speed == doctest::Approx(8 * 0.5 / std::sqrt(0.25 + 0.36)).epsilon(1e-15));
    CHECK(at(1e6, 0).speed == doctest::Approx(8 * 0.5 / 2e5).epsilon(1e-9));
    // Far away the edge is at the half angle, and half the share (1/2) at half the radius.
    CHECK(at(1e6, 2.001e5).share == 0);
    CHECK(at(1e6, 1e5).share == doctest::Approx(0.5).epsilon(1e-9));
    CHECK(at(0, 0.6).share == 0);
    CHECK(at(-0.25, 0).share == doctest::Approx(0.5).epsilon(1e-9));
    CHECK(at(-0.5, 0).share == 0);
    // Far away the air moves along rays from the fan.
    const Vec3 ray = normalized(at(1e6, 1e5).velocity_W);
    CHECK(ray.y / ray.x == doctest::Approx(0.1).epsilon(1e-9));
    // The momentum flux pi R^2 U^2 is the same everywhere.
    const double R3 = std::sqrt(0.25 + 0.36);
    CHECK(at(3, 0).speed * R3 == doctest::Approx(at(0, 0).speed * 0.5).epsilon(1e-15));
}

TEST_CASE("the air and its first derivatives have no jumps")
{
    const Jet jet{{}, {0, 0, 1}, 8, 0.5, 0.2};
    const auto flux = [&](const Vec3& p)
    {
        const Air air = air_at(jet, p);
        return air.velocity_W * air.share;
    };
    const double h = 1e-6;
    const Vec3 seams[] = {{0.1, 0, 0}, {0, 0, 0}, {0, 0, -0.5}, {0.5, 0, 0}, {0, std::sqrt(0.25 + 0.04), 1}};
    for (const Vec3& p : seams)
        for (const Vec3& d : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
        {
            const Vec3 ahead = (flux(p + d * h) - flux(p)) / h, behind = (flux(p) - flux(p - d * h)) / h;
            CHECK(length(ahead - behind) < 1e-3);
        }
}

TEST_CASE("a fan pushes a body at rest with the usual drag; a body that moves with the air, or at a stopped fan, feels no force")
{
    HostTables scene;
    TableFixture<AirflowRows> airflow;
    airflow.rows.driver[0] = {Facet::Shaft, 0};
    airflow.rows.between[0] = kBothBodies;
    airflow.rows.pitch[0] = 0.05;
    airflow.rows.radius[0] = 0.5;
    airflow.rows.area[0] = 0.1;
    scene.bodies.position[0] = {0, 0, 2};
    scene.shafts.axle[0] = {};
    const auto push = [&](double speed, const Vec3& velocity)
    {
        scene.clear();
        scene.shafts.speed[0] = speed;
        scene.bodies.velocity[0] = velocity;
        apply_airflow(airflow.context(), kFirst, airflow.rows, scene.bodies, scene.shafts, scene.wrenches);
        return scene.wrenches.force[0];
    };
    const double tangent = std::tan(0.2);
    const double U = 0.05 * 100 * 0.5 / std::sqrt(0.25 + 4 * tangent * tangent);
    const double c = 0.5 * 1.2 * 0.47 * 0.1;
    CHECK(length(push(100, {}) - Vec3{0, 0, c * U * U}) < 1e-15);
    CHECK(length(push(200, {}) - push(100, {}) * 4) < 1e-15);
    CHECK(length(push(100, {0, 0, U})) < 1e-15);
    CHECK(push(100, {0, 0, 2 * U}).z < 0);
    CHECK(push(0, {1, 2, 3}) == Vec3{});
    // It blows backwards when its rotation is reversed: a body in front feels nothing, one behind is pushed away.
    CHECK(push(-100, {}) == Vec3{});
    scene.bodies.position[0] = {0, 0, -2};
    CHECK(length(push(-100, {}) - Vec3{0, 0, -c * U * U}) < 1e-15);
    CHECK(push(100, {}) == Vec3{});
    CHECK(scene.wrenches.force[1] == Vec3{});
    // Work of the field: F v.
    scene.bodies.position[0] = {0, 0, 2};
    const Vec3 f = push(100, {0, 0, 0.5});
    CHECK(scene.power[0] == doctest::Approx(0.5 * f.z).epsilon(1e-15));
}

TEST_CASE("the plugin declares four fields of force, each acting on each participant by itself")
{
    Registrar registrar;
    plab_plugin_register(registrar);
    REQUIRE(registrar.types().size() == 4);
    for (const TypeInfo& type : registrar.types())
    {
        CAPTURE(type.name);
        REQUIRE(!type.commands.empty());
        CHECK(type.commands[0].name == "Field/Apply");
        CHECK(type.commands[0].phase == Phase::Force);
        Schema schema;
        const auto table = type.make();
        table->describe(schema);
        const Role* between = schema.find_role("between");
        REQUIRE(between != nullptr);
        CHECK(between->writes);
        CHECK(between->independent);
    }
}
