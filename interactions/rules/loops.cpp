#include "loops.h"

#include <algorithm>
#include <cmath>

namespace plab::rules
{

Couplings::Root Couplings::root_of(Ref object)
{
    Root to{object, 1};
    for (auto at = above_.find(object); at != above_.end() && at->second.object != to.object; at = above_.find(to.object))
        to = {at->second.object, to.ratio * at->second.ratio};
    above_[object] = to;
    return to;
}

void Couplings::add(Coupling coupling)
{
    const Root a = root_of(coupling.a), b = root_of(coupling.b);
    // b = ratio a: the root of b makes ratio * a.ratio / b.ratio turns per turn of that of a.
    if (a.object != b.object) above_[b.object] = {a.object, coupling.ratio * a.ratio / b.ratio};
    at_[coupling.a].push_back(all_.size()), at_[coupling.b].push_back(all_.size());
    all_.push_back(std::move(coupling));
}

std::optional<double> Couplings::ratio(Ref a, Ref b)
{
    const Root to_a = root_of(a), to_b = root_of(b);
    if (to_a.object != to_b.object) return {};
    return to_b.ratio / to_a.ratio;
}

std::optional<Path> Couplings::path(Ref from, Ref to) const
{
    std::map<Ref, Path> reached{{from, {}}};
    std::vector<Ref> next{from};
    for (std::size_t k = 0; k < next.size(); ++k)
    {
        const Ref at = next[k];
        const Path way = reached.at(at);
        if (at == to) return way;
        const auto here = at_.find(at);
        if (here == at_.end()) continue;
        for (const std::size_t i : here->second)
        {
            const Coupling& c = all_[i];
            const bool forward = c.a == at;
            const Ref there = forward ? c.b : c.a;
            Path further{way.ratio * (forward ? c.ratio : 1 / c.ratio), way.ids + (way.ids.empty() ? "" : ", ") + c.id};
            if (reached.emplace(there, std::move(further)).second) next.push_back(there);
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
