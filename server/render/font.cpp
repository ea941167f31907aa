#include "font.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>

#include "font_strokes.h"

namespace plab::render
{
namespace
{

constexpr double kCapital = 14, kGap = 4.1;  ///< in the units of the strokes
constexpr double kPen = 2.05;                ///< width of a stroke in these units
constexpr double kSeam = 0.16;               ///< width of the outline, relative to the height of capitals

struct Point
{
    double x = 0, y = 0;
};
using Polyline = std::vector<Point>;

/// The numbers of a text such as "1,2.5,3".
std::vector<double> numbers_of(std::string_view text)
{
    std::vector<double> out;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at < end)
    {
        double value = 0;
        at = std::from_chars(at, end, value).ptr + 1;
        out.push_back(value);
    }
    return out;
}

void add_arc(Polyline& line, const std::vector<double>& arc)
{
    constexpr int kParts = 24;
    for (int i = 0; i <= kParts; ++i)
    {
        const double angle = (arc[4] + (arc[5] - arc[4]) * i / kParts) * std::numbers::pi / 180;
        line.push_back({arc[0] + arc[2] * std::cos(angle), arc[1] + arc[3] * std::sin(angle)});
    }
}

std::vector<Polyline> polylines_of(std::string_view path)
{
    std::vector<Polyline> out(1);
    while (!path.empty())
    {
        const std::string_view word = path.substr(0, path.find(' '));
        path.remove_prefix(std::min(path.size(), word.size() + 1));
        if (word == "/")
            out.emplace_back();
        else if (word.front() == '@')
            add_arc(out.back(), numbers_of(word.substr(1)));
        else if (const auto xy = numbers_of(word); xy.size() == 2)
            out.back().push_back({xy[0], xy[1]});
    }
    return out;
}

double distance_to_segment(const Point& p, const Point& a, const Point& b)
{
    const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
    const double along = squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0;
    return std::hypot(p.x - a.x - along * dx, p.y - a.y - along * dy);
}

double distance_to(const Point& p, const std::vector<Polyline>& lines)
{
    double least = 1e9;
    for (const Polyline& line : lines)
        for (std::size_t i = 0; i + 1 < line.size(); ++i) least = std::min(least, distance_to_segment(p, line[i], line[i + 1]));
    return least;
}

/// Coverage of a pixel at distance `away` from the path of a pen with this half width.
std::uint8_t coverage(double half_width, double away)
{
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(half_width - away + 0.5, 0.0, 1.0)));
}

Glyph rasterized(const Strokes& strokes, double capital)
{
    const double scale = capital / kCapital;
    const double pen = std::max(0.5 * kPen * scale, 0.75), seam = pen + std::max(1.3, kSeam * capital);
    Glyph out;
    out.advance = static_cast<int>(std::lround((strokes.width + kGap) * scale));
    if (strokes.path.empty()) return out;

    std::vector<Polyline> lines = polylines_of(strokes.path);
    Point low{1e9, 1e9}, high{-1e9, -1e9};
    for (Polyline& line : lines)
        for (Point& p : line)
        {
            // The middle of the pixel where the base line's strokes end: stems then fall on whole pixels more often.
            p = {p.x * scale + 0.5 * kGap * scale, p.y * scale + 0.5};
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
    out.left = static_cast<int>(std::floor(low.x - seam - 1)), out.top = static_cast<int>(std::ceil(high.y + seam + 1));
    out.width = static_cast<int>(std::ceil(high.x + seam + 1)) - out.left;
    out.height = out.top - static_cast<int>(std::floor(low.y - seam - 1));
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
        {
            const double away = distance_to({out.left + x + 0.5, out.top - y - 0.5}, lines);
            out.ink.push_back(coverage(pen, away));
            out.seam.push_back(coverage(seam, away));
        }
    return out;
}

}  // namespace

Font::Font(double capital)
{
    static_assert(std::size(kStrokes) == std::tuple_size_v<decltype(glyphs_)>);
    for (std::size_t i = 0; i < glyphs_.size(); ++i) glyphs_[i] = rasterized(kStrokes[i], capital);
}

const Glyph& Font::glyph(char32_t letter) const { return letter >= kFirst && letter <= kLast ? glyphs_[letter - kFirst] : glyphs_.back(); }

char32_t next_letter(std::string_view& text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc0 ? 2 : 1;
    char32_t out = length == 1 ? lead : lead & (0x7f >> length);
    for (std::size_t i = 1; i < length; ++i)
    {
        if (i >= text.size() || (byte(i) & 0xc0) != 0x80)
        {
            text.remove_prefix(1);
            return lead;
        }
        out = (out << 6) | (byte(i) & 0x3f);
    }
    text.remove_prefix(length);
    return out;
}

}  // namespace plab::render
