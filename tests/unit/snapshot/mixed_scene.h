/// The scene of the golden snapshots.
#pragma once

#include <string>

#include "support/ground.h"

namespace plab::test
{

/// A small scene with one of each: a ball that bounces, one on a spring, a train of shafts, numbers, a script.
inline const std::string kMixed =
    std::string(kGround) +
    "<component id='ball' type='Shape/Sphere' radius='0.1'/>"
    "<component id='odd &quot;name&quot; &amp; &#228;&#8364;' type='State/RigidBody' mass='1' shape='ball' position='0 0 0.15'/>"
    "<component id='soft' type='State/RigidBody' mass='1' shape='ball' position='1 0 0.1'/>"
    "<component id='weight' type='Field/Gravity' between='*'/>"
    "<component id='contact' type='CDetection/ODE' between='odd &quot;name&quot; &amp; &#228;&#8364;' against='ground'"
    " resolution='Resolution/LocalBisection' response='Response/Impulse' response.restitution='0.5'/>"
    "<component id='spring' type='CDetection/ODE' between='sof?' against='ground' resolution='Resolution/None' "
    "response='Response/Penalty' response.restitution='1'/>"
    "<component id='s1' type='State/Shaft' inertia='1' angular_velocity='3'/><component id='s2' type='State/Shaft' inertia='2'/>"
    "<component id='mesh' type='Constraint/AngularVelocity/Graph' driver='s1' driven='s2' velocity_factor='-1/3'/>"
    "<component id='heat' type='State/Quantities' values='300 20'/>"
    "<component id='watch' type='Script/Lua' driven='soft'><param name='state'><entry name='n'>0</entry><entry name='w'>'a "
    "b'</entry></param>"
    "<param name='code'>function drive(step) state.n = state.n + math.random() end</param></component>";

}  // namespace plab::test
