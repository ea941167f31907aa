#include "figures/drawing.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace plab::figures
{
namespace
{

std::string number(double v)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", v);
    std::string out = text;
    while (out.back() == '0') out.pop_back();
    if (out.back() == '.') out.pop_back();
    return out == "-0" ? "0" : out;
}

/// "f3" or "k3": the class of an ink as fill or as stroke.
std::string class_of(const Ink& ink)
{
    constexpr std::array names{"none", "text", "muted", "grid", "paper", "front", "shade"};
    return ink.role == Ink::Role::Series ? std::to_string(ink.index) : names[static_cast<std::size_t>(ink.role)];
}

std::string hex(const Rgb& c)
{
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", static_cast<int>(std::lround(c.r * 255)), static_cast<int>(std::lround(c.g * 255)),
                  static_cast<int>(std::lround(c.b * 255)));
    return text;
}

std::string fill_attribute(const Ink& ink)
{
    return ink.role == Ink::Role::Exact ? " fill=\"" + hex(light_color(ink)) + "\"" : " class=\"f-" + class_of(ink) + "\"";
}

std::string stroke_attribute(const Pen& pen)
{
    std::string out =
        pen.ink.role == Ink::Role::Exact ? " stroke=\"" + hex(light_color(pen.ink)) + "\"" : " class=\"k-" + class_of(pen.ink) + "\"";
    out += " stroke-width=\"" + number(pen.width) + "\" fill=\"none\"";
    return pen.dashed ? out + " stroke-dasharray=\"5 4\"" : out;
}

std::string coordinates(const std::vector<Spot>& points)
{
    std::string out;
    for (const Spot& p : points) out += (out.empty() ? "" : " ") + number(p.x) + "," + number(p.y);
    return out;
}

/// Corners of a marker around the origin; empty: a disc.
std::vector<Spot> corners(int shape, double r)
{
    switch (shape % Drawing::kMarkers)
    {
        case 1:
            return {{-0.85 * r, -0.85 * r}, {0.85 * r, -0.85 * r}, {0.85 * r, 0.85 * r}, {-0.85 * r, 0.85 * r}};
        case 2:
            return {{0, -1.15 * r}, {1.1 * r, 0.85 * r}, {-1.1 * r, 0.85 * r}};
        case 3:
            return {{0, -1.25 * r}, {1.25 * r, 0}, {0, 1.25 * r}, {-1.25 * r, 0}};
        case 4:
            return {{0, 1.15 * r}, {-1.1 * r, -0.85 * r}, {1.1 * r, -0.85 * r}};
        case 5:
            return {{-r, -r / 3}, {-r / 3, -r / 3}, {-r / 3, -r}, {r / 3, -r}, {r / 3, -r / 3}, {r, -r / 3},
                    {r, r / 3},   {r / 3, r / 3},   {r / 3, r},   {-r / 3, r}, {-r / 3, r / 3}, {-r, r / 3}};
        default:
            return {};
    }
}

