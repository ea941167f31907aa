#include "supporting_face.h"

#include <algorithm>
#include <cmath>

namespace plab::detection
{
namespace
{
constexpr double kSquare = 0.1;  ///< sine up to which an edge counts as perpendicular to a direction

double sign_of(double x) { return x < 0 ? -1.0 : 1.0; }

Vec3 box_corner(const Vec3& h, std::uint32_t id) { return {id & 1 ? h.x : -h.x, id & 2 ? h.y : -h.y, id & 4 ? h.z : -h.z}; }

void set_inward(std::span<FaceCorner> corners, const Vec3& normal)
{
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        const Vec3 edge = corners[(i + 1) % corners.size()].p - corners[i].p;
        corners[i].inward = normalized(cross(normal, edge));
    }
}

SupportingFace corner_of(const Solid& solid)
{
    SupportingFace out;
    out.solid = &solid;
    return out;
}

SupportingFace line_of(const Solid& solid, std::span<FaceCorner> room, const Vec3& p, std::uint32_t id_p, const Vec3& q, std::uint32_t id_q)
{
    SupportingFace out;
    out.kind = SupportingFace::Kind::Line, out.solid = &solid;
    room[0].p = p, room[0].id = id_p, room[1].p = q, room[1].id = id_q;
    out.corners = room.first(2);
    return out;
}

SupportingFace supporting_box_face(const Solid& box, const Vec3& d, double least_cosine, std::span<FaceCorner> room)
{
    const Vec3 l = box.to_local_direction(d);
    if (std::max({std::fabs(l.x), std::fabs(l.y), std::fabs(l.z)}) >= least_cosine) return box_face(box, d, room);
    int k = 0;
    for (int i = 1; i < 3; ++i)
        if (std::fabs(l[i]) < std::fabs(l[k])) k = i;
    if (std::fabs(l[k]) >= kSquare) return corner_of(box);
    std::uint32_t id = 0;
    for (int i = 0; i < 3; ++i)
        if (i != k && l[i] >= 0) id |= 1u << i;
    const std::uint32_t other = id | (1u << k);
    return line_of(box, room, box.from_local(box_corner(box.size(), id)), id, box.from_local(box_corner(box.size(), other)), other);
}

SupportingFace supporting_segment(const Solid& s, const Vec3& d, double most_slope, std::span<FaceCorner> room)
{
    const Vec3 u = s.axis(2);
    if (std::fabs(dot(u, d)) >= most_slope) return corner_of(s);
    return line_of(s, room, s.pose().p - s.size().z * u, 0, s.pose().p + s.size().z * u, 1);
}

SupportingFace supporting_cylinder_face(const Solid& c, const Vec3& d, double least_cosine, double most_slope, std::span<FaceCorner> room)
{
    const Vec3 u = c.axis(2);
    const double along = dot(u, d);
    if (std::fabs(along) >= least_cosine)
    {
        SupportingFace out;
        out.kind = SupportingFace::Kind::Disc, out.solid = &c, out.upper = along > 0, out.normal = sign_of(along) * u;
        return out;
    }
    if (std::fabs(along) >= most_slope) return corner_of(c);
    const Vec3 side = c.pose().p + c.size().x * normalized(d - along * u);
    return line_of(c, room, side - c.size().z * u, 4, side + c.size().z * u, 12);
}

/// The polygon of a hull whose normal is nearest to d; the number of polygons if none is near enough.
std::size_t find_polygon(const Hull& hull, const Vec3& d_S, double least_cosine)
{
    const PointColumns::Furthest most = hull.loop_normal_columns.furthest(d_S);
    return most.along >= least_cosine ? most.index : hull.loop_normals.size();
}

SupportingFace hull_face(const Solid& solid, std::size_t polygon, std::span<FaceCorner> room)
{
    const Hull& hull = solid.hull();
    const std::size_t first = polygon == 0 ? 0 : hull.loop_end[polygon - 1], count = hull.loop_end[polygon] - first;
    const std::size_t stride = (count + kMostCorners - 1) / kMostCorners;
    SupportingFace out;
    out.kind = SupportingFace::Kind::Face, out.solid = &solid, out.normal = solid.from_local_direction(hull.loop_normals[polygon]);
    std::size_t n = 0;
    for (std::size_t i = 0; i < count; i += stride, ++n)
    {
        const std::uint32_t v = hull.loop[first + i];
        room[n].p = solid.from_local(hull.vertices[v]), room[n].id = v;
    }
    out.corners = room.first(n);
    set_inward(out.corners, out.normal);
    return out;
}

SupportingFace supporting_hull_face(const Solid& solid, const Vec3& d, double least_cosine, std::span<FaceCorner> room)
{
    const Hull& hull = solid.hull();
    const Vec3 d_S = solid.to_local_direction(d);
    if (const std::size_t polygon = find_polygon(hull, d_S, least_cosine); polygon < hull.loop_normals.size())
        return hull_face(solid, polygon, room);
    const std::array<std::uint32_t, 2>* best = nullptr;
    double highest = -HUGE_VAL;
    for (const auto& e : hull.edges)
    {
        const Vec3 along = hull.vertices[e[1]] - hull.vertices[e[0]];
        const double rise = dot(d_S, along);
        if (rise * rise >= kSquare * kSquare * length_squared(along)) continue;
        const double height = dot(d_S, hull.vertices[e[0]]) + dot(d_S, hull.vertices[e[1]]);
        if (height > highest) highest = height, best = &e;
    }
    const double top = hull.vertex_columns.furthest(d_S).along;
    const bool at_top = best && std::max(dot(d_S, hull.vertices[(*best)[0]]), dot(d_S, hull.vertices[(*best)[1]])) >= top;
    if (!at_top) return corner_of(solid);
    return line_of(solid, room, solid.from_local(hull.vertices[(*best)[0]]), (*best)[0], solid.from_local(hull.vertices[(*best)[1]]),
                   (*best)[1]);
}

/// Restricts `cut` to where g0 + t (g1 - g0) >= 0; an end that is outside by at most the tolerance counts as inside.
void narrow(SupportingFace::Cut& cut, double g0, double g1, double tolerance, int edge)
{
    const bool out0 = g0 < -tolerance, out1 = g1 < -tolerance;
    if (!out0 && !out1) return;
    if ((out0 && g1 <= 0) || (out1 && g0 <= 0))
    {
        cut = {1, 0, -1, -1};
        return;
    }
    const double t = g0 / (g0 - g1);
    if (out0 && t > cut.begin) cut.begin = t, cut.edge_begin = edge;
    if (out1 && t < cut.end) cut.end = t, cut.edge_end = edge;
}
}  // namespace

