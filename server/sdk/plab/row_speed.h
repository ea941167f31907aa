/// The speed of a constraint row, J v, at the present state of the tables, m/s or rad/s.
#pragma once

#include "plab/rows.h"
#include "plab/tables.h"

namespace plab
{

inline double speed_of(const RowBlock& block, const Bodies& bodies, const Shafts& shafts)
{
    const std::uint32_t i = block.participant.index;
    if (block.participant.facet == Facet::Shaft) return block.angular.x * shafts.speed[i];
    return dot(block.linear, bodies.velocity[i]) + dot(block.angular, bodies.angular_velocity[i]);
}

inline double speed_of(const ConstraintRow& row, const Bodies& bodies, const Shafts& shafts)
{
    double sum = 0;
    for (std::uint32_t k = 0; k < row.count; ++k) sum += speed_of(row.blocks[k], bodies, shafts);
    return sum;
}

}  // namespace plab
