/// Loops of couplings that cannot turn.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plab/ref.h"

namespace plab::rules
{

/// b makes `ratio` turns per turn of a.
struct Coupling
{
    Ref a, b;
    double ratio = 1;
    std::string id;
};

/// What couples two objects already.
struct Path
{
    double ratio = 1;  ///< turns of the second one per turn of the first one
    std::string ids;   ///< of the couplings on the way
};
/// By the fewest couplings; empty: nothing does.
std::optional<Path> find_path(const std::vector<Coupling>& couplings, Ref from, Ref to);

/// Whether both ratios can be true at once, to rounding.
bool agree(double one, double other);

}  // namespace plab::rules
