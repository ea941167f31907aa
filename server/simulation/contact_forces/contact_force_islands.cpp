// Islands of groups that may touch by force: which they are, and what each of them has while it is advanced.
#include <algorithm>
#include <numeric>

#include "simulation/contact_forces/contact_forces.h"

namespace plab::simulation
{

/// Joins the groups among some that may push one another, and flags the sets that springs may push.
void ContactForces::join_near(std::span<const std::uint32_t> groups)
{
    const std::size_t count = step_.groups.all.size();
    member_.assign(count, 0), bound_.assign(count, 0);
    for (const std::uint32_t g : groups) member_[g] = 1;
    sets_.reset(count);
    const auto link = [&](Ref a, Ref b)
    {
        if (dynamic(a) && dynamic(b) && member_[step_.groups.of(a)] && member_[step_.groups.of(b)])
            sets_.join(step_.groups.of(a), step_.groups.of(b));
    };
    for (const NearPair& p : near_) link(p.a, p.b);
    for (const PairState& p : contacts_.cache().pairs())
        if (p.resting) link(p.a, p.b);
    for (const NearPair& p : near_)
        for (const Ref r : {p.a, p.b})
            if (dynamic(r) && member_[step_.groups.of(r)]) bound_[sets_.find(step_.groups.of(r))] = 1;
}

void ContactForces::make_islands(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> in_contact)
{
    island_of_.assign(step_.groups.all.size(), kNoIndex);
    for (const std::uint32_t g : groups)
    {
        if (!claims(g)) continue;
        std::uint32_t& at = island_of_[sets_.find(g)];
        if (at == kNoIndex)
        {
            at = static_cast<std::uint32_t>(island_count_++);
            if (islands_.size() < island_count_) islands_.emplace_back();
            islands_[at].groups.clear(), islands_[at].near.clear(), islands_[at].mixed = false;
        }
        islands_[at].groups.push_back(g);
        islands_[at].mixed = islands_[at].mixed || std::binary_search(in_contact.begin(), in_contact.end(), g);
    }
    for (std::size_t i = 0; i < island_count_; ++i) std::sort(islands_[i].groups.begin(), islands_[i].groups.end());
    for (std::uint32_t i = 0; i < near_.size(); ++i)
        for (const Ref r : {near_[i].a, near_[i].b})
        {
            const std::uint32_t g = dynamic(r) ? step_.groups.of(r) : kNoIndex;
            if (g == kNoIndex || !member_[g] || !claims(g)) continue;
            islands_[island_of_[sets_.find(g)]].near.push_back(i);
            break;
        }
}

/// Whether a group, one of those of join_near(), is advanced here.
bool ContactForces::claims(std::uint32_t group) { return bound_[sets_.find(group)] && step_.groups.all[group].solver != kNoIndex; }

void ContactForces::take(std::span<const std::uint32_t> groups, std::vector<std::uint32_t>& smooth, std::vector<std::uint32_t>& in_contact,
                         double from, double to)
{
    island_count_ = 0;
    if (!within_motion_margins(groups, to - from))
    {
        // An impact within the step has made a body faster than its margin allows.
        for (const std::uint32_t g : groups)
            for (const std::uint32_t b : step_.groups.all[g].bodies)
                motion_margin_[b] = std::max(motion_margin_[b], 2 * speed_of({Facet::Body, b}) * (to - from));
        find_near();
    }
    if (near_.empty()) return;
    join_near(groups);
    make_islands(groups, in_contact);
    const auto claimed = [&](std::uint32_t g) { return claims(g); };
    std::erase_if(smooth, claimed), std::erase_if(in_contact, claimed);
}

/// Takes the state of the island's pairs out of that of the scene.
void ContactForces::borrow(const Island& island)
{
    live_.pairs.clear(), live_.events.clear(), borrowed_.clear();
    for (const std::uint32_t i : island.near)
    {
        const NearPair& n = near_[i];
        const std::uint32_t component = contacts_.detectors()[n.detector].component;
        const auto at = place_of(scene_.pairs, component, n.a, n.b);
        if (at == scene_.pairs.end() || at->detector != component || at->a != n.a || at->b != n.b) continue;
        borrowed_.push_back(static_cast<std::uint32_t>(at - scene_.pairs.begin()));
    }
    std::sort(borrowed_.begin(), borrowed_.end());
    for (const std::uint32_t i : borrowed_) live_.pairs.push_back(scene_.pairs[i]);
}

/// Gives the state of an island that has been advanced back to that of the scene: in place, or by merge_returned() where pairs have begun
/// or ended.
void ContactForces::give_back()
{
    scene_.events.insert(scene_.events.end(), live_.events.begin(), live_.events.end());
    const auto is_same = [&](const ForcePair& p, std::uint32_t i)
    {
        const ForcePair& q = scene_.pairs[i];
        return p.detector == q.detector && p.a == q.a && p.b == q.b;
    };
    if (std::equal(live_.pairs.begin(), live_.pairs.end(), borrowed_.begin(), borrowed_.end(), is_same))
    {
        for (std::size_t k = 0; k < borrowed_.size(); ++k) scene_.pairs[borrowed_[k]] = live_.pairs[k];
        return;
    }
    for (const std::uint32_t i : borrowed_) gone_back_[i] = 1;
    returned_.insert(returned_.end(), live_.pairs.begin(), live_.pairs.end());
}

void ContactForces::merge_returned()
{
    order_of_returned_.resize(returned_.size());
    std::iota(order_of_returned_.begin(), order_of_returned_.end(), 0U);
    std::sort(order_of_returned_.begin(), order_of_returned_.end(),
              [&](std::uint32_t x, std::uint32_t y) { return precedes(returned_[x], returned_[y]); });
    merged_.clear();
    auto next = order_of_returned_.begin();
    for (std::size_t i = 0; i < scene_.pairs.size(); ++i)
    {
        if (gone_back_[i]) continue;
        for (; next != order_of_returned_.end() && precedes(returned_[*next], scene_.pairs[i]); ++next) merged_.push_back(returned_[*next]);
        merged_.push_back(scene_.pairs[i]);
    }
    for (; next != order_of_returned_.end(); ++next) merged_.push_back(returned_[*next]);
    std::swap(merged_, scene_.pairs);
}

/// Lists the groups that the forces of the island read, and those of kinematic bodies that may be touched.
void ContactForces::collect_observed(Island& island, std::span<const std::uint32_t> observed)
{
    known_.begin(step_.groups.all.size());
    for (const std::uint32_t g : island.groups) known_.add(g);
    island.observed.assign(observed.begin(), observed.end());
    for (const std::uint32_t g : observed) known_.add(g);
    const auto want = [&](std::uint32_t g)
    {
        if (g != kNoIndex && known_.add(g)) island.observed.push_back(g);
    };
    for (const std::uint32_t g : island.groups)
        for (const std::uint32_t up : step_.groups.all[g].upstream) want(up);
    for (std::size_t i = 0; i < island.observed.size(); ++i)
        for (const std::uint32_t up : step_.groups.all[island.observed[i]].upstream) want(up);
    for (const NearPair& p : pairs_)
        for (const Ref r : {p.a, p.b})
            if (!dynamic(r)) want(step_.groups.of(r));
    std::sort(island.observed.begin(), island.observed.end());
}

std::uint32_t ContactForces::solver_of(const Island& island) const
{
    // The same rule as for a group: the solver of the highest order, then the first by id.
    std::uint32_t best = kNoIndex;
    const world::World& world = step_.world;
    for (const std::uint32_t g : island.groups)
    {
        const std::uint32_t solver = step_.groups.all[g].solver;
        if (best == kNoIndex || solver == best)
        {
            best = solver;
            continue;
        }
        const int old = world.type_of(best)->info.order, fresh = world.type_of(solver)->info.order;
        if (fresh > old || (fresh == old && world.rank(solver) < world.rank(best))) best = solver;
    }
    return best;
}

void ContactForces::advance(std::span<const std::uint32_t> observed, double from, double to, WorkBook book, bool trial)
{
    if (island_count_ == 0) return;
    std::swap(live_, scene_);
    gone_back_.assign(scene_.pairs.size(), 0), returned_.clear();
    for (std::size_t i = 0; i < island_count_; ++i)
    {
        Island& island = islands_[i];
        borrow(island);
        bind(island);
        collect_observed(island, observed);
        advance_beside(island, from, to, book, trial);
        give_back();
    }
    if (!returned_.empty() || std::find(gone_back_.begin(), gone_back_.end(), 1) != gone_back_.end()) merge_returned();
    std::swap(live_, scene_);
}

/// Advances an island, and puts the groups that it observes back to where they were.
void ContactForces::advance_beside(const Island& island, double from, double to, WorkBook book, bool trial)
{
    world::HostTables& host = step_.world.host();
    const auto each = [&](auto body, auto shaft, auto quantities)
    {
        for (const std::uint32_t g : island.observed)
        {
            for (const std::uint32_t b : step_.groups.all[g].bodies) body(b);
            for (const std::uint32_t s : step_.groups.all[g].shafts) shaft(s);
            for (const std::uint32_t q : step_.groups.all[g].quantities) quantities(q);
        }
    };
    each([&](auto b) { observed_memento_.save_body(host, b); }, [&](auto s) { observed_memento_.save_shaft(host, s); },
         [&](auto q) { observed_memento_.save_quantities(host, q); });
    if (island.mixed)
        advance_mixed(island, from, to, book, trial);
    else
        advance_island(island, from, to, book, trial);
    each([&](auto b) { observed_memento_.restore_body(host, b); }, [&](auto s) { observed_memento_.restore_shaft(host, s); },
         [&](auto q) { observed_memento_.restore_quantities(host, q); });
}

}  // namespace plab::simulation
