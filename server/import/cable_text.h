/// A cable, and what acts along it, as components.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "import/component_text.h"

namespace plab::import
{

/// An end of a straight part.
struct PlacedEnd
{
    std::string body;  ///< id; "": it never moves
    Vec3 point;        ///< m, in the frame of the body, or in W
    Vec3 point_W;
};
struct PlacedPart
{
    PlacedEnd a, b;
    double divisor = 1;
};

struct CableText
{
    std::vector<std::string> lines;  ///< one component each
    std::string lost;                ///< not empty: why it is not carried over, or what of it
    bool needs_manager = false;      ///< of the id "manager"
    /// Where an actuator acts on it, if one can: the length is ratio (distance + start).
    struct Along
    {
        std::string place;  ///< attributes
        double ratio = 1, start = 0;
    };
    std::optional<Along> along;
};

/// Parts whose ends do not move relative to one another count with their length alone. One other part is a distance within bounds, with a
/// spring; two with one end each on a common body are a rope over wheels.
CableText cable_text(const Cable& cable, const std::vector<PlacedPart>& parts, Ids& ids);

}  // namespace plab::import
