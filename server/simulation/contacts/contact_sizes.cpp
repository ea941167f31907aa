// Sizes of bodies, from which margins and bounds follow.
#include <algorithm>
#include <cmath>

#include "plab/surface.h"
#include "simulation/contacts/contact_book.h"
#include "simulation/contacts/paradox.h"
#include "simulation/contacts/shape_width.h"
#include "world/bounding_radius.h"

namespace plab::simulation
{
namespace
{

/// A point of contact may lie outside of a body by this fraction of its radius where Painleve's paradox is excluded by the body's size.
constexpr double kOutside = 0.01;

/// m: radius of the most strongly curved part of a shape, negative for surfaces that are touched from inside; infinite if it has none.
double curve_radius(const Shapes& shapes, std::uint32_t shape)
{
    double least = HUGE_VAL;
    const auto add = [&](const Geometry& g)
    {
        const bool round = g.kind == GeometryKind::Sphere || g.kind == GeometryKind::Capsule || g.kind == GeometryKind::Cylinder;
        if (round && g.size.x < std::fabs(least)) least = g.size.x;
        const Surface surface = surface_of(g);
        const bool inside = surface == Surface::Bore || surface == Surface::Bowl;
        if (inside && surface_radius(g) < std::fabs(least)) least = -surface_radius(g);
    };
    add(shapes.geometry[shape]);
    for (const std::uint32_t part : shapes.geometry[shape].parts) add(shapes.geometry[part]);
    return least;
}

/// m: half of the smallest width of a shape, of a compound that of its thinnest part; infinite for planes and surfaces.
double half_thickness(const Shapes& shapes, std::uint32_t shape)
{
    const auto of = [](const Geometry& g) {
        return std::min({half_width_along(g, {1, 0, 0}), half_width_along(g, {0, 1, 0}), half_width_along(g, {0, 0, 1})});
    };
    double least = of(shapes.geometry[shape]);
    for (const std::uint32_t part : shapes.geometry[shape].parts) least = std::min(least, of(shapes.geometry[part]));
    return least;
}

/// m: half the size along the axes of the shape's frame; infinite for shapes that it does not know.
Vec3 extents_of(const Geometry& g)
{
    if (g.kind == GeometryKind::Box) return g.size;
    if (g.kind == GeometryKind::Sphere) return {g.size.x, g.size.x, g.size.x};
    if (g.kind == GeometryKind::Cylinder) return {g.size.x, g.size.x, g.size.z};
    if (g.kind == GeometryKind::Capsule) return {g.size.x, g.size.x, g.size.x + g.size.z};
    return {HUGE_VAL, HUGE_VAL, HUGE_VAL};
}

}  // namespace

/// Many bodies may share a shape, so each shape is measured once.
void ContactBook::measure_bodies()
{
    const world::HostTables& host = step_.world.host();
    const Bodies& bodies = host.bodies;
    std::vector<double> curves(host.shapes.size()), radii(host.shapes.size());
    for (std::uint32_t k = 0; k < curves.size(); ++k)
        curves[k] = curve_radius(host.shapes, k), radii[k] = world::bounding_radius(host.shapes.geometry[k]);
    std::vector<double> thin(host.shapes.size());
    for (std::uint32_t k = 0; k < thin.size(); ++k) thin[k] = half_thickness(host.shapes, k);
    curve_radius_of_body_.assign(bodies.size(), HUGE_VAL), radius_of_body_.assign(bodies.size(), 0.0);
    thickness_of_body_.assign(bodies.size(), HUGE_VAL);
    extents_of_body_.assign(bodies.size(), {});
    for (std::size_t b = 0; b < bodies.size(); ++b)
        for (const Ref shape : bodies.shapes[b])
        {
            double& curve = curve_radius_of_body_[b];
            if (std::fabs(curves[shape.index]) < std::fabs(curve)) curve = curves[shape.index];
            thickness_of_body_[b] = std::min(thickness_of_body_[b], thin[shape.index]);
            const Geometry& g = host.shapes.geometry[shape.index];
            const Vec3 p_CS = g.pose.p - bodies.center_B[b], half = extents_of(g);
            radius_of_body_[b] = std::max(radius_of_body_[b], length(p_CS) + radii[shape.index]);
            const Mat3 R = rotation_matrix(g.pose.q);
            Vec3& extents = extents_of_body_[b];
            for (int i = 0; i < 3; ++i)
            {
                double reach = std::fabs(p_CS[i]);
                for (int k = 0; k < 3; ++k) reach += R(i, k) != 0 ? std::fabs(R(i, k)) * half[k] : 0.0;
                extents[i] = std::max(extents[i], reach);
            }
        }
}

bool ContactBook::is_of_present_structure() const { return built_from_ && step_.world.revisions().keeps_contacts_since(*built_from_); }

void ContactBook::take_sizes(const ContactBook& whole)
{
    const world::Revisions now = step_.world.revisions();
    if (!whole.has_sizes_ || !whole.built_from_ || !now.keeps_bodies_since(*whole.built_from_)) return;
    extents_of_body_ = whole.extents_of_body_, radius_of_body_ = whole.radius_of_body_;
    curve_radius_of_body_ = whole.curve_radius_of_body_, thickness_of_body_ = whole.thickness_of_body_;
    built_from_ = now, has_sizes_ = true;
}

double ContactBook::wedging_of(std::uint32_t b) const
{
    const double outside = kOutside * radius_of_body_[b];
    return wedging(step_.world.host().bodies, b, extents_of_body_[b] + Vec3{outside, outside, outside}, radius_of_body_[b] + outside);
}

// The point is midway between the two surfaces.
double ContactBook::depth_that_excludes(Ref a, Ref b) const { return 2 * kOutside * smaller_radius(a, b); }

}  // namespace plab::simulation
