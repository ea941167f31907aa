/// Loops of couplings that cannot turn.
#pragma once

#include <map>
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

/// Couplings among objects, as a union of trees in which each object has its ratio to the root: whether two are coupled, and how, is told
/// in nearly constant time. Source: R. E. Tarjan, Efficiency of a good but not linear set union algorithm, J. ACM 22 (1975).
class Couplings
{
public:
    void add(Coupling coupling);
    /// Turns of b per turn of a; empty: nothing couples them.
    std::optional<double> ratio(Ref a, Ref b);
    /// The same with the couplings on the way, by the fewest of them.
    std::optional<Path> path(Ref from, Ref to) const;

private:
    struct Root
    {
        Ref object;
        double ratio = 1;  ///< turns per turn of the root
    };
    Root root_of(Ref object);

    std::vector<Coupling> all_;
    std::map<Ref, Root> above_;
    std::map<Ref, std::vector<std::size_t>> at_;  ///< couplings of each object
};

/// Whether both ratios can be true at once, to rounding.
bool agree(double one, double other);

}  // namespace plab::rules
