#include "by_viewers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sight.h"

namespace plab::governors
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Ball ball_of(const GovernedComponent& g) { return {g.center, g.radius}; }

/// m: how much closer an eye and an object may come to one another in this time.
double approach(const Viewpoint& eye, const GovernedComponent& g, double look_ahead)
{
    return look_ahead * (length(eye.velocity) + g.speed);
}

Result<void> one_bound_per_level(const char* field, const Reals& bounds, std::int32_t levels)
{
    if (static_cast<std::int32_t>(bounds.size()) + 1 != levels)
        return reason(std::string(field) + " needs " + std::to_string(levels - 1) + " values for a ladder of " + std::to_string(levels) +
                      " levels, not " + std::to_string(bounds.size()));
    if (!std::is_sorted(bounds.begin(), bounds.end())) return reason(std::string(field) + " must ascend");
    return {};
}

}  // namespace

void DistanceRows::describe(Schema& schema)
{
    watch.describe(schema);
    schema.param(distances, "distances", unit::metre,
                 "ascending bounds, one fewer than levels: within the first one the level is the most exact one");
    schema.param(look_ahead, "look_ahead", unit::second, "distances are those that may be reached within this time")
        .or_else(0.5)
        .not_negative();
}

Result<void> choose_by_distance(const StepContext& context, Row row, DistanceRows& governors, LevelControl& control)
{
    if (!due(context, governors.watch.every[row])) return {};
    const Reals& bounds = governors.distances[row];
    if (auto fits = one_bound_per_level("distances", bounds, control.levels(row)); !fits) return fits;
    Look look(context, row, governors.watch, control);
    const auto level_at = [&](double distance) {
        return look.finest() -
               static_cast<std::int32_t>(std::count_if(bounds.begin(), bounds.end(), [&](double b) { return b < distance; }));
    };
    for (std::size_t k = 0; k < look.watched().size(); ++k)
    {
        const GovernedComponent& g = look.watched()[k];
        double nearest = kInfinity;
        std::uint32_t who = kNoIndex;
        for (const Viewpoint& eye : control.viewpoints())
        {
            const double distance = std::max(0.0, distance_to(eye, ball_of(g)) - approach(eye, g, governors.look_ahead[row]));
            if (distance < nearest) nearest = distance, who = eye.component;
        }
        std::int32_t level = level_at(nearest);
        // Cheaper only beyond the bound and its hysteresis.
        if (level < g.level) level = std::min(g.level, level_at(nearest / (1 + governors.watch.hysteresis[row])));
        if (!look.may_choose(k, level)) continue;
        (void)look.choose(k, level, who == kNoIndex ? "there is no viewer" : brief(nearest) + " m from " + std::string(control.id_of(who)));
    }
    return {};
}

void VisibilityRows::describe(Schema& schema)
{
    watch.describe(schema);
    schema.param(pixels, "pixels", unit::one,
                 "ascending bounds, one fewer than levels: an object whose picture is larger than the last one has the most exact level");
    schema.param(look_ahead, "look_ahead", unit::second, "what may come into view within this time counts as seen")
        .or_else(0.5)
        .not_negative();
    schema.param(margin, "margin", unit::radian, "what is outside of the picture by less than this angle counts as seen")
        .or_else(0.15)
        .not_negative();
    schema.role(occluders, "occluders", {Facet::Body}, "bodies that hide what is behind their boxes").optional();
    schema.output(in_view, "in_view", unit::one, "number of components that a viewer sees");
    schema.output(hidden, "hidden", unit::one, "number of those in view of a viewer that occluders hide from every viewer");
}

