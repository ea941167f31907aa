#include "bench/peers/penetration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace plab::peers
{
namespace
{

struct Placed
{
    const BodySpec* spec;
    Vec3 center;
    std::array<Vec3, 3> axes;  ///< of the box, in W
    double bounding_radius;    ///< m, radius of the ball around it
};

Placed place(const BodySpec& spec, const BodyState& s)
{
    const Mat3 R = rotation_matrix(normalized(s.orientation));
    Placed p{&spec, s.position, {}, spec.form == Form::Sphere ? spec.half.x : length(spec.half)};
    for (int i = 0; i < 3; ++i) p.axes[static_cast<std::size_t>(i)] = {R(0, i), R(1, i), R(2, i)};
    return p;
}

/// Half of the extent along the unit vector n.
double half_width(const Placed& p, const Vec3& n)
{
    if (p.spec->form == Form::Sphere) return p.spec->half.x;
    return p.spec->half.x * std::fabs(dot(p.axes[0], n)) + p.spec->half.y * std::fabs(dot(p.axes[1], n)) +
           p.spec->half.z * std::fabs(dot(p.axes[2], n));
}

double overlap_along(const Placed& a, const Placed& b, const Vec3& n)
{
    return half_width(a, n) + half_width(b, n) - std::fabs(dot(b.center - a.center, n));
}

double box_depth(const Placed& a, const Placed& b)
{
    double least = 1e300;
    const auto separate_along = [&](const Vec3& axis)
    {
        const double size = length(axis);
        if (size > 1e-6) least = std::fmin(least, overlap_along(a, b, axis / size));
        return least > 0;
    };
    for (const Vec3& axis : a.axes)
        if (!separate_along(axis)) return least;
    for (const Vec3& axis : b.axes)
        if (!separate_along(axis)) return least;
    for (const Vec3& u : a.axes)
        for (const Vec3& v : b.axes)
            if (!separate_along(cross(u, v))) return least;
    return least;
}

double pair_depth(const Placed& a, const Placed& b)
{
    if (a.spec->form == Form::Sphere && b.spec->form == Form::Sphere)
        return a.bounding_radius + b.bounding_radius - length(b.center - a.center);
    return box_depth(a, b);
}

struct Tally
{
    Penetration result;
    double sum = 0;

    void add(double depth)
    {
        if (!(depth > 0)) return;
        result.deepest = std::fmax(result.deepest, depth);
        sum += depth;
        ++result.pairs;
    }
};

void add_half_spaces(const Scene& scene, const Placed& p, Tally& tally)
{
    const auto add = [&](const Vec3& n, double offset) { tally.add(offset + half_width(p, n) - dot(p.center, n)); };
    if (scene.ground) add({0, 0, 1}, 0);
    if (scene.container <= 0) return;
    for (const Vec3& n : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}}) add(n, -scene.container);
}

}  // namespace

Penetration penetration_of(const Scene& scene, std::span<const BodyState> states)
{
    std::vector<Placed> placed;
    for (std::size_t i = 0; i < states.size(); ++i) placed.push_back(place(scene.bodies[i], states[i]));
    std::sort(placed.begin(), placed.end(),
              [](const Placed& a, const Placed& b) { return a.center.x - a.bounding_radius < b.center.x - b.bounding_radius; });
    Tally tally;
    for (std::size_t i = 0; i < placed.size(); ++i)
    {
        const Placed& a = placed[i];
        add_half_spaces(scene, a, tally);
        for (std::size_t j = i + 1; j < placed.size() && placed[j].center.x - placed[j].bounding_radius < a.center.x + a.bounding_radius;
             ++j)
        {
            const double bounding_radius = a.bounding_radius + placed[j].bounding_radius;
            if (length_squared(placed[j].center - a.center) < bounding_radius * bounding_radius) tally.add(pair_depth(a, placed[j]));
        }
    }
    if (tally.result.pairs > 0) tally.result.mean = tally.sum / tally.result.pairs;
    return tally.result;
}

}  // namespace plab::peers
