#include "airflow.h"

#include <algorithm>
#include <numbers>

namespace plab::fields
{
namespace
{

constexpr Unit kMetrePerRadian{"m/rad", {{1, 0, 0, -1}}};
constexpr Unit kSquareMetre{"m^2", {{2, 0, 0, 0}}};

/// 1 at 0, 0 from 1 on, with zero slope at both.
double smooth_edge(double x)
{
    if (x >= 1) return 0;
    const double c = std::cos(0.5 * std::numbers::pi * x);
    return c * c;
}

Jet jet_of(Row row, const AirflowRows& airflow, const Shafts& shafts)
{
    const std::uint32_t fan = airflow.driver[row].index;
    const double speed = airflow.pitch[row] * shafts.speed[fan];
    const Vec3 axis_W = shafts.axis_W(fan);
    return {shafts.axle[fan].p, speed < 0 ? -axis_W : axis_W, std::fabs(speed), airflow.radius[row], std::tan(airflow.half_angle[row])};
}

}  // namespace

void AirflowRows::describe(Schema& schema)
{
    schema.role(driver, "driver", {Facet::Shaft}, "the fan's shaft; the fan blows along its axis when it turns forwards");
    schema.role(between, "between", {Facet::Body}, "bodies that the air can carry").writes().independent();
    schema.param(pitch, "pitch", kMetrePerRadian, "distance that the air moves through the fan per radian of rotation").nonzero();
    schema.param(radius, "radius", unit::metre, "of the fan").positive();
    schema.param(half_angle, "half_angle", unit::radian, "half of the jet's opening angle far from the fan; about 0.2 for a free round jet")
        .or_else(0.2)
        .not_negative()
        .at_most(1.4);
    schema.param(air_density, "air_density", unit::kilogram_per_metre3, "of the air").or_else(1.2).positive();
    schema.param(drag_coefficient, "drag_coefficient", unit::one, "of the bodies; a ball's is about 0.47").or_else(0.47).not_negative();
    schema.param(area, "area", kSquareMetre, "cross-section of a body that faces the air").not_negative();
}

Air air_at(const Jet& jet, const Vec3& p_W)
{
    const Vec3 from_fan = p_W - jet.origin_W;
    const double z = dot(from_fan, jet.axis_W);
    const Vec3 across = from_fan - jet.axis_W * z;
    const double widening = jet.tangent * z;
    const double jet_radius = std::sqrt(jet.radius * jet.radius + widening * widening);
    // R'/R = z tan^2 / R^2.
    const Vec3 ray = normalized(jet.axis_W + across * (widening * jet.tangent / (jet_radius * jet_radius)));

    Air air;
    air.share = smooth_edge(length(across) / jet_radius) * smooth_edge(std::max(-z, 0.0) / jet.radius);
    air.speed = jet.speed * jet.radius / jet_radius;
    air.velocity_W = ray * air.speed;
    return air;
}

void apply_airflow(const StepContext& context, Rows rows, const AirflowRows& airflow, const Bodies& bodies, const Shafts& shafts,
                   Wrenches& wrenches)
{
    for (const Row row : rows)
    {
        wrenches.begin(context.component_of_row[row]);
        const Jet jet = jet_of(row, airflow, shafts);
        const double factor = 0.5 * airflow.air_density[row] * airflow.drag_coefficient[row] * airflow.area[row];
        for (const Ref body : context.among(airflow.between[row]))
        {
            if (!bodies.dynamic(body.index) || !context.active(body)) continue;
            const Air air = air_at(jet, bodies.position[body.index]);
            if (air.share == 0) continue;
            const Vec3 slip = air.velocity_W - bodies.velocity[body.index];
            wrenches.add_force(body, slip * (factor * air.share * air.speed));
        }
    }
}

}  // namespace plab::fields
