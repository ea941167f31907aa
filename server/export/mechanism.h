/// A loaded scene as trees of joined bodies, each with what acts along the coordinate of its joint: what formats of robots can say.
///
/// Frames: W the world, B a body, P its parent. All at the present state.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "plab/result.h"
#include "world/world.h"

namespace plab::exported
{

inline constexpr std::size_t kWorld = std::size_t(-1);

enum class JointKind
{
    None,  ///< fixed to the parent
    Free,
    Hinge,
    Slide,
    Ball,
};

/// The joint of a body to its parent, and what acts along its coordinate q (rad or m), which grows from parent to body.
struct Joint
{
    std::string name;
    JointKind kind = JointKind::Free;
    Vec3 anchor, axis{0, 0, 1};  ///< in B, m; unit length
    double value = 0;            ///< q now
    double lower, upper;         ///< infinite: none
    double stiffness = 0, rest = 0, damping = 0, friction = 0, armature = 0;
};

struct Actuator
{
    std::string name, joint;
    double gear = 1, gain = 1;
    Vec3 bias;
    double control_lower, control_upper, force_lower, force_upper;
};

/// What closes a loop: a point, or everything, of two bodies (second may be the world); or the ratio of two joints' coordinates.
struct Equality
{
    enum class Kind
    {
        Connect,
        Weld,
        Ratio,  ///< q_second = factor q_first + constant
    };
    Kind kind = Kind::Connect;
    std::string name, first, second;
    Vec3 anchor;  ///< in the first body
    double factor = 1;
};

struct Body
{
    std::string name;
    std::uint32_t host = kNoIndex;  ///< index in the host tables
    std::size_t parent = kWorld;
    Pose X_PB;
    bool is_static = false, weightless = false;
    Joint joint;
    std::uint32_t type = 0, affinity = 0;  ///< which collide: a bit of one in the other of the other body
    double friction = 1;
};

struct Mechanism
{
    std::vector<Body> bodies;  ///< parents come first
    std::vector<Actuator> actuators;
    std::vector<Equality> equalities;
    Vec3 gravity;
    std::vector<std::pair<std::string, std::string>> exclusions;  ///< bodies that do not collide with one another
    Errors losses;                                                ///< component and reason, what the above cannot say
};

Mechanism mechanism_of(const world::World& world);

}  // namespace plab::exported
