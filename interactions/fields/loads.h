/// Loads that act on each body and shaft by itself: a constant one, and the resistance of a medium. W: the world's frame.
#pragma once

#include "plab/registrar.h"

namespace plab::fields
{

/// Field/Load: a constant force and torque, in W, on bodies; a constant torque on shafts. N, N m.
///
/// F acts at the centre of mass, and M is a torque about it; a shaft takes `shaft_torque` about its axle. A dead load: it does
/// not turn with the body.
struct LoadRows
{
    Column<RefList> between;
    Column<Vec3> force;           ///< F_W, N
    Column<Vec3> torque;          ///< M_W, N m
    Column<double> shaft_torque;  ///< N m

    void describe(Schema& schema);
};

void apply_load(const StepContext& context, Rows rows, const LoadRows& load, const Bodies& bodies, const Shafts& shafts,
                Wrenches& wrenches);

/// Field/Drag: resistance of a medium that moves at v_M (m/s, in W).
///
///   bodies, at the centre of mass:  F = -c1 r - c2 |r| r,   r = v_WC - v_M     c1 in kg/s, c2 in kg/m
///   their rotation, and shafts:     T = -d1 w - d2 |w| w                       d1 in N m s/rad, d2 in N m s^2/rad^2
struct DragRows
{
    Column<RefList> between;
    Column<double> linear;                ///< c1
    Column<double> quadratic;             ///< c2
    Column<double> rotational;            ///< d1
    Column<double> rotational_quadratic;  ///< d2
    Column<Vec3> medium_velocity;         ///< v_M

    void describe(Schema& schema);
};

void apply_drag(const StepContext& context, Rows rows, const DragRows& drag, const Bodies& bodies, const Shafts& shafts,
                Wrenches& wrenches);

}  // namespace plab::fields
