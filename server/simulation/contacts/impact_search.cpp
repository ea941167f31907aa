// How the impacts of a step are found, where the resolution of a detection adapts to its contacts (TypeInfo::adapts).
//
// The choice is made at the start of each step, from the known pairs, the velocities and what was crowded before (crowds.h): all of these
// are state, so a run that is rewound or restored makes the same choice.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "simulation/contacts/contact_book.h"
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

void set(Detector& d, ImpactSearch apart, ImpactSearch crowded)
{
    d.locates = d.local = d.certifies = apart == ImpactSearch::Locate;
    d.spares_crowds = crowded != apart;
    d.speculates = crowded == ImpactSearch::Speculate;
}

ImpactSearch search_of(const Detector& d)
{
    return d.locates ? ImpactSearch::Locate : d.speculates ? ImpactSearch::Speculate : ImpactSearch::AtEnd;
}

}  // namespace

/// What touches before the first step, when no pair is known yet: what was built on the ground stands there, and is no impact.
std::vector<FirstTouch> ContactBook::first_touches()
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

/// With several resolutions that adapt, the smallest limits and the longest dwell hold for all. Sensors do not count.
Crowds::Limits ContactBook::limits_of_crowds() const
{
    Crowds::Limits out;
    for (const Detector& d : detectors_)
    {
        if (!d.adapts || (!d.responds && !d.by_rows)) continue;
        out.bodies = std::min(out.bodies, d.max_bodies.value_or(HUGE_VAL));
        out.points = std::min(out.points, d.max_points.value_or(HUGE_VAL));
        out.dwell = std::max(out.dwell, d.dwell.value_or(0));
    }
    return out;
}

void ContactBook::find_crowds(const ContactCache& cache, std::vector<double>& until)
{
    if (cache.pairs().empty() && step_.frame.tick == 0)
        crowds_.find(std::span<const FirstTouch>(first_touches()), cache.rest(), limits_of_crowds(), until);
    else
        crowds_.find(cache.pairs(), cache.rest(), limits_of_crowds(), until);
}

/// Asks the resolutions that adapt, for the state of all bodies and the pairs of `cache`. Others keep what they have.
void ContactBook::ask_search(const ContactCache& cache, std::vector<double>& until, SearchChoice& out)
{
    find_crowds(cache, until);
    ContactLoad load;
    load.bodies = crowds_.bodies(), load.crowded = crowds_.crowded();
    load.island_bodies = crowds_.island_bodies(), load.island_points = crowds_.island_points();
    load.travel = largest_travel(step_.world.host().bodies, radius_of_body_, thickness_of_body_, step_.frame.step);
    out.of.clear(), out.crowded.clear();
    bool spares = false;
    for (std::size_t d = 0; d < detectors_.size(); ++d)
    {
        const ImpactSearch present = search_of(detectors_[d]);
        out.of.push_back({present, present});
        SearchChoice::Of& own = out.of.back();
        if (detectors_[d].adapts) ask_search(d, load, own);
        spares = spares || own.apart != own.crowded;
    }
    if (spares) out.crowded = crowds_.by_body();
}

void ContactBook::ask_search(std::size_t detector, ContactLoad load, SearchChoice::Of& out)
{
    const Detector& d = detectors_[detector];
    load.has_manager = d.by_rows;
    ComponentCall question(step_, d.resolution);
    question.arguments.load = &load;
    question.run(Phase::Choose);
    const auto possible = [&](ImpactSearch search)
    {
        const bool lacks = (search == ImpactSearch::Locate && !d.gap) || (search == ImpactSearch::Speculate && !d.by_rows);
        return lacks ? ImpactSearch::AtEnd : search;
    };
    out = {possible(load.search), possible(load.crowded_search)};
    // Crowds are spared where they are contacts of a manager. Otherwise all pairs would have to be looked at again after each impact.
    const bool some = load.crowded > 0 && load.crowded < load.bodies;
    if (load.crowded == 0)
        out.crowded = out.apart;
    else if (!some || out.apart != ImpactSearch::Locate || !d.by_rows)
        out.apart = out.crowded;
}

void ContactBook::crowd_all()
{
    const Bodies& bodies = step_.world.host().bodies;
    std::vector<double>& until = cache_.crowded_until();
    until.resize(bodies.size(), -HUGE_VAL);
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
        if (bodies.dynamic(b)) until[b] = step_.frame.start_time + step_.frame.step;
}

bool ContactBook::adapts() const
{
    return std::any_of(detectors_.begin(), detectors_.end(), [](const Detector& d) { return d.adapts; });
}

void ContactBook::search_as(const ContactBook& whole)
{
    imposed_.reset();
    // Before the first step the whole scene knows no pairs, and the part chooses by what touches in it.
    if (step_.frame.tick == 0 && whole.cache_.pairs().empty()) return;
    std::vector<double> until = whole.cache_.crowded_until();
    ask_search(whole.cache_, until, imposed_.emplace());
}

ContactBook::SearchChange ContactBook::choose_search()
{
    if (!adapts()) return SearchChange::None;
    if (imposed_)
        choice_ = *imposed_;
    else
        ask_search(std::as_const(cache_), cache_.crowded_until(), choice_);
    return apply(choice_);
}

ContactBook::SearchChange ContactBook::apply(const SearchChoice& choice)
{
    SearchChange changed = crowded_ == choice.crowded ? SearchChange::None : SearchChange::Crowds;
    crowded_ = choice.crowded;
    for (std::size_t k = 0; k < detectors_.size(); ++k)
    {
        Detector& d = detectors_[k];
        if (!d.adapts) continue;
        const auto [apart, crowded] = choice.of[k];
        const std::tuple before(d.locates, d.spares_crowds, d.speculates);
        set(d, apart, crowded);
        if (std::tuple(d.locates, d.spares_crowds, d.speculates) != before) changed = SearchChange::Margins;
        if (!d.may_persist()) continue;
        // A pair between two bounces is a contact like any other where impacts are not located.
        for (PairState& p : cache_.pairs())
            if (p.detector == d.component && persists(d, p.a, p.b)) p.resting = true;
        resting_.forget();
    }
    return changed;
}

}  // namespace plab::simulation
