#include "foxglove/contact_arrows.h"

#include <algorithm>

#include "foxglove/cdr_writer.h"
#include "foxglove/channels.h"
#include "plab/rotation.h"

namespace plab::foxglove
{
namespace
{

constexpr double kGravity = 9.81;  // m/s^2, to tell a weight
/// Of the length for a mean weight: longer arrows are cut, shorter ones are not drawn.
constexpr double kLongest = 20, kShortest = 1e-3;
/// Of an arrow's length, but for very short ones.
constexpr double kShaft = 0.04, kHead = 0.1, kHeadLength = 0.25;
constexpr Vec3 kLasting{0.1, 0.5, 1}, kImpact{0.9, 0.15, 0.4};

/// m: the largest half length of a shape.
double size_of(const link::Shape& shape)
{
    if (shape.form == "plane") return 0;
    double out = std::max({shape.size.x, shape.size.y, shape.size.z});
    for (const Vec3& v : shape.vertices) out = std::max(out, length(v));
    return out;
}

bool moves(const DrawnScene& scene, const std::string& id)
{
    const auto object = scene.objects.find(id);
    return object != scene.objects.end() && object->second.motion == "dynamic";
}

/// The rotation of x to a unit vector.
Quat rotation_of_x(const Vec3& to)
{
    const Vec3 axis = cross(Vec3{1, 0, 0}, to);
    if (1 + to.x < 1e-12) return {0, 0, 1, 0};
    return normalized(Quat{1 + to.x, axis.x, axis.y, axis.z});
}

void put_arrow(CdrWriter& out, const Vec3& at, const Vec3& direction, double size, double unit, const Vec3& color)
{
    const double thick = std::max(size, 0.3 * unit);
    out.put(Pose{at, rotation_of_x(direction)});
    out.put(size * (1 - kHeadLength)), out.put(kShaft * thick);
    out.put(size * kHeadLength), out.put(kHead * thick);
    out.put(color), out.put(1.0);
}

}  // namespace

void ContactArrows::use(const DrawnScene& scene)
{
    double weight = 0, size = 0;
    std::size_t count = 0;
    for (const auto& [id, object] : scene.objects)
    {
        if (link::is_shaft(object) || object.motion != "dynamic") continue;
        double own = 0;
        for (const std::string& shape : object.shapes)
            if (const auto at = scene.shapes.find(shape); at != scene.shapes.end()) own = std::max(own, 2 * size_of(at->second));
        if (!(own > 0) || !(object.mass > 0)) continue;
        weight += kGravity * object.mass, size += own, ++count;
    }
    scale_ = count > 0 ? size / weight : 0.0;
    longest_ = count > 0 ? kLongest * size / static_cast<double>(count) : 0.0;
}

std::string ContactArrows::update(const wire::ContactForces& contacts, const DrawnScene& scene, std::uint64_t time) const
{
    CdrWriter out;
    out.count(0), out.count(1);  // no deletions, one entity
    constexpr std::uint64_t kSecond = 1'000'000'000;
    out.put(static_cast<std::uint32_t>(time / kSecond)), out.put(static_cast<std::uint32_t>(time % kSecond));
    out.put(kWorldFrame), out.put("contacts");
    out.put(std::uint32_t{0}), out.put(std::uint32_t{0});  // lifetime: until it is replaced
    out.put(false);
    out.count(0);  // metadata
    const std::size_t at = out.count_later();
    std::size_t arrows = 0;
    for (const wire::ContactInfo& pair : contacts.entries)
    {
        const double sign = moves(scene, pair.b) ? 1 : -1;
        for (const wire::ContactPoint& p : pair.points)
        {
            const Vec3 force = (p.normal * p.normal_force + p.friction_force) * sign;
            const double size = std::min(longest_, scale_ * length(force)), unit = longest_ / kLongest;
            if (!(size > kShortest * unit)) continue;
            put_arrow(out, p.position, force * (1 / length(force)), size, unit, p.is_impact ? kImpact : kLasting);
            ++arrows;
        }
    }
    out.set_count(at, arrows);
    for (int i = 0; i < 7; ++i) out.count(0);  // cubes, spheres, cylinders, lines, triangles, texts, models
    return out.take();
}

}  // namespace plab::foxglove
