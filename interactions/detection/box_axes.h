/// Separating-axis test for two boxes.
#pragma once

#include "plab/vector.h"

namespace plab::detection
{

/// The axis along which two boxes are furthest apart, or overlap least: the signed gap is the maximum over the 15 axes
/// (Gottschalk, Lin, Manocha, OBBTree, SIGGRAPH 1996). Exact for overlapping boxes; a lower bound of the distance for separated
/// ones.
struct BoxAxis
{
    Vec3 normal;      ///< in the common frame, unit, from A to B
    double gap = 0;   ///< m
    int edge_a = -1;  ///< axis of A's edge; -1 if the axis is a face normal
    int edge_b = -1;
};
/// Stops at the first axis with a gap larger than `margin`.
BoxAxis find_box_axis(const Vec3& half_a, const Mat3& R_a, const Vec3& p_a, const Vec3& half_b, const Mat3& R_b, const Vec3& p_b,
                      double margin);

}  // namespace plab::detection
