/// Axes: mapping of values to positions, ticks, grid, labels.
#pragma once

#include "figures/drawing.h"

namespace plab::figures
{

struct Scale
{
    enum class Kind : std::uint8_t
    {
        Linear,
        Log,
        SymLog,  ///< linear within +-threshold, logarithmic beyond
    };
    Kind kind = Kind::Linear;
    double low = 0, high = 1;
    double threshold = 1;

    /// 0 at low, 1 at high.
    double at(double value) const;

    /// Encloses the values, with a margin; those that are not finite (or, on log axes, not positive) do not count.
    static Scale around(Kind kind, const std::vector<double>& values);
};

struct Mark
{
    double value = 0;
    std::string label;  ///< empty: a minor one
};
std::vector<Mark> marks_of(const Scale& scale, int most = 8);

/// Places labels only where there is no other label yet.
class Labels
{
public:
    static constexpr double kSize = 10.5;

    /// Marks a place as occupied, by this much in all directions.
    void occupy(Spot at, double reach) { taken_.push_back({at.x - reach, at.y - reach, at.x + reach, at.y + reach}); }
    void occupy(double left, double top, double right, double bottom) { taken_.push_back({left, top, right, bottom}); }
    /// Places the text at the first free corner of `at`; not at all if there is none, or if the same text is nearby.
    void add(Drawing& drawing, Spot at, const std::string& text, double size = kSize, Ink ink = {Ink::Role::Muted, 0, 0, 0, 0},
             bool bold = false);

private:
    struct Area
    {
        double left, top, right, bottom;
    };
    std::vector<Area> taken_;
    std::vector<std::pair<Spot, std::string>> words_;
};

/// The area of the data.
struct Panel
{
    double left = 0, top = 0, width = 1, height = 1;  ///< px
    Scale x, y;
    std::vector<Mark> x_marks;  ///< instead of the scale's own ticks, if there are any

    Spot at(double vx, double vy) const { return {left + width * x.at(vx), top + height * (1 - y.at(vy))}; }
    double right() const { return left + width; }
    double bottom() const { return top + height; }
};

/// Grid, frame, tick labels and the names of both axes.
void draw_panel(Drawing& drawing, const Panel& panel, const std::string& x_name, const std::string& y_name);

/// "10⁻⁶", "0.002": short numbers for ticks.
std::string power_of_ten(int exponent);
/// "3.2e-07" in readable form: 3.2·10⁻⁷, or as a plain number if that is short.
std::string short_number(double value);

}  // namespace plab::figures
