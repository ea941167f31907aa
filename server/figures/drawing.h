/// A drawing: a list of lines, areas, markers and texts, written as SVG or rendered to PNG from the same list.
/// Points are in pixels from the upper left corner. Colours are roles, not numbers: SVG follows the reader's light or dark
/// theme. The series colours are those of Okabe and Ito (2008), which colour-blind readers can distinguish; shapes differ as
/// well.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plab/result.h"

namespace plab::figures
{

struct Spot
{
    double x = 0, y = 0;
};

struct Ink
{
    enum class Role : std::uint8_t
    {
        None,
        Text,
        Muted,
        Grid,
        Paper,
        Front,   ///< the Pareto front
        Shade,   ///< the unresolved region
        Series,  ///< `index`
        Exact,   ///< red, green, blue
    };
    Role role = Role::Text;
    int index = 0;
    std::uint8_t red = 0, green = 0, blue = 0;

    static Ink series(int i) { return {Role::Series, i % kSeries, 0, 0, 0}; }
    static Ink rgb(std::uint8_t r, std::uint8_t g, std::uint8_t b) { return {Role::Exact, 0, r, g, b}; }
    static constexpr int kSeries = 8;
};

enum class Anchor : std::uint8_t
{
    Start,
    Middle,
    End,
};

struct Pen
{
    Ink ink;
    double width = 1.5;
    bool dashed = false;
};

struct Words
{
    double size = 13;  ///< px
    Ink ink;
    Anchor anchor = Anchor::Start;
    bool bold = false;
    bool upright = false;  ///< rotated by 90 degrees, reading upwards
};

class Drawing
{
public:
    static constexpr int kMarkers = 6;

    Drawing(double width, double height, std::string title) : width_(width), height_(height), title_(std::move(title)) {}
    double width() const { return width_; }
    double height() const { return height_; }
    const std::string& title() const { return title_; }

    /// `hint` is shown when the pointer is over it.
    void line(std::vector<Spot> points, Pen pen, std::string hint = {});
    void area(std::vector<Spot> points, Ink fill, std::string hint = {});
    void box(Spot corner, double width, double height, Ink fill, std::string hint = {});
    void marker(Spot at, int shape, double size, Ink ink, bool filled, std::string hint = {});
    void words(Spot at, std::string text, Words how);

    /// An <svg> element. `standalone`: with an XML header and its own colours; otherwise the page must contain those of
    /// svg_style().
    std::string svg(bool standalone) const;
    /// White paper, `scale` pixels per px.
    Result<void> write_png(const std::string& path, double scale = 1.5) const;

private:
    enum class Kind : std::uint8_t
    {
        Line,
        Area,
        Dot,
        Words,
    };
    struct Item
    {
        Kind kind = Kind::Line;
        std::vector<Spot> points;
        Pen pen;
        Ink fill{Ink::Role::None, 0, 0, 0, 0};
        double radius = 0;
        std::string text, hint;
        Words how;
    };
    void svg_item(const Item& item, std::string& out) const;

    double width_, height_;
    std::string title_;
    std::vector<Item> items_;
};

/// CSS classes of all inks, for light and dark themes.
std::string svg_style();
/// Red, green, blue of an ink on white paper, 0..1.
struct Rgb
{
    double r = 0, g = 0, b = 0;
};
Rgb light_color(const Ink& ink);
/// Approximate width of a text, px.
double text_width(const std::string& text, double size);

/// Escapes & < > and quotes.
std::string escape_markup(const std::string& text);

}  // namespace plab::figures
