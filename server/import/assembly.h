/// A robot as the bodies of pLab: links that are fixed to one another are one body, and each has its place in the world at the start.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "import/document.h"
#include "import/robot.h"

namespace plab::import
{

/// A joint with the place of its anchor and axis in the world.
struct PlacedJoint
{
    Joint joint;
    Vec3 anchor_W, axis_W;
};

struct PlacedBody
{
    std::string name;
    std::size_t parent = kWorld;  ///< the body that it hangs on; kWorld for free bodies and those that never move
    bool fixed = false;           ///< never moves
    bool weightless = true;       ///< gravity acts on none of its parts
    bool self_collide = true;     ///< one of its parts collides with the other links of its model
    std::size_t model = 0;
    Pose X_WB;
    std::vector<PlacedJoint> joints;
    MassProperties mass;  ///< in B
    std::vector<RobotShape> shapes;
    std::size_t tree = 0;  ///< number of the first moving body of its tree; its own if it is fixed
    TextPosition where;
};

struct Assembly
{
    /// Where a body of the file has gone.
    struct Frame
    {
        std::size_t body = 0;
        Pose pose;  ///< of the file's body in that one
    };

    std::vector<PlacedBody> bodies;
    std::map<std::string, Frame> frames;       ///< by the names of the file's bodies
    std::map<std::string, std::size_t> moved;  ///< by joint: the number of the body that it moves
};

/// Errors: a body that moves and has no mass.
Assembly assemble(const Robot& robot, Document& document);

}  // namespace plab::import
