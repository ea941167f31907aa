/// Field/Airflow: a fan on a shaft blows a cone of air that carries bodies along.
///
/// Frame: origin at the fan (the axle's origin), a the axle's direction in which the fan blows: it turns round with the
/// sense of rotation. A body's centre is at z along a and at the vector p across it.
///   jet radius     R(z) = sqrt(r^2 + (z tan(half_angle))^2)                          m
///   air speed      U(z) = pitch |w| r / R(z)                                         m/s
///   air velocity   u    = U e,  e = direction of (a + p R'(z) / R(z))                m/s, along the jet's stream lines
///   share in jet   k    = cos^2(pi/2 min(|p| / R, 1)) * cos^2(pi/2 min(max(-z, 0) / r, 1))
///   force          F    = k/2 rho C_d A U (u - v)                                    N, at the centre of mass
///
/// Near the fan the jet is a cylinder, far from it a cone; no air moves farther than r behind the fan. U R is constant:
/// a round jet keeps its momentum flux rho pi R^2 U^2 while it takes in air and widens (Pope, Turbulent flows, section
/// 5.1). F is the momentum that the air passing the body's face, rho A U per second, gives up by slowing down to the
/// body's velocity, times C_d/2: at rest the usual drag k/2 rho C_d A U^2, and none for a body that moves with the air
/// or when the fan stands still. All of it is once continuously differentiable, which the order of the solver needs.
/// The fan does not feel the air: load its shaft with Field/Drag.
#pragma once

#include "plab/registrar.h"

namespace plab::fields
{

struct AirflowRows
{
    Column<Ref> driver;
    Column<RefList> between;
    Column<double> pitch;             ///< m/rad
    Column<double> radius;            ///< r, m
    Column<double> half_angle;        ///< rad
    Column<double> air_density;       ///< rho, kg/m^3
    Column<double> drag_coefficient;  ///< C_d
    Column<double> area;              ///< A, m^2

    void describe(Schema& schema);
};

/// A fan at one moment.
struct Jet
{
    Vec3 origin_W;       ///< m
    Vec3 axis_W;         ///< unit, the way it blows
    double speed = 0;    ///< of the air at the fan, m/s
    double radius = 0;   ///< m
    double tangent = 0;  ///< of the half angle
};

struct Air
{
    Vec3 velocity_W;   ///< u, m/s
    double speed = 0;  ///< U = |u|, m/s
    double share = 0;  ///< k, 0 to 1
};

Air air_at(const Jet& jet, const Vec3& p_W);

void apply_airflow(const StepContext& context, Rows rows, const AirflowRows& airflow, const Bodies& bodies, const Shafts& shafts,
                   Wrenches& wrenches);

}  // namespace plab::fields
