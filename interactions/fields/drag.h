/// Field/Drag: resistance of a medium that moves at v_M (m/s, in W).
///
///   bodies, at the centre of mass:  F = -c1 r - c2 |r| r,   r = v_WC - v_M     c1 in kg/s, c2 in kg/m
///   their rotation, and shafts:     T = -d1 w - d2 |w| w                       d1 in N m s/rad, d2 in N m s^2/rad^2
#pragma once

#include "plab/registrar.h"

namespace plab::fields
{

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
