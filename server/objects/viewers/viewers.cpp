#include "viewers.h"

namespace plab::viewers
{
namespace
{

Viewpoint seen_with(const OpticsRows& optics, Row row)
{
    Viewpoint out;
    out.field_of_view = optics.field_of_view[row], out.width = optics.width[row], out.height = optics.height[row];
    return out;
}

}  // namespace

void OpticsRows::describe(Schema& schema)
{
    schema.state(field_of_view, "field_of_view", unit::radian, "vertical angle of what is seen")
        .initially(0.7)
        .positive()
        .at_most(3)
        .input();
    schema.state(width, "width", unit::one, "of the picture, pixels").initially(1280).positive().input();
    schema.state(height, "height", unit::one, "of the picture, pixels").initially(720).positive().input();
}

void FreeRows::describe(Schema& schema)
{
    schema.state(position, "position", unit::metre, "of the eye, in the world").input();
    schema.state(velocity, "velocity", unit::metre_per_second, "of the eye, in the world: to look ahead").input();
    schema.state(direction, "direction", unit::one, "in which it looks, in the world").initially({1, 0, 0}).unit_length().input();
    schema.state(up, "up", unit::one, "upwards in the picture, in the world").initially({0, 0, 1}).unit_length().input();
    optics.describe(schema);
}

void AttachedRows::describe(Schema& schema)
{
    schema.role(body, "body", {Facet::Body}, "on which the viewer rides");
    schema.param(position, "position", unit::metre, "of the eye, in the frame of the body").or_else({});
    schema.param(direction, "direction", unit::one, "in which it looks, in the frame of the body").or_else({1, 0, 0}).unit_length();
    schema.param(up, "up", unit::one, "upwards in the picture, in the frame of the body").or_else({0, 0, 1}).unit_length();
    optics.describe(schema);
}

void look_freely(Row row, const FreeRows& viewers, ViewpointSink& viewpoints)
{
    Viewpoint v = seen_with(viewers.optics, row);
    v.position = viewers.position[row], v.velocity = viewers.velocity[row];
    v.direction = viewers.direction[row], v.up = viewers.up[row];
    viewpoints.add(row, v);
}

void look_from_body(Row row, const AttachedRows& viewers, const Bodies& bodies, ViewpointSink& viewpoints)
{
    const std::uint32_t b = viewers.body[row].index;
    const Pose X_WB = bodies.pose(b);
    Viewpoint v = seen_with(viewers.optics, row);
    v.position = X_WB.p + rotate(X_WB.q, viewers.position[row]);
    v.velocity = bodies.velocity_at(b, v.position);
    v.direction = rotate(X_WB.q, viewers.direction[row]), v.up = rotate(X_WB.q, viewers.up[row]);
    viewpoints.add(row, v);
}

}  // namespace plab::viewers
