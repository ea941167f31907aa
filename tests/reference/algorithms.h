/// Tables of the accuracy that the solver algorithms achieve on a problem, and the check of one row.
///
/// The bound is twice the achieved error. Where the order determines the error (order > 0), an error below half of the tabulated
/// one fails as well, so that an improved algorithm does not go unnoticed. Where error control, the end of an iteration or
/// rounding determines the error (order 0), there is no lower bound.
#pragma once

#include "reference/motion.h"

namespace plab::test
{

struct AlgorithmRow
{
    SolverAlgorithm algorithm;
    int steps = 0;       ///< steps per second or per period, as the problem defines
    double reached = 0;  ///< the error with that many steps
    double order = 0;    ///< observed between that step length and half of it; 0: not checked
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

/// `algorithm` gives the same result as `other` to the last bit: it falls back to it, or chooses it.
template <class Error>
void check_same(const SolverAlgorithm& algorithm, const SolverAlgorithm& other, int steps, const Error& error)
{
    const std::string name = name_of(algorithm), same_as = name_of(other);
    CAPTURE(name);
    CAPTURE(same_as);
    CHECK(error(algorithm, steps) == error(other, steps));
}

/// All solvers, for problems that set the same requirement for each.
inline const SolverAlgorithm kEverySolver[] = {
    {"SemiImplicitEuler"}, {"StoermerVerlet"}, {"RungeKutta4"},      {"RotationSplitting", "order=\"2\""},
    {"RotationSplitting"}, {"Exact"},          {"ImplicitMidpoint"}, {"Exponential"},
    {"DormandPrince54"},   {"Radau5"},         {"Automatic"},
};

}  // namespace plab::test
