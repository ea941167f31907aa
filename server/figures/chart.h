/// Curves over time: one panel per unit, one below the other, with a legend beside each, and marked moments across all panels.
#pragma once

#include <optional>
#include <utility>

#include "figures/axes.h"

namespace plab::figures
{

/// Points by time. A point whose value is NaN interrupts the line.
struct Curve
{
    std::string name;
    std::string unit;
    std::vector<std::pair<double, double>> points;
};

/// An event at a time.
struct Moment
{
    enum class Kind : std::uint8_t
    {
        Change,  ///< a dashed line with its text at the top
        Break,   ///< a grey line with its text at the top: curves on its left do not continue to its right
        Notice,  ///< a small mark at the bottom
        Alarm,   ///< the same, in another colour
    };
    double at = 0;
    Kind kind = Kind::Notice;
    std::string words;  ///< the text of notices and alarms appears only as a hint
};

struct Chart
{
    std::string title, subtitle;
    std::string x_name = "time, s";
    Scale::Kind kind = Scale::Kind::Linear;
    double least = 0;           ///< of SymLog: smaller values are drawn linearly
    std::vector<Curve> curves;  ///< panels are in the order in which their units first occur
    std::vector<Moment> moments;
    /// From where to where the time axis goes, so that charts below one another have the same; otherwise as far as there are points.
    std::optional<std::pair<double, double>> times;
};

/// Maximum number of curves in a panel; the legend states the number of the others.
inline constexpr std::size_t kMostCurves = 16;

/// Curves of one unit that are equal, point by point, are drawn as one with all their names. Panels are equally wide in all charts.
Drawing draw(const Chart& chart);

/// "run.svg" or "run.png"; an error for anything else.
Result<void> write_picture(const Drawing& drawing, const std::string& path);

}  // namespace plab::figures
