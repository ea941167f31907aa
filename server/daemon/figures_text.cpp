#include "daemon/figures_text.h"

#include "model/numbers.h"
#include "publish/figures.h"

namespace plab::daemon
{

std::string number(double v) { return model::exact_text(v, "null"); }

bool is_shown(const world::Component& c) { return publish::is_object(c) || c.facet == Facet::Quantities; }

bool is_listed(const world::World& world, std::uint32_t i)
{
    return publish::is_interaction(world.component(i)) && !publish::is_solver(world, i);
}

}  // namespace plab::daemon
