#include "figures/chart.h"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace plab::figures
{
namespace
{

constexpr double kWidth = 980, kLeft = 96, kRight = 28;  // px
constexpr double kHead = 48, kMomentLine = 15, kPanel = 210, kOnlyPanel = 290, kBetween = 22, kFoot = 56;
constexpr double kLegendLine = 19, kLegendSize = 12, kMomentSize = 10.5;
constexpr double kNames = 190, kLegend = kNames + 46;  // px; the same in all charts, so that their time axes agree
constexpr double kNear = 3;                            // px; marks closer than this are merged
const Ink kMuted{Ink::Role::Muted, 0, 0, 0, 0};

/// A curve with the names of all that are equal to it.
struct NamedCurve
{
    const Curve* curve;
    std::vector<std::string> names;
};

struct Group
{
    std::string unit;
    std::vector<NamedCurve> curves;
};

bool are_equal(const Curve& a, const Curve& b)
{
    const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                      [&](const auto& p, const auto& q) { return same(p.first, q.first) && same(p.second, q.second); });
}

std::vector<Group> groups_of(const Chart& chart)
{
    std::vector<Group> out;
    for (const Curve& curve : chart.curves)
    {
        auto found = std::find_if(out.begin(), out.end(), [&](const Group& g) { return g.unit == curve.unit; });
        if (found == out.end()) found = out.insert(out.end(), Group{curve.unit, {}});
        const auto is_equal = [&](const NamedCurve& other) { return are_equal(*other.curve, curve); };
        if (auto equal = std::find_if(found->curves.begin(), found->curves.end(), is_equal); equal != found->curves.end())
            equal->names.push_back(curve.name);
        else
            found->curves.push_back({&curve, {curve.name}});
    }
    return out;
}

/// The beginning of `text` that fits, or all of it.
std::string fitted(std::string text, double width)
{
    if (text_width(text, kLegendSize) <= width) return text;
    while (!text.empty() && text_width(text + "…", kLegendSize) > width)
    {
        while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0u) == 0x80u) text.pop_back();
        if (!text.empty()) text.pop_back();
    }
    return text + "…";
}

/// "a, b and 3 more", as many names as fit.
std::string legend_text(const std::vector<std::string>& names)
{
    std::string out = names.front();
    for (std::size_t i = 1; i < names.size(); ++i)
    {
        const std::string more = i + 1 < names.size() ? " and " + std::to_string(names.size() - i - 1) + " more" : "";
        if (text_width(out + ", " + names[i] + more, kLegendSize) > kNames)
            return fitted(out, kNames - text_width(" and 99 more", kLegendSize)) + " and " + std::to_string(names.size() - i) + " more";
        out += ", " + names[i];
    }
    return fitted(out, kNames);
}

std::string joined(const std::vector<std::string>& names)
{
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
    return out;
}

Scale times_of(const Chart& chart)
{
    Scale out{Scale::Kind::Linear, INFINITY, -INFINITY, 1};
    if (chart.times && chart.times->first < chart.times->second) return {Scale::Kind::Linear, chart.times->first, chart.times->second, 1};
    for (const Curve& curve : chart.curves)
        for (const auto& [time, value] : curve.points)
            if (std::isfinite(value)) out.low = std::min(out.low, time), out.high = std::max(out.high, time);
    if (out.low > out.high) out.low = 0, out.high = 1;
    if (out.low == out.high) out.low -= 0.5, out.high += 0.5;
    return out;
}

Scale values_of(const Group& group, const Chart& chart)
{
    std::vector<double> values;
    for (const NamedCurve& c : group.curves)
        for (const auto& [time, value] : c.curve->points) values.push_back(value);
    Scale out = Scale::around(chart.kind, values);
    out.threshold = std::max(out.threshold, chart.least);
    return out;
}

bool is_on(const Scale& x, double at) { return at >= x.low && at <= x.high; }

