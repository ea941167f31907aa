/// The columns of the host tables, for whoever copies rows: a column that is added to a table is added here.
#pragma once

#include <tuple>

#include "world/host_tables.h"

namespace plab::world
{

/// Of bodies, without shapes: what a step may change, and what is derived from parameters.
inline constexpr std::tuple kBodyColumns(&Bodies::motion, &Bodies::position, &Bodies::orientation, &Bodies::velocity,
                                         &Bodies::angular_velocity, &Bodies::angular_momentum, &Bodies::mass, &Bodies::inverse_mass,
                                         &Bodies::needle, &Bodies::inertia_B, &Bodies::inverse_inertia_B, &Bodies::center_B,
                                         &Bodies::material);
/// Of shafts, without axles and shapes.
inline constexpr std::tuple kShaftColumns(&Shafts::motion, &Shafts::angle, &Shafts::speed, &Shafts::inertia, &Shafts::inverse_inertia,
                                          &Shafts::root, &Shafts::ratio, &Shafts::anchor, &Shafts::root_anchor);
/// Of shafts: what a stepper derives from the structure.
inline constexpr std::tuple kDerivedShaftColumns(&Shafts::root, &Shafts::ratio, &Shafts::anchor, &Shafts::root_anchor);

/// Calls visit(column) for each of `columns`, pointers to members.
template <class Columns, class Visit>
void for_each_column(const Columns& columns, Visit visit)
{
    std::apply([&](auto... column) { (visit(column), ...); }, columns);
}

}  // namespace plab::world
