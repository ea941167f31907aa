/// Curves over time: one panel per unit below one another, a legend beside each, moments marked across all of them.
#pragma once

#include <utility>

#include "figures/axes.h"

namespace plab::figures
{

/// Points by time. One whose value is no number breaks the line.
struct Curve
{
    std::string name;
    std::string unit;
    std::vector<std::pair<double, double>> points;
};

/// Something that happened at a time.
struct Moment
{
    enum class Kind : std::uint8_t
    {
        Change,  ///< a dashed line, its words at the top
        Break,   ///< a grey line, its words at the top: what is left of it does not go on to its right
        Notice,  ///< a small mark at the foot
        Alarm,   ///< the same, in another colour
    };
    double at = 0;
    Kind kind = Kind::Notice;
    std::string words;  ///< of notices and alarms only shown as a hint
};

struct Chart
{
    std::string title, subtitle;
    std::string x_name = "time, s";
    Scale::Kind kind = Scale::Kind::Linear;
    double least = 0;           ///< of SymLog: what is smaller is drawn linearly
    std::vector<Curve> curves;  ///< panels in the order in which their units come first
    std::vector<Moment> moments;
};

/// Curves that a panel has room for; what is beyond is named in the legend only, as a number.
inline constexpr std::size_t kMostCurves = 16;

Drawing draw(const Chart& chart);

/// "run.svg" or "run.png"; an error for anything else.
Result<void> write_picture(const Drawing& drawing, const std::string& path);

}  // namespace plab::figures
