/// A ball that falls through air onto the floor: `ball`, `ground`, `contact`, `wind`.
#pragma once

namespace plab::test
{

inline constexpr const char* kBall = R"(
  <component id="earth" type="Field/Gravity" between="ball"/>
  <component id="floor" type="Shape/Plane"/><component id="ground" type="State/Static" shape="floor"/>
  <component id="round" type="Shape/Sphere" radius="0.1"/>
  <component id="ball" type="State/RigidBody" shape="round" mass="1" position="0 0 0.5" linear_velocity="0.3 0 0"/>
  <component id="contact" type="CDetection/ODE" between="*"/>
  <component id="wind" type="Field/Drag" between="ball" linear="0.01"/>)";

}  // namespace plab::test
