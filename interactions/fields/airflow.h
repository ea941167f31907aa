/// Field/Airflow: a fan on a shaft blows a cone of air that carries bodies along.
///
/// Frame: origin at the fan (the axle's origin), a the direction of the axle in which the fan blows, which reverses with the
/// sense of rotation. A body's centre is at distance z along a and at the vector p perpendicular to it.
///   jet radius     R(z) = sqrt(r^2 + (z tan(half_angle))^2)                          m
///   air speed      U(z) = pitch |w| r / R(z)                                         m/s
///   air velocity   u    = U e,  e = direction of (a + p R'(z) / R(z))                m/s, along the stream lines of the jet
///   share in jet   k    = cos^2(pi/2 min(|p| / R, 1)) * cos^2(pi/2 min(max(-z, 0) / r, 1))
///   force          F    = k/2 rho C_d A U (u - v)                                    N, at the centre of mass
///
/// Near the fan the jet is a cylinder, far from it a cone; further than r behind the fan the air is at rest. U R is constant: a
/// round jet keeps its momentum flux rho pi R^2 U^2 while it entrains air and widens (Pope, Turbulent flows, section 5.1). F is
/// C_d/2 times the momentum that the air passing the body's cross-section, rho A U per second, gives up by slowing down to the
/// velocity of the body. For a body at rest this is the usual drag k/2 rho C_d A U^2. The force is zero for a body that moves
/// with the air, or when the fan stands still. All of it is once continuously differentiable, as the order of the solver
/// requires. The fan does not feel the air: load its shaft with Field/Drag.
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

/// The state of a fan at one moment.
struct Jet
{
    Vec3 origin_W;       ///< m
    Vec3 axis_W;         ///< unit, the direction in which it blows
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
