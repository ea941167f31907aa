#include "model/measured_costs.h"

#include <cstdio>

namespace plab::model
{

std::string measured_cost_of(std::string_view type)
{
    const auto figure = [](double us) -> std::string
    {
        if (us < 0) return "refused";
        char text[32];
        std::snprintf(text, sizeof text, "%.3g us", us);
        return text;
    };
    for (const MeasuredCost& m : kMeasuredCosts)
        if (m.type == type)
            return figure(m.few) + " with one body, " + figure(m.many) + " with 192, " + figure(m.tied) +
                   (type.starts_with("Solver/") ? " with three hinged ones" : " in a stack of 20");
    return {};
}

}  // namespace plab::model
