/// A ladder: levels of detail of one family, from the cheapest to the most exact one.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/type_registry.h"
#include "simulation/requests/requests.h"
#include "world/world.h"

namespace plab::simulation
{

/// An algorithm, with the parameters in which it differs from what it takes over.
struct Level
{
    std::string type;
    std::vector<NamedValue> values;  ///< parsed
    std::string text;                ///< as people read it: "Manager/SoftStep substeps=4"
};

struct Ladder
{
    std::string family;  ///< "Manager"
    std::vector<Level> levels;
};

/// Reads "Manager/SoftStep substeps=2; Manager/SoftStep substeps=4; Manager/Direct", or the name of a family, whose ladder is then that of
/// model/ladders.h. Loads the types. Errors: unknown types or fields, values that the fields refuse, types of several families, fewer than
/// two levels.
Result<Ladder> read_ladder(std::string_view text, model::TypeSource& types);

/// The position in the ladder of what the component is now; -1: none of them.
std::int32_t level_of(const world::World& world, std::uint32_t component, const Ladder& ladder);

/// Whether an id matches one of the patterns in the text, which blanks separate. `*` stands for any text and `?` for any character.
bool matches_any(std::string_view patterns, std::string_view id);

}  // namespace plab::simulation