namespace
{

struct Seen
{
    double pixels = 0;
    std::uint32_t by = kNoIndex;
    bool hidden = false;  ///< it would be in view if nothing were in the way
};

/// What moves hides nothing: what is behind it may be seen at once.
std::vector<Occluder> boxes_of(const RefList& occluders, const Bodies& bodies, const Shapes& shapes, double look_ahead)
{
    constexpr double kMoved = 1e-3;  // m
    std::vector<Occluder> out;
    for (const Ref body : occluders)
        for (const Ref shape : bodies.shapes[body.index])
        {
            const Geometry& g = shapes.geometry[shape.index];
            if (g.kind != GeometryKind::Box) continue;
            const double speed =
                length(bodies.velocity[body.index]) + (length(g.pose.p) + length(g.size)) * length(bodies.angular_velocity[body.index]);
            if (speed * look_ahead > kMoved) continue;
            const Pose X_WB = bodies.pose(body.index);
            out.push_back({{X_WB * g.pose.p, X_WB.q * g.pose.q}, g.size});
        }
    return out;
}

/// Looks ahead by letting the ball grow by the way that eye and object may move, and by opening the pyramid by the margin.
Seen see(const GovernedComponent& g, std::span<const Viewpoint> eyes, std::span<const Occluder> boxes, double look_ahead, double margin)
{
    Seen out;
    for (const Viewpoint& eye : eyes)
    {
        const double reach = approach(eye, g, look_ahead);
        const Ball reached{g.center, g.radius + reach};
        if (!is_in_view(widened(eye, margin), reached)) continue;
        // An eye near the edge of a box sees what is far behind it much sooner than it moves that way. From where a box hides something is
        // a convex set, so what is hidden at both ends of the eye's way is hidden all along.
        const Vec3 soon = eye.position + look_ahead * eye.velocity;
        const auto hides = [&](const Occluder& box) { return is_hidden(eye.position, reached, box) && is_hidden(soon, reached, box); };
        if (std::any_of(boxes.begin(), boxes.end(), hides))
        {
            out.hidden = out.by == kNoIndex;
            continue;
        }
        Viewpoint near = eye;
        near.position = eye.position + normalized(g.center - eye.position) * std::min(reach, distance_to(eye, ball_of(g)));
        const double pixels = pixels_of(near, ball_of(g));
        if (out.by == kNoIndex || pixels > out.pixels) out = {pixels, eye.component, false};
    }
    return out;
}

}  // namespace

Result<void> choose_by_sight(const StepContext& context, Row row, VisibilityRows& governors, const Bodies& bodies, const Shapes& shapes,
                             LevelControl& control)
{
    if (!due(context, governors.watch.every[row])) return {};
    const Reals& bounds = governors.pixels[row];
    if (auto fits = one_bound_per_level("pixels", bounds, control.levels(row)); !fits) return fits;
    Look look(context, row, governors.watch, control);
    const std::vector<Occluder> boxes = boxes_of(governors.occluders[row], bodies, shapes, governors.look_ahead[row]);
    const auto level_at = [&](double pixels)
    { return static_cast<std::int32_t>(std::count_if(bounds.begin(), bounds.end(), [&](double b) { return pixels > b; })); };
    governors.in_view[row] = governors.hidden[row] = 0;
    for (std::size_t k = 0; k < look.watched().size(); ++k)
    {
        const GovernedComponent& g = look.watched()[k];
        const Seen seen = see(g, control.viewpoints(), boxes, governors.look_ahead[row], governors.margin[row]);
        const bool visible = seen.by != kNoIndex;
        governors.in_view[row] += visible ? 1 : 0, governors.hidden[row] += !visible && seen.hidden ? 1 : 0;
        std::int32_t level = visible ? level_at(seen.pixels) : 0;
        if (visible && level < g.level) level = std::min(g.level, level_at(seen.pixels * (1 + governors.watch.hysteresis[row])));
        if (!look.may_choose(k, level)) continue;
        (void)look.choose(k, level,
                          visible       ? brief(seen.pixels) + " pixels for " + std::string(control.id_of(seen.by))
                          : seen.hidden ? "hidden from every viewer"
                                        : "out of every viewer's sight");
    }
    return {};
}

}  // namespace plab::governors
