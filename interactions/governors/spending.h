/// Where processor time removes most error: one level for each component, within a sum of costs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace plab::governors
{

/// A component that gets a level.
struct Candidate
{
    std::int32_t least = 0, present = 0;  ///< levels: the cheapest one that it may get; the one that it has
    double weight = 1;                    ///< its part of the cost of a level
    double scale = 1;                     ///< pixels per metre: by how much its error counts
    std::span<const double> errors;       ///< m, of each level
};

/// s, what a step costs with all candidates at a level: as expected, and as it may be at worst where hardly anything is known (otherwise
/// the same).
struct LevelPrices
{
    std::vector<double> expected, worst;
};

/// Starts with the cheapest level for each candidate, and goes on with the step from one level to a finer one that removes the most error
/// (pixels) for a second, until no further step fits into `seconds`. A level is left out where the way past it is steeper: it costs about
/// as much as a finer one and errs much more. Errors up to `tolerance` (pixels) are not worth removing. A level that a candidate has
/// already is kept unless another step is worth twice as much. Of the levels of which hardly anything is known, each is tried by one
/// candidate first.
///
/// Source: Sinha and Zoltners, The multiple-choice knapsack problem, Operations Research 27(3), 1979 (the greedy solution of its linear
/// relaxation, which misses the best one by at most one step).
std::vector<std::int32_t> choose_levels(std::span<const Candidate> candidates, const LevelPrices& prices, double seconds, double tolerance);

}  // namespace plab::governors
