#include "import/cable_text.h"

#include <cmath>
#include <utility>

namespace plab::import
{
namespace
{

double length_of(const PlacedPart& part) { return length(part.a.point_W - part.b.point_W); }

/// Between one body, which moves, and another one or the world.
void write_line(const Cable& cable, PlacedPart part, double constant, CableText& out, Ids& ids)
{
    if (part.b.body.empty()) std::swap(part.a, part.b);
    const double d = part.divisor;
    const std::string ends = (part.a.body.empty() ? "" : attribute("a", part.a.body)) + attribute("b", part.b.body) +
                             attribute("anchor_a", part.a.point) + attribute("anchor_b", part.b.point);
    out.along = {ends + attribute("along", "distance"), 1 / d, d * constant};
    const double lower = d * (cable.lower - constant), upper = d * (cable.upper - constant);
    if (std::isfinite(lower) || std::isfinite(upper))
    {
        out.lines.push_back(
            component(ids.make(cable.name), "Constraint/Limit",
                      out.along->place + bound("lower", lower) + bound("upper", upper) + attribute("manager", ids.prefix() + "manager")));
        out.needs_manager = true;
    }
    if (!(cable.stiffness > 0 || cable.damping > 0)) return;
    const std::string rest = cable.rest ? attribute("length", std::fmax(0.0, d * (*cable.rest - constant))) : std::string();
    out.lines.push_back(
        component(ids.make(cable.name + ".spring"), "Constraint/SpringDamper",
                  ends + rest + attribute("stiffness", cable.stiffness / (d * d)) + attribute("damping", cable.damping / (d * d))));
}

/// Turns two parts so that they hang on a common body by their first ends. False: they do not.
bool share_carrier(PlacedPart& first, PlacedPart& second)
{
    for (int i = 0; i < 4; ++i)
    {
        const bool hang = !first.b.body.empty() && !second.b.body.empty() && first.b.body != second.b.body;
        if (hang && first.a.body == second.a.body) return true;
        std::swap(first.a, first.b);
        if (i == 1) std::swap(second.a, second.b);
    }
    return false;
}

void write_wheels(const Cable& cable, PlacedPart first, PlacedPart second, double constant, CableText& out, Ids& ids)
{
    if (!share_carrier(first, second) || !std::isfinite(cable.upper))
    {
        out.lost = "is not carried over: with two parts whose lengths change, it needs a range, and one end of each on the same body";
        return;
    }
    const double d = first.divisor;
    out.lines.push_back(component(ids.make(cable.name), "Constraint/Pulley",
                                  attribute("a", first.b.body) + attribute("b", second.b.body) +
                                      (first.a.body.empty() ? "" : attribute("carrier", first.a.body)) +
                                      attribute("anchor_a", first.b.point) + attribute("anchor_b", second.b.point) +
                                      attribute("wheel_a", first.a.point_W) + attribute("wheel_b", second.a.point_W) +
                                      attribute("ratio", d / second.divisor) + attribute("length", d * (cable.upper - constant)) +
                                      attribute("slack", "true") + attribute("manager", ids.prefix() + "manager")));
    out.needs_manager = true;
    if (std::isfinite(cable.lower) || cable.stiffness > 0 || cable.damping > 0)
        out.lost = "only its largest length is carried over: it runs over wheels";
}

}  // namespace

CableText cable_text(const Cable& cable, const std::vector<PlacedPart>& parts, Ids& ids)
{
    CableText out;
    double constant = 0;  // m
    std::vector<PlacedPart> changing;
    for (const PlacedPart& part : parts)
        if (part.a.body == part.b.body)
            constant += length_of(part) / part.divisor;
        else
            changing.push_back(part);
    if (changing.size() == 1)
        write_line(cable, changing.front(), constant, out, ids);
    else if (changing.size() == 2)
        write_wheels(cable, changing.front(), changing.back(), constant, out, ids);
    else if (changing.empty())
        out.lost = "is not carried over: its length does not change";
    else
        out.lost = "is not carried over: only one or two of its parts may have lengths that change";
    return out;
}

}  // namespace plab::import
