#include "import/step_length.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "model/numbers.h"

namespace plab::import
{
namespace
{

constexpr double kDefaultStep = 1.0 / 240;  ///< of pLab
constexpr double kMostParts = 64;

/// Of a body about an axis of the world through `point`, or along it: kg m^2, kg. Infinite if it never moves.
double inertia_along(const PlacedBody& body, const PlacedJoint& joint)
{
    if (body.fixed) return kInfinity;
    if (joint.joint.kind == JointKind::Slide) return body.mass.mass;
    const Vec3 n = rotate_back(body.X_WB.q, joint.axis_W);
    const Vec3 arm = cross(rotate_back(body.X_WB.q, joint.anchor_W - body.X_WB.p) - body.mass.center, n);
    return dot(n, body.mass.inertia * n) + body.mass.mass * dot(arm, arm);
}

struct Stiffness
{
    double k = 0, c = 0;
};

}  // namespace

StepChoice choose_step(const Robot& robot, const Assembly& assembly)
{
    std::map<std::string, Stiffness> servos;
    for (const Actuator& a : robot.actuators)
    {
        Stiffness& s = servos[a.joint];
        s.k += std::fmax(0, -a.bias.y) * a.gear * a.gear, s.c += std::fmax(0, -a.bias.z) * a.gear * a.gear;
    }
    const auto own = model::parse_real(robot.step);
    StepChoice out{own ? *own : kDefaultStep, nullptr};
    double shortest = out.step;
    for (const PlacedBody& body : assembly.bodies)
        for (const PlacedJoint& joint : body.joints)
        {
            if (joint.joint.kind == JointKind::Ball) continue;
            Stiffness s{joint.joint.stiffness, joint.joint.damping};
            if (const auto servo = servos.find(joint.joint.name); servo != servos.end()) s.k += servo->second.k, s.c += servo->second.c;
            const double base = body.parent == kWorld ? kInfinity : inertia_along(assembly.bodies[body.parent], joint);
            const double J = 1 / (1 / inertia_along(body, joint) + 1 / base) + joint.joint.armature;
            const double bound = std::fmin(s.c > 0 ? J / s.c : kInfinity, s.k > 0 ? std::sqrt(J / s.k) : kInfinity);
            if (bound < shortest) shortest = bound, out.why = &joint.joint;
        }
    if (out.why) out.step /= std::fmin(kMostParts, std::ceil(out.step / shortest));
    return out;
}

}  // namespace plab::import