SupportingFace::Cut cut_by(std::span<const double> inside_begin, std::span<const double> inside_end, double tolerance)
{
    SupportingFace::Cut out;
    for (std::size_t k = 0; k < inside_begin.size() && !out.empty(); ++k)
        narrow(out, inside_begin[k], inside_end[k], tolerance, static_cast<int>(k));
    return out;
}

Vec3 SupportingFace::origin() const
{
    if (kind != Kind::Disc) return corners[0].p;
    return solid->pose().p + (upper ? solid->size().z : -solid->size().z) * solid->axis(2);
}

SupportingFace::Cut SupportingFace::cut(const Vec3& p, const Vec3& q, double tolerance) const
{
    Cut out;
    if (kind == Kind::Face)
    {
        std::array<double, kMostCorners> begin, end;
        for (std::size_t k = 0; k < corners.size(); ++k)
        {
            begin[k] = dot(p - corners[k].p, corners[k].inward);
            end[k] = dot(q - corners[k].p, corners[k].inward);
        }
        return cut_by({begin.data(), corners.size()}, {end.data(), corners.size()}, tolerance);
    }
    // |p - c + t d|^2 <= r^2
    const Vec3 from = p - origin(), d = q - p;
    const double r = solid->size().x, wide = r + tolerance;
    const double aa = length_squared(d), b = dot(from, d), c = length_squared(from) - r * r;
    const double root = b * b - aa * c;
    const bool begins = length(from) <= wide, ends = length(q - origin()) <= wide;
    if (begins && ends) return out;
    if (!(aa > 0) || root < 0) return {1, 0, -1, -1};
    const double half = std::sqrt(root);
    const double t0 = (-b - half) / aa, t1 = (-b + half) / aa;
    if (!begins) out.begin = t0, out.edge_begin = 0;
    if (!ends) out.end = t1, out.edge_end = 1;
    return out.begin < 0 || out.end > 1 ? Cut{1, 0, -1, -1} : out;
}

