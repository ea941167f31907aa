/// The part of a solid's surface that faces a direction: a corner, an edge, a face or the end of a cylinder.
#pragma once

#include "solid.h"

namespace plab::detection
{

struct FaceCorner
{
    Vec3 p;
    Vec3 inward;           ///< faces: unit, square to the edge that begins here, in the face's plane
    std::uint32_t id = 0;  ///< of the corner, and of the edge that begins here
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
    bool upper = false;             ///< disc: the end at +z
    Vec3 normal;                    ///< of faces and discs: unit, outwards
    std::span<FaceCorner> corners;  ///< of lines and faces, counter-clockwise seen from outside
    const Solid* solid = nullptr;   ///< whose it is

    bool flat() const { return kind >= Kind::Face; }
    /// A point of its plane.
    Vec3 origin() const;
    /// The part [begin, end] of p + t (q - p), t in [0, 1], that lies over a flat patch; which edges cut it (-1: none).
    struct Cut
    {
        double begin = 0, end = 1;
        int edge_begin = -1, edge_end = -1;
        bool empty() const { return begin > end; }
    };
    Cut cut(const Vec3& p, const Vec3& q, double tolerance) const;
    bool covers(const Vec3& p, double tolerance) const;
};

/// The part of an edge that lies over a face, from how far its two ends are inside of each of the face's edges (m). An end
/// that is out by no more than `tolerance` counts as in.
SupportingFace::Cut cut_by(std::span<const double> inside_begin, std::span<const double> inside_end, double tolerance);

/// Faces of hulls with more corners than this are seen with every second, third ... corner.
inline constexpr std::size_t kMostCorners = 32;

/// In direction d (unit, outwards). Faces count if the cosine between their normal and d is at least `least_cosine`, edges
/// if they are square to d within 0.1. Corners are put into `room` (at least kMostCorners; 4 for boxes).
SupportingFace supporting_face(const Solid& solid, const Vec3& d, double least_cosine, std::span<FaceCorner> room);
/// The face of a box that faces d most.
SupportingFace box_face(const Solid& box, const Vec3& d, std::span<FaceCorner> room);

}  // namespace plab::detection
