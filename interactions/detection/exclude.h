/// Collision/Exclude: bodies or shapes that do not collide with one another, whatever detections name them.
#pragma once

#include "plab/collision_filter.h"
#include "plab/registrar.h"

namespace plab::detection
{

struct ExcludeRows
{
    Column<RefList> within, a, b;

    void describe(Schema& schema);
};

/// Phase::Prepare. Refuses a row that excludes nothing.
Result<void> prepare_exclude(Row row, const ExcludeRows& rows);
/// Phase::Connect.
void connect_exclude(Row row, const ExcludeRows& rows, CollisionFilter& filter);

}  // namespace plab::detection