/// The segments between points that have no position on the scale.
void draw_curve(Drawing& d, const Panel& p, const NamedCurve& named, const Pen& pen)
{
    const Curve& curve = *named.curve;
    const std::string hint = joined(named.names);
    std::vector<Spot> piece;
    const auto finish = [&]
    {
        if (piece.size() == 1) d.marker(piece.front(), 0, 2, pen.ink, true, hint);
        if (piece.size() > 1) d.line(std::move(piece), pen, hint);
        piece.clear();
    };
    for (const auto& [time, value] : curve.points)
    {
        const bool has_place = std::isfinite(value) && (p.y.kind != Scale::Kind::Log || value > 0);
        if (has_place)
            piece.push_back(p.at(time, value));
        else
            finish();
    }
    finish();
}

Pen pen_of(std::size_t index) { return {Ink::series(static_cast<int>(index)), 1.7, index >= Ink::kSeries}; }

void draw_legend(Drawing& d, const Panel& p, const Group& group)
{
    const auto room = static_cast<std::size_t>(std::max(1.0, std::floor(p.height / kLegendLine)));
    const std::size_t shown = group.curves.size() <= room ? group.curves.size() : room - 1;
    double y = p.top + 8;
    for (std::size_t i = 0; i < shown; ++i, y += kLegendLine)
    {
        Pen pen = pen_of(i);
        pen.width = 2.5;
        d.line({{p.right() + 14, y}, {p.right() + 34, y}}, pen);
        d.words({p.right() + 40, y + 4}, legend_text(group.curves[i].names), {kLegendSize, {}, Anchor::Start, false, false});
    }
    const std::size_t rest = group.curves.size() - shown;
    if (rest > 0)
        d.words({p.right() + 40, y + 4}, "and " + std::to_string(rest) + " more", {kLegendSize, kMuted, Anchor::Start, false, false});
}

/// Lines across all panels; their texts are in as many rows above the first panel as needed to keep them apart.
class Moments
{
public:
    static constexpr std::size_t kMostLines = 4;

    /// `right`: texts may extend up to here, above the legend.
    Moments(const Chart& chart, const Scale& x, double left, double width, double right) : right_(right)
    {
        for (const Moment& m : chart.moments)
            if (is_on(x, m.at) && (m.kind == Moment::Kind::Change || m.kind == Moment::Kind::Break)) place(m, left + width * x.at(m.at));
    }
    double height() const { return kMomentLine * static_cast<double>(ends_.size()); }

    void draw(Drawing& d, double top, double bottom) const
    {
        for (const Placed& p : placed_)
        {
            const bool is_change = p.moment->kind == Moment::Kind::Change;
            // Starts below its own text, so that it does not cross the texts of others above.
            const double begin = top - height() + kMomentLine * static_cast<double>(std::min(p.line, ends_.size()));
            d.line({{p.x, begin}, {p.x, bottom}}, {is_change ? Ink{} : kMuted, is_change ? 1.1 : 1.4, is_change}, p.moment->words);
            if (p.line == kMostLines) continue;
            const double y = top - height() + kMomentLine * static_cast<double>(p.line) + 10;
            d.words({p.x + (p.is_left ? -5 : 5), y}, p.moment->words,
                    {kMomentSize, is_change ? Ink{} : kMuted, p.is_left ? Anchor::End : Anchor::Start, false, false});
        }
    }

private:
    struct Placed
    {
        const Moment* moment;
        double x;
        std::size_t line;  ///< kMostLines: no room for its text
        bool is_left;      ///< the text is to the left of its line
    };
    void place(const Moment& m, double x)
    {
        const double wide = text_width(m.words, kMomentSize) * 1.06 + 8;
        const bool is_left = x + wide > right_;
        const double begin = is_left ? x - wide : x, end = is_left ? x : x + wide;
        std::size_t line = 0;
        while (line < ends_.size() && ends_[line] > begin) ++line;
        if (line == ends_.size() && line < kMostLines) ends_.push_back(end);
        if (line < kMostLines) ends_[line] = std::max(ends_[line], end);
        placed_.push_back({&m, x, line, is_left});
    }

