/// Seams between the parts of a body: where another body passes from one part to the next one beside it, and their surfaces are flush.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "collider.h"

namespace plab::detection
{

/// A part of each of two bodies that touch, at poses as for collide().
struct PartContact
{
    const Collider *a = nullptr, *b = nullptr;
    Pose X_a, X_b;
    std::size_t first = 0, end = 0;  ///< places of its points in the list of all
    Vec3 normal;                     ///< of the deepest point, a to b
    double depth = 0;                ///< m, of that
    bool passes = false;
};

/// Marks the contacts, of all parts of two bodies, that are across a seam. Just before a body that lies on one part reaches the next part,
/// the nearest points of the two lie on edges, and the normal there points against the motion. But parts that are apart along the normal of
/// the surface on which the bodies lie are no obstacle to one another.
void mark_seams(std::span<PartContact> contacts);

/// m: parts with a gap up to this touch as far as seams are concerned, whatever contacts are asked for.
double seam_margin(const Collider& a, const Collider& b);

/// Takes those out of the list of all points, and from its place `from` on all points with a gap of more than `margin` (m); forgets the
/// parts.
template <class Point>
void drop_seams(std::vector<PartContact>& contacts, std::vector<Point>& points, std::size_t from, double margin)
{
    if (contacts.empty()) return;
    if (contacts.size() > 1) mark_seams(contacts);
    const auto at = [&](std::size_t place) { return points.begin() + static_cast<std::ptrdiff_t>(place); };
    for (auto c = contacts.rbegin(); c != contacts.rend(); ++c)
        if (c->passes) points.erase(at(c->first), at(c->end));
    points.erase(std::remove_if(at(from), points.end(), [&](const Point& p) { return !(p.at.depth > -margin); }), points.end());
    contacts.clear();
}

}  // namespace plab::detection
