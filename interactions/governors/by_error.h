/// A governor that keeps an error below a bound, at the least cost.
#pragma once

#include "watch.h"

namespace plab::governors
{

/// Governor/Error.
struct ErrorRows
{
    WatchRows watch;
    Column<double> bound;
    Column<std::string> unit;  ///< of the bound: m, rad, W, pixels
    Column<double> interval, target;
    Column<std::int64_t> looks;
    Column<double> share;                 ///< trial steps for each step that watched components make; 0: no limit
    Column<double> look_ahead, margin;    ///< s, rad: of pixels, as those of Governor/Visibility
    Column<Entries> next;                 ///< s: when a component is measured again, by id
    Column<double> safety;                ///< factor
    Column<double> patience;              ///< factor of `every`: what is far below the bound is measured again after at most this
    Column<std::int64_t> judged, held;    ///< promises: see keep_error()
    Column<double> allowance;             ///< trial steps that may be made yet
    Column<double> enough;                ///< for the host: see LevelBook (0: no limit)
    Column<Reals> sampled, sampled_held;  ///< by level: components that were sampled, and those that kept the bound; older ones fade
    Column<double> confidence, worst;
    Column<std::int64_t> measured, unknown;

    void describe(Schema& schema);
};

/// Gives each component the cheapest level whose error within `interval`, measured by trial steps against the next finer level and
/// multiplied by `safety`, is below the bound.
///
/// Keeping a level is a promise: its error will still be below the bound when it is measured again. The next measurement judges it. With
/// the share c of promises that shall hold (`target`), a promise that held multiplies the safety factor by exp(-(1 - c) g), one that did
/// not by exp(c g): the factor is at rest where the share is c. Source: Robbins and Monro, A stochastic approximation method, Ann. Math.
/// Stat. 22 (1951): the estimate of a quantile.
///
/// With a limit of trial steps (`share`) only a sample is measured. All others get the cheapest level with which the sample keeps the bound
/// in a share of `target` at least, by the rule of succession (k + 1) / (n + 2). What is measured gets at least that level, and judges it.
void keep_error(const StepContext& context, Row row, ErrorRows& governors, LevelControl& control);

}  // namespace plab::governors
