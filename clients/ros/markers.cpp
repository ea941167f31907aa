#include "ros/markers.h"

namespace plab::ros
{
namespace
{

// visualization_msgs/Marker.
constexpr std::int32_t kCube = 1, kSphere = 2, kCylinder = 3, kTriangles = 11, kDeleteAll = 3;

/// Of bodies to which the scene gives none.
constexpr Vec3 kPlainColor{0.7, 0.72, 0.75};
/// A plane has no end; its picture is this long and this thick, m, below the surface.
constexpr double kPlaneLength = 200, kPlaneThickness = 1e-3;

}  // namespace

/// FNV-1a.
void MarkerMessage::note(const void* bytes, std::size_t size)
{
    constexpr std::uint64_t kPrime = 1099511628211u;
    const auto* const data = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < size; ++i) fingerprint_ = (fingerprint_ ^ data[i]) * kPrime;
}

msg::Marker& MarkerMessage::add(const SceneFrame& frame, std::int32_t type, const Pose& pose, const Vec3& scale, const Vec3& color)
{
    msg::Marker& out = markers_.emplace_back();
    out.header.frame_id = wire::text(frame.name);
    out.ns = wire::text(frame.name), out.id = next_id_++, out.type = type;
    out.pose = pose_message(pose), out.scale = vector_of(scale);
    out.color = {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z), 1.0f};
    // With a stamp of zero: wherever the frame is at the time of the picture.
    out.frame_locked = true;
    note(frame.name.data(), frame.name.size());
    for (const double number : {double(type), pose.p.x, pose.p.y, pose.p.z, pose.q.w, pose.q.x, pose.q.y, pose.q.z, scale.x, scale.y,
                                scale.z, color.x, color.y, color.z})
        note(&number, sizeof number);
    return out;
}

void MarkerMessage::add_mesh(const SceneFrame& frame, const link::Shape& shape, const Vec3& color)
{
    const std::vector<std::uint32_t> corners = link::triangles_of(shape);
    if (corners.empty()) return;
    msg::Marker& out = add(frame, kTriangles, {shape.position, shape.orientation}, {1, 1, 1}, color);
    const auto points = make_sequence(out.points, corners.size(), memory_);
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        const Vec3& corner = shape.vertices[corners[i]];
        points[i] = point_of(corner), note(&corner, sizeof corner);
    }
}

void MarkerMessage::add_shape(const SceneFrame& frame, const link::Shape& shape, const Vec3& color)
{
    const Pose X_BS{shape.position, shape.orientation};
    const Vec3& size = shape.size;
    if (shape.form == "sphere")
        add(frame, kSphere, X_BS, Vec3{1, 1, 1} * (2 * size.x), color);
    else if (shape.form == "box")
        add(frame, kCube, X_BS, 2 * size, color);
    else if (shape.form == "cylinder")
        add(frame, kCylinder, X_BS, {2 * size.x, 2 * size.x, 2 * size.z}, color);
    else if (shape.form == "capsule")
    {
        add(frame, kCylinder, X_BS, {2 * size.x, 2 * size.x, 2 * size.z}, color);
        for (const double end : {-size.z, size.z}) add(frame, kSphere, X_BS * Pose{{0, 0, end}, {}}, Vec3{1, 1, 1} * (2 * size.x), color);
    }
    else if (shape.form == "plane")
        add(frame, kCube, X_BS * Pose{{0, 0, -0.5 * kPlaneThickness}, {}}, {kPlaneLength, kPlaneLength, kPlaneThickness}, color);
    else
        add_mesh(frame, shape, color);
}

const msg::MarkerArray& MarkerMessage::of(const link::CatalogueContents& scene, const SceneFrames& frames)
{
    constexpr std::uint64_t kBasis = 14695981039346656037u;
    markers_.clear(), memory_.clear(), fingerprint_ = kBasis, next_id_ = 0;
    msg::Marker& first = markers_.emplace_back();
    first.header.frame_id = wire::text(kWorldFrame), first.action = kDeleteAll;
    first.pose.orientation.w = 1;
    for (const SceneFrame& frame : frames.all())
    {
        const auto object = scene.objects.find(frame.id);
        if (object == scene.objects.end()) continue;
        for (const std::string& id : object->second.shapes)
            if (const auto shape = scene.shapes.find(id); shape != scene.shapes.end())
                add_shape(frame, shape->second, link::color_of(object->second).value_or(kPlainColor));
    }
    show(message_.markers, markers_);
    return message_;
}

}  // namespace plab::ros
