/// A step that the springs and dampers of an imported scene bear.
///
/// pLab's managers, which advance what touches something, take forces at the beginning of a step (order 1): a damper c on an inertia J adds
/// energy with steps beyond 2 J/c, a spring k beyond 2 sqrt(J/k) (server/docs/reference.md, Constraint/TorsionSpring). Other programs take
/// joint damping implicitly, so their scenes may have longer steps.
#pragma once

#include "import/assembly.h"

namespace plab::import
{

/// s: the scene's own step (0: pLab's default) divided by the least whole number, at most 64, for which it stays below J/c and sqrt(J/k) of
/// each joint, actuators included. J is what a joint feels of the two bodies that it holds, and of its rotor, with all other joints free: a
/// lower bound. `why`: the joint that asks for the shortest step; null if the scene's own step suffices.
struct StepChoice
{
    double step = 0;
    const Joint* why = nullptr;
};
StepChoice choose_step(const Robot& robot, const Assembly& assembly);

}  // namespace plab::import