struct Theme
{
    const char* text;
    const char* muted;
    const char* grid;
    const char* paper;
    const char* front;
    const char* shade;
    std::array<const char*, Ink::kSeries> series;
};
constexpr Theme kLight{"#1b1f24",
                       "#5b6570",
                       "#e3e7eb",
                       "#ffffff",
                       "#9aa4ae",
                       "#f0ecdf",
                       {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#56b4e9", "#5f4b8b", "#4d4d4d"}};
constexpr Theme kDark{"#e8ebee",
                      "#a3adb7",
                      "#333b44",
                      "#14181d",
                      "#76818c",
                      "#2b2a22",
                      {"#4aa8e0", "#ff8c42", "#2fc99a", "#e6a3c8", "#d9b93b", "#8fd0f5", "#a893dd", "#b5b5b5"}};

std::string rules(const Theme& t)
{
    std::string out;
    const auto add = [&](const std::string& name, const char* color)
    { out += ".f-" + name + "{fill:" + color + "}.k-" + name + "{stroke:" + color + "}"; };
    add("text", t.text), add("muted", t.muted), add("grid", t.grid), add("paper", t.paper), add("front", t.front), add("shade", t.shade);
    for (std::size_t i = 0; i < t.series.size(); ++i) add(std::to_string(i), t.series[i]);
    return out;
}

Rgb from_hex(const char* text)
{
    unsigned v = 0;
    std::sscanf(text + 1, "%x", &v);
    return {((v >> 16) & 255) / 255.0, ((v >> 8) & 255) / 255.0, (v & 255) / 255.0};
}

}  // namespace

std::string svg_style() { return rules(kLight) + "@media (prefers-color-scheme:dark){@media screen{" + rules(kDark) + "}}"; }

Rgb light_color(const Ink& ink)
{
    switch (ink.role)
    {
        case Ink::Role::Text:
            return from_hex(kLight.text);
        case Ink::Role::Muted:
            return from_hex(kLight.muted);
        case Ink::Role::Grid:
            return from_hex(kLight.grid);
        case Ink::Role::Front:
            return from_hex(kLight.front);
        case Ink::Role::Shade:
            return from_hex(kLight.shade);
        case Ink::Role::Series:
            return from_hex(kLight.series[static_cast<std::size_t>(ink.index)]);
        case Ink::Role::Exact:
            return {ink.red / 255.0, ink.green / 255.0, ink.blue / 255.0};
        default:
            return {1, 1, 1};
    }
}

double text_width(const std::string& text, double size)
{
    double units = 0;
    for (const char c : text)
    {
        if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;  // a following byte of UTF-8
        units += c == 'i' || c == 'l' || c == '.' || c == ',' || c == ' ' ? 0.34
                 : c >= 'A' && c <= 'Z'                                   ? 0.68
                 : c == 'm' || c == 'w'                                   ? 0.85
                                                                          : 0.58;
    }
    return units * size;
}

std::string escape_markup(const std::string& text)
{
    std::string out;
    for (const char c : text)
    {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else if (static_cast<unsigned char>(c) >= 0x20 || c == '\n')
            out += c;
    }
    return out;
}

void Drawing::line(std::vector<Spot> points, Pen pen, std::string hint)
{
    Item i;
    i.points = std::move(points), i.pen = pen, i.hint = std::move(hint);
    items_.push_back(std::move(i));
}

void Drawing::area(std::vector<Spot> points, Ink fill, std::string hint)
{
    Item i;
    i.kind = Kind::Area, i.points = std::move(points), i.fill = fill, i.hint = std::move(hint);
    items_.push_back(std::move(i));
}

void Drawing::box(Spot c, double width, double height, Ink fill, std::string hint)
{
    area({c, {c.x + width, c.y}, {c.x + width, c.y + height}, {c.x, c.y + height}}, fill, std::move(hint));
}

void Drawing::marker(Spot at, int shape, double size, Ink ink, bool filled, std::string hint)
{
    Item i;
    i.points = corners(shape, size), i.hint = std::move(hint);
    i.kind = i.points.empty() ? Kind::Dot : Kind::Area;
    for (Spot& p : i.points) p.x += at.x, p.y += at.y;
    if (i.points.empty()) i.points = {at}, i.radius = size;
    i.fill = filled ? ink : Ink{Ink::Role::Paper, 0, 0, 0, 0};
    i.pen = {filled ? Ink{Ink::Role::Paper, 0, 0, 0, 0} : ink, filled ? 1.0 : 1.8, false};
    i.how.ink = ink;
    items_.push_back(std::move(i));
}

void Drawing::words(Spot at, std::string text, Words how)
{
    Item i;
    i.kind = Kind::Words, i.points = {at}, i.text = std::move(text), i.how = how;
    items_.push_back(std::move(i));
}

void Drawing::svg_item(const Item& item, std::string& out) const
{
    const std::string hint = item.hint.empty() ? "" : "<title>" + escape_markup(item.hint) + "</title>";
    const auto close = [&](const char* tag) { out += hint.empty() ? "/>\n" : ">" + hint + "</" + tag + ">\n"; };
    // A marker has an outline as well: two classes in one attribute.
    const bool outlined = item.pen.ink.role != Ink::Role::Text || item.kind == Kind::Dot;
    const std::string filled = item.fill.role == Ink::Role::Exact
                                   ? fill_attribute(item.fill)
                                   : " class=\"f-" + class_of(item.fill) +
                                         (outlined ? " k-" + class_of(item.pen.ink) + "\" stroke-width=\"" + number(item.pen.width) : "") +
                                         "\"";
    switch (item.kind)
    {
        case Kind::Line:
            out += "<polyline points=\"" + coordinates(item.points) + "\"" + stroke_attribute(item.pen) + " stroke-linejoin=\"round\"";
            return close("polyline");
        case Kind::Area:
            out += "<polygon points=\"" + coordinates(item.points) + "\"" + filled;
            return close("polygon");
        case Kind::Dot:
            out += "<circle cx=\"" + number(item.points[0].x) + "\" cy=\"" + number(item.points[0].y) + "\" r=\"" + number(item.radius) +
                   "\"" + filled;
            return close("circle");
        case Kind::Words:
            break;
    }
    const Spot p = item.points[0];
    const char* anchor = item.how.anchor == Anchor::Start ? "start" : item.how.anchor == Anchor::Middle ? "middle" : "end";
    out += "<text x=\"" + number(p.x) + "\" y=\"" + number(p.y) + "\" font-size=\"" + number(item.how.size) + "\" text-anchor=\"" + anchor +
           "\"" + fill_attribute(item.how.ink) + (item.how.bold ? " font-weight=\"600\"" : "") +
           (item.how.upright ? " transform=\"rotate(-90 " + number(p.x) + " " + number(p.y) + ")\"" : "") + ">" + escape_markup(item.text) +
           "</text>\n";
}

std::string Drawing::svg(bool standalone) const
{
    std::string out = standalone ? "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" : "";
    out += "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(width_) + " " + number(height_) +
           "\" role=\"img\" aria-label=\"" + escape_markup(title_) + "\" font-family=\"'Segoe UI',Roboto,'DejaVu Sans',sans-serif\"";
    if (standalone) out += " width=\"" + number(width_) + "\" height=\"" + number(height_) + "\"";
    out += ">\n";
    if (standalone) out += "<style>" + svg_style() + "</style>\n<rect width=\"100%\" height=\"100%\" class=\"f-paper\"/>\n";
    for (const Item& item : items_) svg_item(item, out);
    return out + "</svg>\n";
}

}  // namespace plab::figures
