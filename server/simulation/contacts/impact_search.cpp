// How the impacts of a step are found, where the resolution of a detection adapts to its contacts (TypeInfo::adapts).
//
// The choice is made at the start of each step, from the known pairs and the velocities alone: all of these are state, so a run that is
// rewound or restored makes the same choice.
#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/contacts/contact_book.h"
#include "simulation/contacts/sleeping_pairs.h"
#include "simulation/motion/component_call.h"

namespace plab::simulation
{
namespace
{

/// The largest distance that a point of a dynamic body moves within the step at its present velocities, in units of its radius; of a thin
/// body, in units of half its thickness: a plate that falls over is fast for its edge. A ball that spins moves nowhere.
double largest_travel(const Bodies& bodies, std::span<const double> radius_of_body, std::span<const double> thickness_of_body, double h)
{
    double most = 0;
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        const double radius = radius_of_body[b];
        if (!bodies.dynamic(b) || !(radius > 0) || !std::isfinite(radius)) continue;
        constexpr double kThin = 0.125;  // of the radius
        const double thickness = thickness_of_body[b];
        const bool thin = thickness > 0 && thickness < kThin * radius;
        const double lever = thickness > 0 ? std::max(0.0, radius - thickness) : 0.0;
        const double speed = length(bodies.velocity[b]) + length(bodies.angular_velocity[b]) * lever;
        most = std::max(most, speed * h / (thin ? thickness : radius));
    }
    return most;
}

void apply(ImpactSearch search, Detector& d)
{
    d.locates = d.local = d.certifies = search == ImpactSearch::Locate;
    d.speculates = search == ImpactSearch::Speculate;
}

ImpactSearch search_of(const Detector& d)
{
    return d.locates ? ImpactSearch::Locate : d.speculates ? ImpactSearch::Speculate : ImpactSearch::AtEnd;
}

}  // namespace

/// Fills in the largest islands of persistent contacts and of joints of bodies that touch something, over all detections: a body may rest
/// on what another detection holds, and an impact on one link of a chain is an impact on all of them.
template <class Pair>
void ContactBook::measure_islands(std::span<const Pair> pairs, ContactLoad& load)
{
    const Bodies& bodies = step_.world.host().bodies;
    load_islands_.reset(bodies.size());
    load_counts_.assign(bodies.size(), {});
    // Before contacts join anything, so that the first and the last member tell whether a group has been joined already.
    const auto join_members = [&](Ref body)
    {
        const std::uint32_t g = bodies.dynamic(body.index) ? step_.groups.of(body) : kNoIndex;
        if (g == kNoIndex || step_.groups.all[g].rows.empty()) return;
        const std::vector<std::uint32_t>& members = step_.groups.all[g].bodies;
        if (load_islands_.find(members.back()) == load_islands_.find(members.front())) return;
        for (const std::uint32_t b : members) load_islands_.join(members.front(), b);
    };
    for (const Pair& p : pairs) join_members(p.a), join_members(p.b);
    // Points are counted at one body of each pair first, so that the pairs are gone through once.
    for (const Pair& p : pairs)
    {
        if (!p.resting) continue;
        if (bodies.dynamic(p.a.index) && bodies.dynamic(p.b.index)) load_islands_.join(p.a.index, p.b.index);
        load_counts_[bodies.dynamic(p.a.index) ? p.a.index : p.b.index].points += p.count;
    }
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        const std::uint32_t root = load_islands_.find(b);
        IslandCount& island = load_counts_[root];
        if (root != b) island.points += load_counts_[b].points;
        load.island_points = std::max(load.island_points, island.points);
        if (bodies.dynamic(b)) ++load.bodies, load.island_bodies = std::max(load.island_bodies, ++island.bodies);
    }
}

/// What touches before the first step, when no pair is known yet: what was built on the ground stands there, and is no impact.
std::vector<ContactBook::FirstTouch> ContactBook::first_touches()
{
    double margin = 0;
    for (const double radius : radius_of_body_)
        if (std::isfinite(radius)) margin = std::max(margin, kPersistenceShare * radius);
    std::vector<FirstTouch> out;
    for (std::uint32_t d = 0; d < detectors_.size(); ++d)
    {
        std::vector<FoundContact> found;
        if (!detect(detectors_[d], d, {}, false, found, margin)) sort_contacts(found, step_.world);
        std::erase_if(found, [&](const FoundContact& f) { return f.contact.depth <= -persistence_margin(f.contact.a, f.contact.b); });
        for (std::size_t i = 0; i < found.size(); ++i)
        {
            if (i == 0 || !same_pair(found[i], found[i - 1])) out.push_back({found[i].contact.a, found[i].contact.b});
            ++out.back().count;
        }
    }
    return out;
}

/// Asks the resolutions that adapt, for the state of all bodies and `pairs`. Others keep what they have.
void ContactBook::ask_search(std::span<const PairState> pairs, std::vector<ImpactSearch>& out)
{
    ContactLoad load;
    if (pairs.empty() && step_.frame.tick == 0)
        measure_islands(std::span<const FirstTouch>(first_touches()), load);
    else
        measure_islands(pairs, load);
    for (const auto& island : std::as_const(cache_).rest().islands)
    {
        load.island_bodies = std::max(load.island_bodies, static_cast<std::uint32_t>(island->bodies.size()));
        load.island_points = std::max(load.island_points, island->points);
    }
    load.travel = largest_travel(step_.world.host().bodies, radius_of_body_, thickness_of_body_, step_.frame.step);
    out.clear();
    for (const Detector& d : detectors_)
    {
        ImpactSearch& search = out.emplace_back(search_of(d));
        if (!d.adapts) continue;
        load.has_manager = d.by_rows, load.search = ImpactSearch::AtEnd;
        ComponentCall question(step_, d.resolution);
        question.arguments.load = &load;
        question.run(Phase::Choose);
        search = load.search;
        if (search == ImpactSearch::Locate && !d.gap) search = ImpactSearch::AtEnd;
        if (search == ImpactSearch::Speculate && !d.by_rows) search = ImpactSearch::AtEnd;
    }
}

bool ContactBook::adapts() const
{
    return std::any_of(detectors_.begin(), detectors_.end(), [](const Detector& d) { return d.adapts; });
}

void ContactBook::search_as(const ContactBook& whole)
{
    imposed_.clear();
    // Before the first step the whole scene knows no pairs, and the part chooses by what touches in it.
    if (step_.frame.tick == 0 && whole.cache_.pairs().empty()) return;
    ask_search(whole.cache_.pairs(), imposed_);
}

bool ContactBook::choose_search()
{
    if (!adapts()) return false;
    if (imposed_.empty())
        ask_search(std::as_const(cache_).pairs(), searches_);
    else
        searches_ = imposed_;
    bool changed = false;
    for (std::size_t k = 0; k < detectors_.size(); ++k)
    {
        Detector& d = detectors_[k];
        if (!d.adapts) continue;
        changed = changed || searches_[k] != search_of(d);
        apply(searches_[k], d);
        if (!d.persists()) continue;
        // A pair between two bounces is a contact like any other where impacts are not located.
        for (PairState& p : cache_.pairs())
            if (p.detector == d.component) p.resting = true;
        resting_.forget();
    }
    return changed;
}

}  // namespace plab::simulation
