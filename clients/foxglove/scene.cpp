#include "foxglove/scene.h"

#include <algorithm>
#include <set>

#include "foxglove/cdr_writer.h"
#include "foxglove/channels.h"
#include "link/appearance.h"

namespace plab::foxglove
{
namespace
{

constexpr std::size_t kMostBytes = 1u << 20;  ///< of one update, roughly
/// m: a plane has no end, and a cube must have one.
constexpr double kPlaneSize = 100, kPlaneThickness = 0.001;

enum class Deletion : std::uint32_t
{
    MatchingId = 0,
    All = 1,
};

/// A shape in the frame of its entity.
struct Part
{
    const link::Shape* mesh = nullptr;
    Pose pose;
    Vec3 size, color;  ///< size: m, whole lengths
};

struct Parts
{
    std::vector<Part> cubes, spheres, cylinders, meshes;
};

void put_time(CdrWriter& out, std::uint64_t time)
{
    constexpr std::uint64_t kSecond = 1'000'000'000;
    out.put(static_cast<std::uint32_t>(std::min<std::uint64_t>(time / kSecond, UINT32_MAX)));
    out.put(static_cast<std::uint32_t>(time % kSecond));
}

void put_color(CdrWriter& out, const Vec3& color) { out.put(color), out.put(1.0); }

/// A capsule is a cylinder and two balls.
void add_capsule(const Pose& pose, const Vec3& size, const Vec3& color, Parts& out)
{
    const double diameter = 2 * size.x;
    out.cylinders.push_back({nullptr, pose, {diameter, diameter, 2 * size.z}, color});
    for (const double end : {-size.z, size.z})
        out.spheres.push_back({nullptr, {pose * Vec3{0, 0, end}, pose.q}, {diameter, diameter, diameter}, color});
}

void add_shape(const link::Shape& shape, const Pose& X_FB, const Vec3& color, Parts& out)
{
    const Pose pose = X_FB * Pose{shape.position, shape.orientation};
    const Vec3 twice = shape.size * 2.0;
    if (shape.form == "sphere")
        out.spheres.push_back({nullptr, pose, {twice.x, twice.x, twice.x}, color});
    else if (shape.form == "box")
        out.cubes.push_back({nullptr, pose, twice, color});
    else if (shape.form == "cylinder")
        out.cylinders.push_back({nullptr, pose, {twice.x, twice.x, twice.z}, color});
    else if (shape.form == "capsule")
        add_capsule(pose, shape.size, color, out);
    else if (shape.form == "plane")
        out.cubes.push_back({nullptr, pose * Pose{{0, 0, -kPlaneThickness / 2}, {}}, {kPlaneSize, kPlaneSize, kPlaneThickness}, color});
    else if (!shape.vertices.empty())
        out.meshes.push_back({&shape, pose, {}, color});
}

bool is_static(const link::Object& object) { return !link::is_shaft(object) && object.motion == "static"; }

Parts parts_of(const link::Object& object, const DrawnScene& scene)
{
    Parts out;
    const Vec3 color = link::shown_color(object);
    const Pose X_FB = is_static(object) ? Pose{object.position, object.orientation} : Pose{};
    for (const std::string& id : object.shapes)
        if (const auto shape = scene.shapes.find(id); shape != scene.shapes.end()) add_shape(shape->second, X_FB, color, out);
    if (!link::is_shaft(object) || !object.shapes.empty()) return out;
    const link::Axle axle = link::axle_of_inertia(object.mass);
    out.cylinders.push_back({nullptr, X_FB, {2 * axle.radius, 2 * axle.radius, 2 * axle.half_length}, color});
    out.cubes.push_back({nullptr, {axle.mark_position, {}}, axle.mark_size * 2.0, link::kMarkColor});
    return out;
}

/// CubePrimitive and SpherePrimitive.
void put_solids(CdrWriter& out, const std::vector<Part>& parts)
{
    out.count(parts.size());
    for (const Part& part : parts)
    {
        out.put(part.pose), out.put(part.size);
        put_color(out, part.color);
    }
}

void put_cylinders(CdrWriter& out, const std::vector<Part>& parts)
{
    out.count(parts.size());
    for (const Part& part : parts)
    {
        out.put(part.pose), out.put(part.size);
        out.put(1.0), out.put(1.0);  // neither end is narrower
        put_color(out, part.color);
    }
}

void put_meshes(CdrWriter& out, const std::vector<Part>& parts)
{
    out.count(parts.size());
    for (const Part& part : parts)
    {
        out.put(part.pose);
        out.count(part.mesh->vertices.size());
        for (const Vec3& point : part.mesh->vertices) out.put(point);
        put_color(out, part.color);
        out.count(0);  // no colour of its own for any point
        const std::vector<std::uint32_t> corners = link::triangles_of(*part.mesh);
        out.count(corners.size());
        for (const std::uint32_t corner : corners) out.put(corner);
    }
}

void put_entity(CdrWriter& out, const link::Object& object, const DrawnScene& scene, std::uint64_t time)
{
    const Parts parts = parts_of(object, scene);
    put_time(out, time);
    out.put(is_static(object) ? std::string(kWorldFrame) : object.component_id);
    out.put(object.component_id);
    out.put(std::uint32_t{0}), out.put(std::uint32_t{0});  // lifetime: until it is replaced
    out.put(true);                                         // it moves with its frame
    const std::pair<const char*, const std::string*> facts[] = {{"name", &object.name}, {"type", &object.type_name}};
    out.count(std::size(facts));
    for (const auto& [key, value] : facts) out.put(key), out.put(*value);
    out.count(0);  // arrows
    put_solids(out, parts.cubes);
    put_solids(out, parts.spheres);
    put_cylinders(out, parts.cylinders);
    out.count(0);  // lines
    put_meshes(out, parts.meshes);
    out.count(0), out.count(0);  // texts, models
}

void put_deletion(CdrWriter& out, Deletion kind, const std::string& id, std::uint64_t time)
{
    put_time(out, time);
    out.put(static_cast<std::uint32_t>(kind));
    out.put(id);
}

/// The first update has `deletions`, which put themselves and return their number.
template <class PutDeletions>
SceneUpdates updates_of(const std::vector<const link::Object*>& objects, const DrawnScene& scene, std::uint64_t time,
                        const PutDeletions& put_deletions)
{
    SceneUpdates out;
    std::size_t next = 0;
    do {
        CdrWriter writer;
        if (out.empty())
            put_deletions(writer);
        else
            writer.count(0);
        const std::size_t at = writer.count_later();
        std::size_t entities = 0;
        for (; next < objects.size() && writer.size() < kMostBytes; ++next, ++entities) put_entity(writer, *objects[next], scene, time);
        writer.set_count(at, entities);
        out.push_back(writer.take());
    } while (next < objects.size());
    return out;
}

/// Of an object only what it is drawn by counts: its parameters change more often.
bool looks_the_same(const link::Object& a, const link::Object& b)
{
    return a.name == b.name && a.type_name == b.type_name && a.shape_of == b.shape_of && a.motion == b.motion && a.color == b.color &&
           a.shapes == b.shapes && (!link::is_shaft(a) || a.mass == b.mass) &&
           (!is_static(a) || (a.position == b.position && a.orientation == b.orientation));
}

void put_transform(CdrWriter& out, const std::string& id, const Pose& X_WB, std::uint64_t time)
{
    put_time(out, time);
    out.put(kWorldFrame), out.put(id);
    out.put(X_WB.p), out.put(X_WB.q);
}

}  // namespace

SceneUpdates whole_scene(const DrawnScene& scene, std::uint64_t time)
{
    std::vector<const link::Object*> objects;
    for (const auto& [id, object] : scene.objects) objects.push_back(&object);
    return updates_of(objects, scene, time,
                      [&](CdrWriter& out)
                      {
                          out.count(1);
                          put_deletion(out, Deletion::All, "", time);
                      });
}

SceneUpdates scene_changes(const DrawnScene& before, const DrawnScene& now, std::uint64_t time)
{
    std::set<std::string> other_shapes;
    for (const auto& [id, shape] : now.shapes)
        if (const auto old = before.shapes.find(id); old == before.shapes.end() || !(old->second == shape)) other_shapes.insert(id);
    const auto has_other_shape = [&](const link::Object& object)
    { return std::any_of(object.shapes.begin(), object.shapes.end(), [&](const std::string& id) { return other_shapes.contains(id); }); };
    std::vector<const link::Object*> objects;
    for (const auto& [id, object] : now.objects)
    {
        const auto old = before.objects.find(id);
        if (old == before.objects.end() || !looks_the_same(old->second, object) || has_other_shape(object)) objects.push_back(&object);
    }
    std::vector<std::string> gone;
    for (const auto& [id, object] : before.objects)
        if (!now.objects.contains(id)) gone.push_back(id);
    if (objects.empty() && gone.empty()) return {};
    return updates_of(objects, now, time,
                      [&](CdrWriter& out)
                      {
                          out.count(gone.size());
                          for (const std::string& id : gone) put_deletion(out, Deletion::MatchingId, id, time);
                      });
}

void FrameWriter::use(const std::map<std::string, link::Object>& objects)
{
    movers_.clear();
    for (const auto& [id, object] : objects)
        if (!is_static(object)) movers_[object.handle] = {id, object.run, {object.position, object.orientation}};
}

std::string FrameWriter::transforms(const plab_v2_Frame& frame, std::uint64_t time) const
{
    CdrWriter out;
    const std::size_t at = out.count_later();
    std::size_t count = 0;
    const auto put = [&](std::uint32_t handle, const auto& pose)
    {
        const auto mover = movers_.find(handle);
        if (mover == movers_.end() || mover->second.run != frame.run) return;
        put_transform(out, mover->second.id, pose(mover->second), time);
        ++count;
    };
    for (std::uint32_t i = 0; i < frame.bodies._length; ++i)
    {
        const plab_v2_BodyState& b = frame.bodies._buffer[i];
        const Pose X_WB{{b.position.x, b.position.y, b.position.z}, {b.orientation.w, b.orientation.x, b.orientation.y, b.orientation.z}};
        put(b.handle, [&](const Mover&) { return X_WB; });
    }
    for (std::uint32_t i = 0; i < frame.shafts._length; ++i)
    {
        const plab_v2_ShaftState& s = frame.shafts._buffer[i];
        put(s.handle, [&](const Mover& mover) { return Pose{mover.axle.p, mover.axle.q * link::shaft_rotation(s.angle)}; });
    }
    out.set_count(at, count);
    return out.take();
}

std::string FrameWriter::transforms(const std::map<std::string, link::Object>& objects, std::uint64_t time) const
{
    CdrWriter out;
    const std::size_t at = out.count_later();
    std::size_t count = 0;
    for (const auto& [id, object] : objects)
    {
        if (is_static(object)) continue;
        Pose X_WB{object.position, object.orientation};
        if (link::is_shaft(object)) X_WB.q = X_WB.q * link::shaft_rotation(link::shaft_angle(object));
        put_transform(out, id, X_WB, time);
        ++count;
    }
    out.set_count(at, count);
    return out.take();
}

}  // namespace plab::foxglove
