/// The acceleration of Field/Gravity, as it is by default, and a blueprint of one that acts on all bodies.
#pragma once

namespace plab::test
{

inline constexpr double kG = 9.81;  // m/s^2
inline const char* const kGravity = "<component id=\"g\" type=\"Field/Gravity\" between=\"*\"/>";

}  // namespace plab::test
