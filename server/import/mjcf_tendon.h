/// <tendon> of MJCF: fixed ones, through which actuators act on joints.
#pragma once

#include "import/document.h"
#include "import/robot.h"

namespace plab::import
{

/// A length that is a sum of coordinates of joints.
struct FixedTendon
{
    struct Term
    {
        std::string joint;
        double coefficient = 1;
    };
    std::string name;
    std::vector<Term> terms;
    blueprint::TextPosition where;
};

/// <fixed> of `section`.
std::vector<FixedTendon> read_tendons(const XmlElement& section, Document& document);

/// Where all joints of a tendon follow one of them by couplings (<equality>), an actuator of the tendon acts on that joint: its length
/// changes with the joint's coordinate q by the sum of coefficients times ratios, and the work of its force is the same. Those of cables
/// stay as they are. Other actuators of tendons are listed and dropped, and so are fixed tendons without an actuator.
void put_on_joints(Robot& robot, const std::vector<FixedTendon>& tendons, Document& document);

}  // namespace plab::import
