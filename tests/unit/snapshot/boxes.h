/// Boxes held by friction and a bouncing ball, and a run in which requests change them.
#pragma once

#include "support/ground.h"
#include "twin.h"

namespace plab::test
{

inline const std::string kBoxes =
    std::string(kGround) +
    "<component id='box' type='Shape/Box' half_extents='0.2 0.2 0.1'/><component id='ball' type='Shape/Sphere' radius='0.1'/>"
    "<component id='low' type='State/RigidBody' mass='2' shape='box' position='0 0 0.1'/>"
    "<component id='high' type='State/RigidBody' mass='1' shape='box' position='0.03 0.02 0.3'/>"
    "<component id='bouncing' type='State/RigidBody' mass='1' shape='ball' position='1 0 0.6' angular_velocity='0 3 1'/>"
    "<component id='weight' type='Field/Gravity' between='*' acceleration='0.6 0.3 -9.6'/>"
    "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/LocalBisection' response='Response/Impulse'"
    " response.friction='0.6' response.restitution='0.4'/>";

/// Requests, by the step before which they take effect.
using Change = std::pair<int, std::vector<simulation::Operation>>;

/// A trajectory of 130 steps in which these changes are made.
inline std::string follow_changes(const std::string& body, const std::vector<Change>& changes, Plan plan = {})
{
    plan.steps = 130;
    plan.meddle = [&](simulation::Simulation& s, int step)
    {
        for (const auto& [at, operations] : changes)
            if (at == step) ask(s, operations);
    };
    return follow(scene_of(body), plan);
}

inline simulation::SwapOperation swap_of(const std::string& id, const std::string& type) { return {id, type, {}}; }

}  // namespace plab::test
