/// A scene of the comparison as plain data, from which every engine's adapter builds its own world.
#pragma once

#include <string>
#include <vector>

#include "plab/vector.h"

namespace plab::peers
{

/// Length of a step as a fraction, so that pLab's exact time and the peers' doubles agree.
struct Step
{
    int num = 1;  ///< s
    int den = 60;

    double seconds() const { return static_cast<double>(num) / den; }
    std::string text() const { return den == 1 ? std::to_string(num) : std::to_string(num) + "/" + std::to_string(den); }
};

enum class Form
{
    Point,   ///< no shape: collides with nothing
    Sphere,  ///< radius half.x
    Box,     ///< half extents
};

struct BodySpec
{
    Form form = Form::Point;
    Vec3 half;              ///< m
    double mass = 1;        ///< kg
    Vec3 inertia;           ///< principal, about the centre of mass, kg m^2
    Vec3 position;          ///< of the centre of mass, m
    Quat orientation;       ///< q_WB
    Vec3 velocity;          ///< m/s
    Vec3 angular_velocity;  ///< in W, rad/s
};

BodySpec sphere(double radius, double mass, const Vec3& position);
BodySpec box(const Vec3& half, double mass, const Vec3& position);

enum class JointKind
{
    Hinge,
    Ball,
    Slider,
};

inline constexpr int kWorld = -1;

/// A joint between two bodies, the first of which may be the world. A slider may carry a spring along its axis:
/// force on the child = -stiffness (s - rest) - damping s', with s the child's displacement along the axis since the start.
struct JointSpec
{
    JointKind kind = JointKind::Hinge;
    int parent = kWorld;
    int child = 0;
    Vec3 anchor;           ///< in W at the start, m
    Vec3 axis{0, 1, 0};    ///< in W at the start
    double stiffness = 0;  ///< N/m
    double damping = 0;    ///< N s/m
    double rest = 0;       ///< m
};

/// The rotation of one hinge's child is `ratio` times that of another's. Both hinges are on the world.
struct GearSpec
{
    int first = 0, second = 1;  ///< joints
    double ratio = 1;
};

/// A constant torque about a hinge's axis.
struct LoadSpec
{
    int joint = 0;
    double torque = 0;  ///< N m, on the child
};

struct Scene
{
    std::string name;
    double duration = 1;        ///< s
    Vec3 gravity{0, 0, -9.81};  ///< m/s^2
    bool ground = false;        ///< half-space below z = 0
    double container = 0;       ///< m: half width of a square container about the z axis; 0: none
    double friction = 0;
    double restitution = 0;
    std::vector<BodySpec> bodies;
    std::vector<JointSpec> joints;
    std::vector<GearSpec> gears;
    std::vector<LoadSpec> loads;
};

}  // namespace plab::peers
