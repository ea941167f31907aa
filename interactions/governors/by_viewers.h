/// Governors that choose levels for the viewers of the scene: by distance, and by what a viewer can see.
#pragma once

#include "watch.h"

namespace plab::governors
{

struct DistanceRows
{
    WatchRows watch;
    Column<Reals> distances;    ///< m, ascending: one fewer than there are levels
    Column<double> look_ahead;  ///< s

    void describe(Schema& schema);
};

struct VisibilityRows
{
    WatchRows watch;
    Column<Reals> pixels;       ///< ascending: one fewer than there are levels
    Column<double> look_ahead;  ///< s
    Column<double> margin;      ///< rad
    Column<RefList> occluders;  ///< bodies
    Column<std::int64_t> in_view, hidden;

    void describe(Schema& schema);
};

/// The finest level within the smallest distance, the next one within the next distance, and so on.
Result<void> choose_by_distance(const StepContext& context, Row row, DistanceRows& governors, LevelControl& control);

/// The cheapest level for what no viewer sees, otherwise one level for each bound that the size of the picture exceeds.
Result<void> choose_by_sight(const StepContext& context, Row row, VisibilityRows& governors, const Bodies& bodies, const Shapes& shapes,
                             LevelControl& control);

}  // namespace plab::governors
