/// Figures of interactions in words: cost with the components that share it, error with its unit.
#pragma once

#include <string>

#include "link/catalogue.h"

namespace plab::cli
{

/// "4.1 us", "418 ns (1/12)" if twelve components share the cost of their type, "-" before the first step.
std::string cost_text(const link::InteractionMetrics& m);
/// "4.1 us, half of the last 64 steps between 3.9 us and 4.4 us"
std::string cost_in_words(const link::InteractionMetrics& m);
/// "-" if none is known. Servers that do not explain their errors give a plain number.
std::string error_text(const link::InteractionMetrics& m);
std::string error_unit(const link::InteractionMetrics& m);
/// The meaning of the error, or why there is none.
std::string error_meaning(const link::InteractionMetrics& m);
/// What else a user should know of a component of this type: "quarantined", what it does itself, or which algorithm works in its place.
std::string note_text(const std::string& type, const link::InteractionMetrics& m);
/// In a word: what a server is doing, or how it handles steps that take too long.
std::string state_text(const link::ServerInfo& s);

}  // namespace plab::cli
