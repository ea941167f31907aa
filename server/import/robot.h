/// What URDF, SDF and MJCF have in common: rigid bodies in trees, the joints between them, and their shapes. SI units and radians.
///
/// Frames: W the world, B a body, P its parent. Poses hold where all joints have the value `zero`.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blueprint/xml.h"
#include "import/meshes/mesh_module.h"
#include "plab/tables.h"
#include "plab/vector.h"

namespace plab::import
{

/// The parent of a body that hangs on nothing else.
inline constexpr std::size_t kWorld = std::numeric_limits<std::size_t>::max();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class JointKind
{
    Hinge,
    Slide,
    Ball,
};

/// One of the joints between a body and its parent. Its coordinate q (rad or m) is that of the file.
struct Joint
{
    std::string name;
    JointKind kind = JointKind::Hinge;
    double lead = 0;     ///< m: if not 0, a hinge is a screw that travels so far along its axis in a turn
    Vec3 anchor;         ///< in B, m
    Vec3 axis{0, 0, 1};  ///< in B, unit length
    double zero = 0;     ///< q in the pose that the file gives
    double start = 0;    ///< q at the beginning of the run
    double lower = -kInfinity, upper = kInfinity;
    double stiffness = 0, rest = 0;  ///< N m/rad or N/m; q without force
    double damping = 0;              ///< N m s/rad or N s/m
    double friction = 0;             ///< largest dry friction, N m or N
    double armature = 0;             ///< inertia of a rotor as the joint feels it, kg m^2 or kg: it adds 1/2 armature q'^2 to the energy
    blueprint::TextPosition where;
};

/// A force along the coordinate q of a joint that somebody controls: with l = gear q and a control u within its bounds,
/// F = gain u + bias.x + bias.y l + bias.z l' within its bounds, and gear F (N m or N) acts.
struct Actuator
{
    std::string name, joint;
    std::string tendon;  ///< if there is no joint: the Cable along which it acts, or a tendon whose joint is not known yet (mjcf_tendon.h)
    std::vector<std::string> relies_on;  ///< names of couplings without which it would act otherwise
    double gear = 1, gain = 1;
    Vec3 bias;
    double control_lower = -kInfinity, control_upper = kInfinity, force_lower = -kInfinity, force_upper = kInfinity;
    blueprint::TextPosition where;
};

enum class ShapeKind
{
    Box,        ///< size: half extents
    Sphere,     ///< size.x: radius
    Cylinder,   ///< size.x: radius, size.z: half of the height, along z
    Capsule,    ///< size.x: radius, size.z: half of the straight part, along z
    Ellipsoid,  ///< size: semi-axes
    Plane,      ///< solid below z = 0
    Mesh,
};

/// The two numbers of MJCF's solref (surface_law.h).
struct Solref
{
    double first = 0.02, second = 1;
    auto operator<=>(const Solref&) const = default;
};

/// How a shape touches others. The order is that of roughness.
struct Surface
{
    double friction = 1;     ///< Coulomb coefficient
    double restitution = 0;  ///< Newton's coefficient; in MJCF it follows from solref
    int priority = 0;        ///< of MJCF: of two surfaces the one with the greater number counts alone
    /// condim of MJCF: 1 without friction, 3 with sliding friction, from 4 on also that of twisting, with 6 of rolling. The larger one of
    /// two surfaces counts.
    int dimensions = 3;
    double twisting = 0.005, rolling = 0.0001;  ///< m, as usual in MJCF
    Solref solref;
    std::string own;  ///< not empty: that of this body alone, for laws of its own
    auto operator<=>(const Surface&) const = default;
};

/// How the laws of two surfaces are combined.
enum class SurfaceRule
{
    MuJoCo,  ///< the larger friction
    Gazebo,  ///< the smaller friction and restitution
};

struct RobotShape
{
    ShapeKind kind = ShapeKind::Box;
    Pose pose;  ///< X_BS
    Vec3 size;
    std::shared_ptr<const TriangleMesh> mesh;
    std::optional<Vec3> color;
    bool collides = true;
    bool is_surface = false;  ///< it collides as its triangles, not as their hull
    std::uint32_t contact_type = 1, contact_affinity = 1;  ///< it collides with what has one of its bits in the other word
    Surface surface;
    std::string name, owner;  ///< of the shape, may be empty; of the file's body, once it is assembled
    blueprint::TextPosition where;
};

struct RobotBody
{
    std::string name;
    std::size_t parent = kWorld;
    Pose pose;                  ///< X_PB
    bool free = false;          ///< moves freely in the world, wherever it begins
    bool weightless = false;    ///< gravity does not act on it
    bool self_collide = true;   ///< collides with the other links of its model
    std::size_t model = 0;      ///< number of the model that it is a part of
    std::vector<Joint> joints;  ///< from the parent outwards; none and not free: fixed to the parent
    MassProperties mass;        ///< in B
    std::vector<RobotShape> shapes;
    blueprint::TextPosition where;
};

enum class CouplingKind
{
    Gear,   ///< first, second: joints; q_second changes by `factor` times what q_first changes
    Point,  ///< first, second: bodies (second may be empty: the world) that share the point `anchor` of the first
    Weld,   ///< first, second: bodies that do not move relative to one another
    Loop,   ///< first, second: bodies (second may be empty: the world) between which `joint`, in the frame of the first, closes a loop
};

struct Coupling
{
    CouplingKind kind = CouplingKind::Gear;
    std::string name, first, second;
    double factor = 1;
    Vec3 anchor;
    Joint joint;
    blueprint::TextPosition where;
};

/// A rope, or an elastic band, of one or several straight parts between bodies. Its length is their sum, each divided by a number.
struct Cable
{
    struct End
    {
        std::string body;
        Vec3 point;  ///< m, in B
    };
    struct Part
    {
        End a, b;
        double divisor = 1;
    };
    std::string name;
    std::vector<Part> parts;
    double lower = -kInfinity, upper = kInfinity;  ///< m, of its length
    double stiffness = 0, damping = 0;             ///< N/m, N s/m
    std::optional<double> rest;                    ///< m: length without force; none: that of the start
    blueprint::TextPosition where;
};

/// Bodies that do not collide with one another.
struct ExcludedBodies
{
    std::string first, second;
    blueprint::TextPosition where;
};

/// Shapes that collide whatever else is said.
struct CollidingPair
{
    std::string first, second;
    std::optional<double> friction;  ///< of this pair
    blueprint::TextPosition where;
};

struct Robot
{
    std::string title;
    std::string step;  ///< s, as a text; "": pLab's default
    Vec3 gravity{0, 0, -9.81};
    bool base_collides = false;  ///< bodies that never move collide with the others
    SurfaceRule surface_rule = SurfaceRule::Gazebo;
    bool fixed_parents_collide = false;  ///< a body collides with the one that it hangs on if that never moves (MJCF)
    bool fixed_meshes_are_surfaces = true;  ///< meshes of bodies that never move collide as their triangles (not in MJCF)
    std::vector<RobotBody> bodies;          ///< parents come first
    std::vector<Coupling> couplings;
    std::vector<Cable> cables;
    std::vector<Actuator> actuators;
    std::vector<ExcludedBodies> exclusions;
    std::vector<CollidingPair> pairs;
};

}  // namespace plab::import
