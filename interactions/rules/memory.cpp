#include "memory.h"

#include <algorithm>

namespace plab::rules
{

void Memory::refresh(const Lookup& lookup, const Wanted& a, const Wanted& b, const Entries& kept)
{
    if (structure_ != lookup.structure())
    {
        structure_ = lookup.structure();
        sites = find_sites(lookup, a, b);
        by_object_.clear();
        for (std::uint32_t i = 0; i < sites.size(); ++i) by_object_.emplace_back(sites[i].object, i);
        std::sort(by_object_.begin(), by_object_.end());
    }
    links = to_links(kept);
    // Sites are in the order of their ids.
    const auto site_of = [&](const std::string& id)
    {
        const auto before = [&](const Site& site, const std::string& wanted) { return lookup.id_of(site.component) < wanted; };
        const auto found = std::lower_bound(sites.begin(), sites.end(), id, before);
        const bool there = found != sites.end() && lookup.id_of(found->component) == id;
        return there ? static_cast<std::uint32_t>(found - sites.begin()) : kNoIndex;
    };
    for (Link& link : links) link.site_a = site_of(link.a), link.site_b = site_of(link.b);
    index_links();
    asked_at = kNothing;
}

std::span<const std::pair<Ref, std::uint32_t>> Memory::sites_on(Ref object) const
{
    const auto first = std::lower_bound(by_object_.begin(), by_object_.end(), std::pair(object, std::uint32_t{0}));
    auto last = first;
    while (last != by_object_.end() && last->first == object) ++last;
    return {first, last};
}

void Memory::index_links()
{
    by_sites_.clear(), by_objects_.clear();
    for (std::uint32_t k = 0; k < links.size(); ++k)
    {
        const std::uint32_t a = links[k].site_a, b = links[k].site_b;
        if (a == kNoIndex || b == kNoIndex) continue;
        by_sites_.push_back({{a, b}, k}), by_sites_.push_back({{b, a}, k});
        by_objects_.emplace_back(sites[a].object, sites[b].object), by_objects_.emplace_back(sites[b].object, sites[a].object);
    }
    std::sort(by_sites_.begin(), by_sites_.end());
    std::sort(by_objects_.begin(), by_objects_.end());
}

const Link* Memory::find(std::uint32_t site_a, std::uint32_t site_b) const
{
    const PairSearch::Pair pair(site_a, site_b);
    const auto found = std::lower_bound(by_sites_.begin(), by_sites_.end(), std::pair(pair, std::uint32_t{0}));
    return found != by_sites_.end() && found->first == pair ? &links[found->second] : nullptr;
}

bool Memory::links_objects(Ref one, Ref other) const
{
    return std::binary_search(by_objects_.begin(), by_objects_.end(), std::pair(one, other));
}

std::int64_t Memory::count_at(std::uint32_t site) const
{
    return std::count_if(links.begin(), links.end(),
                         [&](const Link& l) { return l.progress != Progress::Refused && (l.site_a == site || l.site_b == site); });
}

std::span<const PairSearch::Pair> Memory::near_pairs(const Bodies& bodies, const Shafts& shafts, double reach)
{
    origins_.clear();
    for (const Site& site : sites) origins_.push_back(origin_of(site, bodies, shafts));
    search_.follow(origins_, reach);
    return search_.pairs();
}

}  // namespace plab::rules
