/// Contact manifolds: the contact points of two solids, from the parts of their surfaces that face one another.
///
/// One pair of closest points cannot hold a box upright, so all points at which the two surfaces may touch are needed. The
/// method is clipping. For the given contact normal, each solid contributes its supporting face: the face, edge, corner or disc
/// furthest along the normal (supporting_face.h). Each of the two is projected along the normal onto the plane of the other.
/// Contact points are the corners of one face that lie within the other, and the crossings of their edges. Every point has its
/// own depth along the normal. If none of them is as deep as the closest points (two corners, or crossing edges), the closest
/// points are the contact.
///
/// A feature number names what meets at a point: a corner with a face, or two edges. It lets the solver recognise a contact
/// point in the next step and start from its last impulse, so it must not change while the same features touch.
#pragma once

#include "contact_points.h"
#include "solid.h"

namespace plab::detection
{

/// Feature numbers, by what meets: a corner of A or of B on the other solid, two crossing edges, or the closest points alone.
std::uint32_t corner_feature(bool of_a, std::uint32_t corner);
std::uint32_t crossing_feature(std::uint32_t edge_a, std::uint32_t edge_b);
inline constexpr std::uint32_t kNearestFeature = 3u << 18;
/// The same feature with A and B exchanged.
std::uint32_t mirrored_feature(std::uint32_t feature);

/// Adds the contact points for the normal and gap of `s`, the signed distance of the solids. The deepest point has the depth of
/// `s`. If there are many points, at most 9 are kept: the outermost ones and the deepest.
void add_manifold(const Solid& A, const Solid& B, const Separation& s, ContactPoints& out);

/// The same for two boxes, by their 15 separating axes: faster, and the result agrees.
void box_box(const Solid& A, const Solid& B, ContactPoints& out);

}  // namespace plab::detection
