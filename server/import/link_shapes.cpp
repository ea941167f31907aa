#include "import/link_shapes.h"

#include <algorithm>

namespace plab::import
{
namespace
{

bool same_form(const RobotShape& a, const RobotShape& b)
{
    const bool one_mesh = a.mesh && b.mesh ? a.mesh->vertices == b.mesh->vertices : a.mesh == b.mesh;
    return a.kind == b.kind && a.pose == b.pose && a.size == b.size && one_mesh;
}

}  // namespace

std::vector<RobotShape> joined_shapes(std::vector<RobotShape> seen, std::vector<RobotShape> felt, const std::string& link,
                                      Document& document)
{
    for (RobotShape& shape : felt)
    {
        const auto same = std::ranges::find_if(seen, [&](const RobotShape& s) { return !s.collides && same_form(s, shape); });
        if (same != seen.end())
            same->collides = true, same->surface = shape.surface, same->contact_type = shape.contact_type,
            same->contact_affinity = shape.contact_affinity;
        else
        {
            if (!seen.empty())
                document.lost(shape.where, "<collision> of link '" + link + "'", "is drawn as well: what collides in pLab is seen");
            seen.push_back(std::move(shape));
        }
    }
    return seen;
}

}  // namespace plab::import
