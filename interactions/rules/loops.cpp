#include "loops.h"

#include <algorithm>
#include <cmath>

namespace plab::rules
{
namespace
{

struct Reached
{
    Ref object;
    Path path;
};

}  // namespace

std::optional<Path> find_path(const std::vector<Coupling>& couplings, Ref from, Ref to)
{
    std::vector<Reached> reached{{from, {}}};
    for (std::size_t k = 0; k < reached.size(); ++k)
    {
        const Reached at = reached[k];
        if (at.object == to) return at.path;
        for (const Coupling& c : couplings)
        {
            if (c.a != at.object && c.b != at.object) continue;
            const bool forward = c.a == at.object;
            const Ref next = forward ? c.b : c.a;
            if (std::any_of(reached.begin(), reached.end(), [&](const Reached& r) { return r.object == next; })) continue;
            reached.push_back(
                {next, {at.path.ratio * (forward ? c.ratio : 1 / c.ratio), at.path.ids + (at.path.ids.empty() ? "" : ", ") + c.id}});
        }
    }
    return {};
}

bool agree(double one, double other)
{
    constexpr double kRounding = 1e-9;
    return std::fabs(one - other) <= kRounding * std::max(std::fabs(one), std::fabs(other));
}

}  // namespace plab::rules
