#include "ros/entities.h"

#include <algorithm>
#include <cmath>

namespace plab::ros
{
namespace
{

// Constants of simulation_interfaces: categories, how tags are combined, kinds of bounds.
constexpr std::uint8_t kDynamicObject = 4, kStaticObject = 5;
constexpr std::uint8_t kAllTags = 1;
constexpr std::uint8_t kNoBounds = 0, kBoxBounds = 1, kBallBounds = 3;

void include(std::optional<Box>& box, const Vec3& p)
{
    if (!box) box = Box{p, p};
    for (int k = 0; k < 3; ++k) box->low[k] = std::min(box->low[k], p[k]), box->high[k] = std::max(box->high[k], p[k]);
}

/// Half of the size of a solid along the axes of a frame in which it is turned by q.
Vec3 half_size(const link::Shape& shape, const Quat& q)
{
    const Vec3& s = shape.size;
    if (shape.form == "sphere") return {s.x, s.x, s.x};
    const Mat3 R = rotation_matrix(q);
    Vec3 out;
    for (int k = 0; k < 3; ++k)
    {
        const double along = std::abs(R(k, 2)), across = std::sqrt(std::max(0.0, 1 - along * along));
        if (shape.form == "box")
            out[k] = std::abs(R(k, 0)) * s.x + std::abs(R(k, 1)) * s.y + along * s.z;
        else if (shape.form == "capsule")
            out[k] = s.x + along * s.z;
        else
            out[k] = across * s.x + along * s.z;
    }
    return out;
}

bool is_solid(const link::Shape& shape)
{
    return shape.form == "sphere" || shape.form == "box" || shape.form == "capsule" || shape.form == "cylinder";
}

bool overlap(const Box& a, const Box& b)
{
    for (int k = 0; k < 3; ++k)
        if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
    return true;
}

bool overlap(const Box& box, const Vec3& centre, double radius)
{
    Vec3 nearest;
    for (int k = 0; k < 3; ++k) nearest[k] = std::clamp(centre[k], box.low[k], box.high[k]);
    return length_squared(nearest - centre) <= radius * radius;
}

}  // namespace

Motions::Motions(const plab_v2_Frame* frame)
{
    if (frame == nullptr) return;
    for (const plab_v2_BodyState& body : wire::items(frame->bodies)) bodies_.emplace(body.handle, &body);
    for (const plab_v2_ShaftState& shaft : wire::items(frame->shafts)) shafts_.emplace(shaft.handle, &shaft);
}

Motion Motions::of(const SceneFrame& entity) const
{
    if (const auto body = bodies_.find(entity.handle); body != bodies_.end())
        return {pose_of(*body->second), vec(body->second->linear_velocity), vec(body->second->angular_velocity)};
    if (const auto shaft = shafts_.find(entity.handle); shaft != shafts_.end())
        return {turned(entity.pose, shaft->second->angle), {}, rotate(entity.pose.q, {0, 0, shaft->second->speed})};
    return {entity.pose, {}, {}};
}

std::optional<Box> box_of(const link::Object& object, const link::CatalogueContents& scene)
{
    std::optional<Box> out;
    for (const std::string& id : object.shapes)
    {
        const auto at = scene.shapes.find(id);
        if (at == scene.shapes.end()) continue;
        const link::Shape& shape = at->second;
        if (shape.form == "plane") return {};
        const Pose X_BS{shape.position, shape.orientation};
        if (is_solid(shape))
        {
            const Vec3 half = half_size(shape, X_BS.q);
            include(out, X_BS.p - half), include(out, X_BS.p + half);
        }
        else
            for (const Vec3& vertex : shape.vertices) include(out, X_BS * vertex);
    }
    return out;
}

Box moved(const Box& box, const Pose& pose)
{
    const Mat3 R = rotation_matrix(pose.q);
    const Vec3 centre = pose * ((box.low + box.high) * 0.5), half = (box.high - box.low) * 0.5;
    Vec3 extent;
    for (int k = 0; k < 3; ++k) extent[k] = std::abs(R(k, 0)) * half.x + std::abs(R(k, 1)) * half.y + std::abs(R(k, 2)) * half.z;
    return {centre - extent, centre + extent};
}

std::uint8_t category_of(const link::Object& object) { return object.motion == "static" ? kStaticObject : kDynamicObject; }

std::vector<std::string> tags_of(const link::Object& object) { return {object.shape_of, object.motion, object.type_name}; }

msg::EntityState state_message(const Motion& motion, const msg::Time& stamp)
{
    msg::EntityState out{};
    out.header = {stamp, wire::text(kWorldFrame)};
    out.pose = pose_message(motion.pose);
    out.twist = {vector_of(motion.v), vector_of(motion.w)};
    return out;
}

Outcome EntityFilter::read(const msg::EntityFilters& filters)
{
    constexpr std::size_t kLongest = 256;
    if (const std::string text = text_of(filters.filter); !text.empty())
    {
        // Repeated repetitions and back references can take any time and any memory.
        if (text.size() > kLongest || text.find_first_of("{\\") != std::string::npos)
            return {Code::Unsupported, "a filter may have 256 characters, without { and \\"};
        std::unique_ptr<regex_t> pattern = std::make_unique<regex_t>();
        if (const int error = regcomp(pattern.get(), text.c_str(), REG_EXTENDED | REG_NOSUB); error != 0)
        {
            char why[100] = "";
            (void)regerror(error, pattern.get(), why, sizeof why);
            return {Code::Failed, "the filter is no POSIX extended regular expression: " + std::string(why)};
        }
        pattern_.reset(pattern.release());
    }
    for (const auto& category : wire::items(filters.categories)) categories_.push_back(category.category);
    for (const char* tag : wire::items(filters.tags.tags)) tags_.push_back(text_of(tag));
    needs_all_tags_ = filters.tags.filter_mode == kAllTags;
    const auto points = wire::items(filters.bounds.points);
    const std::uint8_t type = filters.bounds.type;
    if (type == kNoBounds) return {};
    if (type != kBoxBounds && type != kBallBounds) return {Code::Unsupported, "bounds may be a box or a sphere"};
    if (points.size() != 2) return {Code::Failed, "bounds of this type have two points"};
    const Vec3 first = vector_from(points[0]), second = vector_from(points[1]);
    if (type == kBallBounds)
        ball_.emplace(first, second.x);
    else
        include(box_, first), include(box_, second);
    return {};
}

bool EntityFilter::fits_bounds(const link::Object& object, const link::CatalogueContents& scene, const Pose& pose) const
{
    if (!box_ && !ball_) return true;
    for (const std::string& id : object.shapes)
        if (const auto shape = scene.shapes.find(id); shape != scene.shapes.end() && shape->second.form == "plane")
            return true;  // without end
    // Without a shape of its own size, it is where its origin is.
    const Box box = moved(box_of(object, scene).value_or(Box{}), pose);
    return box_ ? overlap(box, *box_) : overlap(box, ball_->first, ball_->second);
}

bool EntityFilter::fits(const std::string& name, const link::Object& object, const link::CatalogueContents& scene, const Pose& pose) const
{
    if (pattern_ && regexec(pattern_.get(), name.c_str(), 0, nullptr, 0) != 0) return false;
    if (!categories_.empty() && std::ranges::find(categories_, category_of(object)) == categories_.end()) return false;
    if (!tags_.empty())
    {
        const std::vector<std::string> own = tags_of(object);
        const auto has = [&](const std::string& tag) { return std::ranges::find(own, tag) != own.end(); };
        if (needs_all_tags_ ? !std::ranges::all_of(tags_, has) : !std::ranges::any_of(tags_, has)) return false;
    }
    return fits_bounds(object, scene, pose);
}

}  // namespace plab::ros
