/// The pictures of a study.
#pragma once

#include <optional>

#include "figures/drawing.h"
#include "study/study.h"

namespace plab::study::plot
{

using figures::Drawing;

/// Error against CPU time, log-log: a marker per combination, a line per algorithm, the Pareto front, and the region below the
/// resolution of the reference.
Drawing work_precision(const StudyResult& result);
/// Error against step length, log-log, with slope triangles. None if only one step length was studied.
std::optional<Drawing> convergence(const StudyResult& result);
/// Unexplained energy, over time; the vertical axis is symlog.
std::optional<Drawing> energy(const StudyResult& result);
/// Digits of the worst quantity by algorithm and step length; with one step length, by algorithm and quantity.
Drawing digit_map(const StudyResult& result);

/// A named picture of a study, ready to be written as FILE.svg and FILE.png.
struct Picture
{
    std::string file, caption;
    Drawing drawing;
};
std::vector<Picture> pictures_of(const StudyResult& result);

/// A table of digits: rows by columns; NaN: no value, with a text that gives the reason.
struct Cell
{
    double digits = 0;
    std::string word, hint;
};
Drawing heat_map(const std::string& title, const std::vector<std::string>& rows, const std::vector<std::string>& columns,
                 const std::vector<std::vector<Cell>>& cells);

/// Performance profile of Dolan and More: share of problems solved within tau times the best. `cost`: problem by solver,
/// infinite where it failed.
Drawing performance_profile(const std::string& title, const std::vector<std::string>& solvers,
                            const std::vector<std::vector<double>>& cost);

/// Algorithms in the order of their first point.
std::vector<std::string> algorithms_of(const StudyResult& result);
/// Relative errors up to here are round-off.
inline constexpr double kRoundOff = 1e-13;
/// Indices of the points that no other point beats in both error and cost, by cost; errors below round-off or the reference's
/// uncertainty count as equal.
std::vector<std::size_t> pareto_front(const StudyResult& result);

/// An exact zero has no position on a logarithmic axis; it is drawn at this value.
inline constexpr double kLeastError = 1e-17;

}  // namespace plab::study::plot
