/// Units of declared fields. Internally all values are in SI units and radians; a unit states the dimension that a text must have.
#pragma once

#include <array>
#include <string_view>

namespace plab
{

/// Exponents of metre, kilogram, second and radian. Radians are a dimension of their own, so "30 deg" is not accepted for a plain number.
struct Dimension
{
    std::array<signed char, 4> power{0, 0, 0, 0};
    friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};

struct Unit
{
    std::string_view symbol;  ///< as printed in listings and the reference manual; empty for a pure number
    Dimension dimension;
    friend constexpr bool operator==(const Unit& a, const Unit& b) { return a.dimension == b.dimension; }
};

namespace unit
{
inline constexpr Unit one{"", {{0, 0, 0, 0}}};
inline constexpr Unit metre{"m", {{1, 0, 0, 0}}};
inline constexpr Unit kilogram{"kg", {{0, 1, 0, 0}}};
inline constexpr Unit second{"s", {{0, 0, 1, 0}}};
inline constexpr Unit radian{"rad", {{0, 0, 0, 1}}};
inline constexpr Unit metre_per_second{"m/s", {{1, 0, -1, 0}}};
inline constexpr Unit metre_per_second2{"m/s^2", {{1, 0, -2, 0}}};
inline constexpr Unit radian_per_second{"rad/s", {{0, 0, -1, 1}}};
inline constexpr Unit newton{"N", {{1, 1, -2, 0}}};
inline constexpr Unit newton_second{"N s", {{1, 1, -1, 0}}};
inline constexpr Unit newton_metre{"N m", {{2, 1, -2, 0}}};
inline constexpr Unit newton_metre_second{"N m s", {{2, 1, -1, 0}}};
inline constexpr Unit joule{"J", {{2, 1, -2, 0}}};
inline constexpr Unit kilogram_metre2{"kg m^2", {{2, 1, 0, 0}}};
inline constexpr Unit kilogram_per_metre3{"kg/m^3", {{-3, 1, 0, 0}}};
inline constexpr Unit kilogram_per_second{"kg/s", {{0, 1, -1, 0}}};
inline constexpr Unit kilogram_per_metre{"kg/m", {{-1, 1, 0, 0}}};
inline constexpr Unit newton_metre_second_per_radian{"N m s/rad", {{2, 1, -1, -1}}};
inline constexpr Unit newton_metre_second2_per_radian2{"N m s^2/rad^2", {{2, 1, 0, -2}}};
inline constexpr Unit kilogram_metre_per_radian2{"N s^2/rad^2", {{1, 1, 0, -2}}};
}  // namespace unit

}  // namespace plab
