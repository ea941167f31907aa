#include "daemon/figures_text.h"

#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "publish/figures.h"

namespace plab::daemon
{

std::string number(double v)
{
    if (!std::isfinite(v)) return "null";
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", v);
    return text;
}

std::string hash_text(std::uint64_t h)
{
    char text[20];
    std::snprintf(text, sizeof text, "%016" PRIx64, h);
    return text;
}

bool is_told(const world::Component& c) { return publish::is_object(c) || c.facet == Facet::Quantities; }

bool is_listed(const world::World& world, std::uint32_t i)
{
    return publish::is_interaction(world.component(i)) && !publish::is_solver(world, i);
}

}  // namespace plab::daemon
