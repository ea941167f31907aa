/// How components refer to one another in a loaded scene: by small indices into the host's tables.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace plab
{

/// A row of a type's own table. A row never moves while its component exists.
using Row = std::uint32_t;
/// The rows that take part in a phase, in the order of their components' ids.
using Rows = std::span<const Row>;

inline constexpr std::uint32_t kNoIndex = 0xffffffffu;

/// The aspect under which a component is referred to; a role names the facets that it accepts.
enum class Facet : std::uint8_t
{
    Component,   ///< any component; index into the world's directory
    Body,        ///< pose and velocity in space; row of Bodies
    Shaft,       ///< one degree of freedom about an axle; row of Shafts
    Shape,       ///< geometry; row of Shapes
    Quantities,  ///< numbers that change at given rates; row of Quantities
};

/// A participant: a row of the host table that its facet names. Default: no component.
struct Ref
{
    Facet facet = Facet::Component;
    std::uint32_t index = kNoIndex;

    constexpr bool valid() const { return index != kNoIndex; }
    friend constexpr auto operator<=>(const Ref&, const Ref&) = default;
};

/// The participants of a role with several members, in the order of their components' ids.
using RefList = std::vector<Ref>;

}  // namespace plab
