/// Tables of what the algorithms of the ladder of solvers reach on a problem, and how a row of them is checked.
///
/// The bound is twice what is reached. Where the order says how the error comes about (order > 0), less than half of what the table
/// says fails as well: a algorithm that has become better shall not go unnoticed. Where error control, an iteration's end or rounding
/// decides (order 0) there is no least error.
#pragma once

#include "reference/motion.h"

namespace plab::test
{

struct AlgorithmRow
{
    SolverAlgorithm algorithm;
    int steps = 0;       ///< in a second or in a period, as the problem counts them
    double reached = 0;  ///< the error at that step
    double order = 0;    ///< observed between that step and half of it; 0: none
};

inline std::string name_of(const SolverAlgorithm& algorithm)
{
    return algorithm.type + (algorithm.attributes.empty() ? "" : " " + algorithm.attributes);
}

/// `error`: double(const SolverAlgorithm&, int steps).
template <class Error>
void check_algorithm(const AlgorithmRow& row, const Error& error)
{
    const double found = error(row.algorithm, row.steps);
    const std::string name = name_of(row.algorithm);
    CAPTURE(name);
    CAPTURE(row.steps);
    MESSAGE(name << " 1/" << row.steps << ": " << found);
    CHECK(found < 2 * row.reached);
    if (row.order == 0) return;
    CHECK(found > 0.5 * row.reached);
    const double order = observed_order(found, error(row.algorithm, 2 * row.steps));
    MESSAGE(name << " order " << order);
    CHECK(order == doctest::Approx(row.order).epsilon(0.1));
}

/// `algorithm` does what `other` does, to the last bit: what falls back to another method, or chooses it.
template <class Error>
void check_same(const SolverAlgorithm& algorithm, const SolverAlgorithm& other, int steps, const Error& error)
{
    const std::string name = name_of(algorithm), same_as = name_of(other);
    CAPTURE(name);
    CAPTURE(same_as);
    CHECK(error(algorithm, steps) == error(other, steps));
}

/// Every solver, for problems that ask the same of all of them.
inline const SolverAlgorithm kEverySolver[] = {
    {"SemiImplicitEuler"}, {"StoermerVerlet"}, {"RungeKutta4"},      {"RotationSplitting", "order=\"2\""},
    {"RotationSplitting"}, {"Exact"},          {"ImplicitMidpoint"}, {"Exponential"},
    {"DormandPrince54"},   {"Radau5"},         {"Automatic"},
};

}  // namespace plab::test
