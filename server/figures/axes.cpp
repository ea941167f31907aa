#include "figures/axes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plab::figures
{
namespace
{

double symlog(double v, double threshold)
{
    const double a = std::fabs(v) / threshold;
    return (v < 0 ? -1 : 1) * (a <= 1 ? a : 1 + std::log10(a));
}

std::string plain(double v)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", std::fabs(v) < 1e-300 ? 0.0 : v);
    return text;
}

std::vector<Mark> linear_ticks(const Scale& s, int most)
{
    const double span = s.high - s.low, raw = span / most, power = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10 * power;
    for (const double m : {1.0, 2.0, 5.0})
        if (m * power >= raw) step = std::min(step, m * power);
    std::vector<Mark> out;
    for (double n = std::ceil(s.low / step - 1e-9); n * step <= s.high + 1e-9 * span; ++n) out.push_back({n * step, plain(n * step)});
    return out;
}

std::vector<Mark> log_ticks(const Scale& s, int most)
{
    const int first = static_cast<int>(std::ceil(std::log10(s.low) - 1e-9)), last = static_cast<int>(std::floor(std::log10(s.high) + 1e-9));
    const int stride = std::max(1, (last - first + most) / most);
    std::vector<Mark> out;
    for (int e = first - 1; e <= last; ++e)
    {
        if (e >= first) out.push_back({std::pow(10.0, e), (e - first) % stride == 0 ? power_of_ten(e) : ""});
        for (int m = 2; m < 10 && last - first <= 3; ++m)
            if (const double v = m * std::pow(10.0, e); v >= s.low && v <= s.high)
                out.push_back({v, last - first < 2 && (m == 2 || m == 5) ? short_number(v) : ""});
    }
    return out;
}

std::vector<Mark> symlog_ticks(const Scale& s, int most)
{
    const double largest = std::max(std::fabs(s.low), std::fabs(s.high));
    const int first = static_cast<int>(std::ceil(std::log10(s.threshold) - 1e-9)),
              last = static_cast<int>(std::floor(std::log10(largest) + 1e-9));
    const int stride = std::max(1, (2 * (last - first + 1) + most) / most);
    std::vector<Mark> out{{0, "0"}};
    for (int e = first; e <= last; e += stride)
        for (const double sign : {-1.0, 1.0})
            if (const double v = sign * std::pow(10.0, e); v >= s.low && v <= s.high)
                out.push_back({v, (sign < 0 ? "−" : "") + power_of_ten(e)});
    return out;
}

}  // namespace

double Scale::at(double value) const
{
    if (kind == Kind::Log) return (std::log10(value) - std::log10(low)) / (std::log10(high) - std::log10(low));
    if (kind == Kind::SymLog)
    {
        const double a = symlog(low, threshold), b = symlog(high, threshold);
        return (symlog(value, threshold) - a) / (b - a);
    }
    return (value - low) / (high - low);
}

Scale Scale::around(Kind kind, const std::vector<double>& values)
{
    Scale out;
    out.kind = kind;
    double low = std::numeric_limits<double>::infinity(), high = -low, smallest = low;
    for (const double v : values)
    {
        if (!std::isfinite(v) || (kind == Kind::Log && !(v > 0))) continue;
        low = std::min(low, v), high = std::max(high, v);
        if (v != 0) smallest = std::min(smallest, std::fabs(v));
    }
    if (low > high) low = kind == Kind::Log ? 0.1 : 0, high = 1;
    if (kind == Kind::Log)
    {
        const double room = std::pow(10.0, std::max(0.08 * std::log10(high / low), 0.15));
        out.low = low / room, out.high = high * room;
        return out;
    }
    if (kind == Kind::SymLog)
    {
        const double largest = std::max({std::fabs(low), std::fabs(high), 1e-300});
        // At most twelve decades: smaller values are negligible beside the rest.
        out.threshold = std::max(std::isfinite(smallest) ? std::pow(10.0, std::floor(std::log10(smallest))) : largest, largest * 1e-12);
        out.low = low < 0 ? low * 2 : 0, out.high = high > 0 ? high * 2 : 0;
        if (out.low == out.high) out.high = 1;
        return out;
    }
    const double room = high > low ? 0.04 * (high - low) : std::max(1.0, std::fabs(high)) * 0.5;
    out.low = low - room, out.high = high + room;
    return out;
}