bool SupportingFace::covers(const Vec3& p, double tolerance) const
{
    if (kind == Kind::Disc) return length(p - origin()) <= solid->size().x + tolerance;
    return std::all_of(corners.begin(), corners.end(), [&](const FaceCorner& c) { return dot(p - c.p, c.inward) >= -tolerance; });
}

SupportingFace box_face(const Solid& box, const Vec3& d, std::span<FaceCorner> room)
{
    const Vec3 l = box.to_local_direction(d);
    int k = 0;
    for (int i = 1; i < 3; ++i)
        if (std::fabs(l[i]) > std::fabs(l[k])) k = i;
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    const bool upper = l[k] > 0;
    const Vec3& h = box.size();
    const Vec3 axis_u = box.axis(u), axis_v = box.axis(v), normal = box.axis(k) * (upper ? 1.0 : -1.0);
    const Vec3 middle = box.pose().p + normal * h[k];
    const std::uint32_t base = upper ? 1u << k : 0u;
    // Counter-clockwise as seen from outside: on the upper side, u comes before v.
    const Vec3 to_u = axis_u * h[u], to_v = axis_v * h[v], before = middle - to_u, beyond = middle + to_u;
    const std::uint32_t bit_u = 1u << u, bit_v = 1u << v;
    room[0].p = before - to_v, room[0].id = base;
    room[2].p = beyond + to_v, room[2].id = base | bit_u | bit_v;
    FaceCorner &far_u = room[upper ? 1 : 3], &far_v = room[upper ? 3 : 1];
    far_u.p = beyond - to_v, far_u.id = base | bit_u;
    far_v.p = before + to_v, far_v.id = base | bit_v;
    if (upper)
        room[0].inward = axis_v, room[1].inward = -axis_u, room[2].inward = -axis_v, room[3].inward = axis_u;
    else
        room[0].inward = axis_u, room[1].inward = -axis_v, room[2].inward = -axis_u, room[3].inward = axis_v;
    SupportingFace out;
    out.kind = SupportingFace::Kind::Face, out.normal = normal, out.corners = room.first(4), out.solid = &box;
    return out;
}

bool is_flat_towards(const Solid& solid, const Vec3& d)
{
    constexpr double kFlat = 1 - 1e-12;
    switch (solid.core())
    {
        case Core::Box:
        {
            const Vec3 l = solid.to_local_direction(d);
            return std::max({std::fabs(l.x), std::fabs(l.y), std::fabs(l.z)}) >= kFlat;
        }
        case Core::Cylinder:
            return std::fabs(dot(solid.axis(2), d)) >= kFlat;
        case Core::Hull:
            return find_polygon(solid.hull(), solid.to_local_direction(d), kFlat) < solid.hull().loop_normals.size();
        case Core::Segment:
        case Core::Point:
            break;
    }
    return false;
}

SupportingFace supporting_face(const Solid& solid, const Vec3& d, double least_cosine, std::span<FaceCorner> room, bool onto_a_face)
{
    const double most_slope = onto_a_face ? 1 : kSquare;
    switch (solid.core())
    {
        case Core::Segment:
            return supporting_segment(solid, d, most_slope, room);
        case Core::Box:
            return supporting_box_face(solid, d, least_cosine, room);
        case Core::Cylinder:
            return supporting_cylinder_face(solid, d, least_cosine, most_slope, room);
        case Core::Hull:
            return supporting_hull_face(solid, d, least_cosine, room);
        case Core::Point:
            break;
    }
    return corner_of(solid);
}

}  // namespace plab::detection
