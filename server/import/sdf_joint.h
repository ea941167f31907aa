/// A <joint> of SDF as joints of the model: one, none (fixed) or two (universal).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "import/robot.h"
#include "import/sdf_frames.h"

namespace plab::import
{

/// One axis of a joint follows that of another one: q = multiplier (q of the leader - reference) + offset.
struct SdfMimic
{
    std::string leader, follower;  ///< full names of joints as they are in SdfJoint::joints
    double multiplier = 1, offset = 0, reference = 0;
    TextPosition where;
};

struct SdfJoint
{
    std::string full, scope;    ///< its full name, and that of its model
    std::string parent, child;  ///< full names of links; "" for the world
    std::vector<Joint> joints;  ///< from the parent outwards, in the frame of the child
    std::vector<SdfMimic> mimics;
    TextPosition where;
};

/// `version`: of its file; it decides in which frame axes are meant. `full` must be among the frames. None with an error.
std::optional<SdfJoint> read_sdf_joint(const XmlElement& e, const std::string& scope, const std::string& full, double version,
                                       SdfFrames& frames, Document& document);

}  // namespace plab::import