std::vector<Mark> marks_of(const Scale& scale, int most)
{
    if (scale.kind == Scale::Kind::Log) return log_ticks(scale, most);
    return scale.kind == Scale::Kind::SymLog ? symlog_ticks(scale, most) : linear_ticks(scale, most);
}

void draw_panel(Drawing& d, const Panel& p, const std::string& x_name, const std::string& y_name)
{
    const Ink grid{Ink::Role::Grid, 0, 0, 0, 0}, muted{Ink::Role::Muted, 0, 0, 0, 0};
    for (const Mark& t : p.x_marks.empty() ? marks_of(p.x) : p.x_marks)
    {
        const double x = p.at(t.value, p.y.low).x;
        if (x < p.left - 0.5 || x > p.right() + 0.5) continue;
        d.line({{x, p.top}, {x, p.bottom()}}, {grid, t.label.empty() ? 0.5 : 1.0, false});
        if (!t.label.empty()) d.words({x, p.bottom() + 18}, t.label, {12, muted, Anchor::Middle, false, false});
    }
    for (const Mark& t : marks_of(p.y))
    {
        const double y = p.at(p.x.low, t.value).y;
        if (y < p.top - 0.5 || y > p.bottom() + 0.5) continue;
        d.line({{p.left, y}, {p.right(), y}}, {grid, t.label.empty() ? 0.5 : 1.0, false});
        if (!t.label.empty()) d.words({p.left - 8, y + 4}, t.label, {12, muted, Anchor::End, false, false});
    }
    d.line({{p.left, p.top}, {p.left, p.bottom()}, {p.right(), p.bottom()}}, {muted, 1.2, false});
    d.words({p.left + p.width / 2, p.bottom() + 40}, x_name, {13, {}, Anchor::Middle, false, false});
    d.words({p.left - 58, p.top + p.height / 2}, y_name, {13, {}, Anchor::Middle, false, true});
}

void Labels::add(Drawing& d, Spot at, const std::string& text, double size, Ink ink, bool bold)
{
    constexpr double kNear = 45;
    for (const auto& [spot, words] : words_)
        if (words == text && std::hypot(spot.x - at.x, spot.y - at.y) < kNear) return;
    const double width = text_width(text, size);
    const double right = at.x + 8, left = at.x - 8 - width, up = at.y - 7, down = at.y + 7 + 0.75 * size;
    for (const Spot s : {Spot{right, up}, Spot{right, down}, Spot{left, down}, Spot{left, up}})
    {
        const Area area{s.x, s.y - 0.8 * size, s.x + width, s.y + 0.2 * size};
        const bool free = std::none_of(
            taken_.begin(), taken_.end(),
            [&](const Area& t) { return area.left < t.right && t.left < area.right && area.top < t.bottom && t.top < area.bottom; });
        if (!free) continue;
        taken_.push_back(area), words_.emplace_back(at, text);
        d.words(s, text, {size, ink, Anchor::Start, bold, false});
        return;
    }
}

std::string power_of_ten(int exponent)
{
    constexpr const char* raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    if (exponent >= -2 && exponent <= 3) return plain(std::pow(10.0, exponent));
    std::string out = exponent < 0 ? "10⁻" : "10";
    for (const char c : std::to_string(std::abs(exponent))) out += raised[c - '0'];
    return out;
}

std::string short_number(double v)
{
    if (std::isnan(v)) return "–";
    if (std::isinf(v)) return v < 0 ? "−∞" : "∞";
    const double a = std::fabs(v);
    char text[32];
    if (a == 0 || (a >= 1e-3 && a < 1e5))
    {
        std::snprintf(text, sizeof text, "%.3g", v);
        if (a >= 1000) std::snprintf(text, sizeof text, "%.0f", v);
        return text;
    }
    int exponent = static_cast<int>(std::floor(std::log10(a)));
    double mantissa = v / std::pow(10.0, exponent);
    if (std::fabs(mantissa) >= 9.95) mantissa /= 10, ++exponent;
    std::snprintf(text, sizeof text, "%.1f", mantissa);
    return std::string(text) + "·" + power_of_ten(exponent);
}

}  // namespace plab::figures
