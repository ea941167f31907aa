/// What a rule derives from its state and from the scene, and keeps from step to step so that a step without changes needs no memory.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "condition.h"
#include "links.h"
#include "pair_search.h"
#include "sites.h"

namespace plab::rules
{

class Memory
{
public:
    /// Finds the sites again, and the places of the links among them.
    void refresh(const Lookup& lookup, const Wanted& a, const Wanted& b, const Entries& links);
    bool is_fresh(const Lookup& lookup, Tick tick) const
    {
        return structure_ == lookup.structure() && (asked_at == kNothing || asked_at == tick);
    }

    /// Indices of the sites on an object.
    std::span<const std::pair<Ref, std::uint32_t>> sites_on(Ref object) const;
    /// The link between two sites; null: there is none.
    const Link* find(std::uint32_t site_a, std::uint32_t site_b) const;
    /// Whether there is a link between two objects.
    bool links_objects(Ref one, Ref other) const;
    /// How many links hold a site: drawing or made.
    std::int64_t count_at(std::uint32_t site) const;
    /// To be called after links have changed.
    void index_links();
    /// Sites whose frames are near one another.
    std::span<const PairSearch::Pair> near_pairs(const Bodies& bodies, const Shafts& shafts, double reach);

    std::vector<Site> sites;
    std::vector<Link> links;
    static constexpr Tick kNothing = -1;
    Tick asked_at = kNothing;  ///< when something was asked for of which it is not known yet whether it was done
    std::unique_ptr<Condition> condition;

private:
    std::uint64_t structure_ = ~std::uint64_t{0};
    std::vector<std::pair<Ref, std::uint32_t>> by_object_;
    std::vector<std::pair<PairSearch::Pair, std::uint32_t>> by_sites_;  ///< of the links, both orders of the sites
    std::vector<std::pair<Ref, Ref>> by_objects_;                       ///< of the links, both orders
    std::vector<Vec3> origins_;
    PairSearch search_;
};

}  // namespace plab::rules
