/// The supporting face of a solid in a direction: the corner, edge, face or cylinder end that faces this direction.
#pragma once

#include "solid.h"

namespace plab::detection
{

struct FaceCorner
{
    Vec3 p;
    Vec3 inward;           ///< faces: unit, perpendicular to the edge that begins here, in the plane of the face
    std::uint32_t id = 0;  ///< number of the corner, and of the edge that begins here
};

struct SupportingFace
{
    enum class Kind : std::uint8_t
    {
        Corner,
        Line,
        Face,
        Disc,
    };
    Kind kind = Kind::Corner;
    bool upper = false;             ///< disc: whether it is the end at +z
    Vec3 normal;                    ///< of faces and discs: unit, outward
    std::span<FaceCorner> corners;  ///< of lines and faces; counter-clockwise as seen from outside
    const Solid* solid = nullptr;   ///< the solid that it belongs to

    bool flat() const { return kind >= Kind::Face; }
    /// A point of its plane.
    Vec3 origin() const;
    /// The part [begin, end] of p + t (q - p), t in [0, 1], that lies over a flat face, and the edges that cut it (-1: none).
    struct Cut
    {
        double begin = 0, end = 1;
        int edge_begin = -1, edge_end = -1;
        bool empty() const { return begin > end; }
    };
    Cut cut(const Vec3& p, const Vec3& q, double tolerance) const;
    bool covers(const Vec3& p, double tolerance) const;
};

/// The part of an edge that lies over a face, from the distances (m, > 0: inside) of its two ends from each edge of the face. An
/// end that is outside by at most `tolerance` counts as inside.
SupportingFace::Cut cut_by(std::span<const double> inside_begin, std::span<const double> inside_end, double tolerance);

/// Hull faces with more corners than this are represented by every second, third ... corner.
inline constexpr std::size_t kMostCorners = 32;

/// In direction d (unit, outward). A face counts if the cosine between its normal and d is at least `least_cosine`, an edge if
/// it is perpendicular to d within 0.1 (sine); the line of a capsule or of a cylinder's side counts at any slope if it is to be laid
/// `onto_a_face`: both of its ends are points that may touch. Corners are stored in `room` (at least kMostCorners; 4 for boxes).
SupportingFace supporting_face(const Solid& solid, const Vec3& d, double least_cosine, std::span<FaceCorner> room,
                               bool onto_a_face = false);
/// Whether d (unit) is the normal of a face or of a cylinder's end, but for rounding.
bool is_flat_towards(const Solid& solid, const Vec3& d);
/// The face of a box whose normal is closest to d.
SupportingFace box_face(const Solid& box, const Vec3& d, std::span<FaceCorner> room);

}  // namespace plab::detection
