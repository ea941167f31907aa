/// Viewers: from where somebody looks at the scene. Governors choose levels of detail for them.
#pragma once

#include "plab/levels.h"
#include "plab/registrar.h"

namespace plab::viewers
{

/// What all viewers have.
struct OpticsRows
{
    Column<double> field_of_view;  ///< rad, vertical
    Column<double> width, height;  ///< pixels

    void describe(Schema& schema);
};

/// Viewer/Free: stands where requests put it.
struct FreeRows
{
    Column<Vec3> position, velocity;  ///< W, m, m/s
    Column<Vec3> direction, up;       ///< W
    OpticsRows optics;

    void describe(Schema& schema);
};

/// Viewer/Attached: rides on a body.
struct AttachedRows
{
    Column<Ref> body;
    Column<Vec3> position;       ///< in B, m
    Column<Vec3> direction, up;  ///< in B
    OpticsRows optics;

    void describe(Schema& schema);
};

void look_freely(Row row, const FreeRows& viewers, ViewpointSink& viewpoints);
void look_from_body(Row row, const AttachedRows& viewers, const Bodies& bodies, ViewpointSink& viewpoints);

}  // namespace plab::viewers