    double right_;
    std::vector<Placed> placed_;
    std::vector<double> ends_;  ///< of the texts in each row
};

/// Small triangles at the bottom of a panel; marks close to each other share one.
void draw_notices(Drawing& d, const Panel& p, const Chart& chart)
{
    for (const Moment::Kind kind : {Moment::Kind::Notice, Moment::Kind::Alarm})
    {
        double last = -INFINITY;
        for (const Moment& m : chart.moments)
        {
            const double x = p.left + p.width * p.x.at(m.at);
            if (m.kind != kind || !is_on(p.x, m.at) || x - last < kNear) continue;
            last = x;
            d.marker({x, p.bottom() - 4}, 2, 3.2, kind == Moment::Kind::Alarm ? Ink::series(1) : kMuted, true, m.words);
        }
    }
}

bool has_notices(const Chart& chart)
{
    return std::any_of(chart.moments.begin(), chart.moments.end(),
                       [](const Moment& m) { return m.kind == Moment::Kind::Notice || m.kind == Moment::Kind::Alarm; });
}

void draw_group(Drawing& d, const Panel& p, const Chart& chart, const Group& group, bool is_last)
{
    // Only the last panel has times at its bottom.
    draw_panel(d, p, is_last ? chart.x_name : "", group.unit);
    const std::size_t count = std::min(group.curves.size(), kMostCurves);
    for (std::size_t i = 0; i < count; ++i)
    {
        // The first curves are the broadest, so that curves which nearly coincide are all visible.
        Pen pen = pen_of(i);
        pen.width += 0.7 * static_cast<double>(std::min<std::size_t>(count - 1 - i, 5));
        draw_curve(d, p, group.curves[i], pen);
    }
    draw_legend(d, p, group);
    if (is_last && has_notices(chart)) draw_notices(d, p, chart);
}

}  // namespace

Drawing draw(const Chart& chart)
{
    const std::vector<Group> groups = groups_of(chart);
    const Scale x = times_of(chart);
    const double width = kWidth - kLeft - kRight - kLegend;
    const Moments moments(chart, x, kLeft, width, kWidth - 8);
    const double top = kHead + moments.height() + (moments.height() > 0 ? 4 : 0);
    const double panels = static_cast<double>(std::max<std::size_t>(groups.size(), 1));
    const double height = panels > 1 ? kPanel : kOnlyPanel;
    const double bottom = top + panels * height + (panels - 1) * kBetween;
    Drawing d(kWidth, bottom + kFoot, chart.title);
    d.words({kLeft, 24}, chart.title, {16, {}, Anchor::Start, true, false});
    d.words({kLeft + text_width(chart.title, 16) * 1.1 + 14, 24}, chart.subtitle, {13, kMuted, Anchor::Start, false, false});
    for (std::size_t i = 0; i < groups.size(); ++i)
    {
        Panel p;
        p.left = kLeft, p.width = width, p.height = height, p.top = top + static_cast<double>(i) * (height + kBetween);
        p.x = x, p.y = values_of(groups[i], chart);
        const bool is_last = i + 1 == groups.size();
        if (!is_last)
            for (Mark mark : marks_of(x)) p.x_marks.push_back({mark.value, ""});
        draw_group(d, p, chart, groups[i], is_last);
    }
    if (groups.empty()) d.words({kLeft, top + 40}, "nothing to draw", {13, kMuted, Anchor::Start, false, false});
    moments.draw(d, top, bottom);
    return d;
}

Result<void> write_picture(const Drawing& drawing, const std::string& path)
{
    if (path.ends_with(".png")) return drawing.write_png(path);
    if (!path.ends_with(".svg")) return reason(path + ": a picture's name ends with .svg or .png");
    std::ofstream out(path, std::ios::binary);
    out << drawing.svg(true);
    if (!out.flush()) return reason("cannot write " + path);
    return {};
}

}  // namespace plab::figures
