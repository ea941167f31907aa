/// Many points by coordinate, for the search of the one that is furthest along a direction.
#pragma once

#include <span>
#include <vector>

#include "plab/vector.h"

namespace plab::detection
{

class PointColumns
{
public:
    PointColumns() = default;
    explicit PointColumns(std::span<const Vec3> points);

    struct Furthest
    {
        std::size_t index = 0;
        double along = 0;  ///< dot(d, point)
    };
    /// The first of the points for which dot(d, point) is largest. There must be a point.
    Furthest furthest(const Vec3& d) const;

private:
    /// Points that are compared at once; the last ones are filled up with the first point.
    static constexpr std::size_t kWidth = 4;
    std::vector<double> x_, y_, z_;
};

}  // namespace plab::detection
