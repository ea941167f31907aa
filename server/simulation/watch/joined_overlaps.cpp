#include "simulation/watch/joined_overlaps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plab::simulation
{
namespace
{

/// Of the half thickness of the thinner body: less is a joint that was written with few digits.
constexpr double kOverlaps = 0.02;

struct Joined
{
    std::uint32_t a = 0, b = 0;  ///< bodies, a < b
    std::uint32_t joint = kNoIndex;
};

/// The bodies that joints connect, in order.
std::vector<Joined> joined_bodies(const world::World& world)
{
    std::vector<Joined> out;
    for (const std::uint32_t i : world.in_id_order())
    {
        const model::ComponentType* type = world.type_of(i);
        if (!type || type->info.family != "Constraint/Joint") continue;
        std::vector<std::uint32_t> bodies;
        for (const Role& role : world.table_of(i).schema().roles())
            world.for_each_participant(i, role,
                                       [&](Ref r)
                                       {
                                           if (r.facet == Facet::Body) bodies.push_back(r.index);
                                       });
        if (bodies.size() == 2) out.push_back({std::min(bodies[0], bodies[1]), std::max(bodies[0], bodies[1]), i});
    }
    std::stable_sort(out.begin(), out.end(), [](const Joined& x, const Joined& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
    return out;
}

std::uint32_t joint_of(const std::vector<Joined>& joined, const Contact& c)
{
    const std::pair key{std::min(c.a.index, c.b.index), std::max(c.a.index, c.b.index)};
    const auto found =
        std::lower_bound(joined.begin(), joined.end(), key,
                         [](const Joined& x, const std::pair<std::uint32_t, std::uint32_t>& k) { return std::pair(x.a, x.b) < k; });
    return found != joined.end() && found->a == key.first && found->b == key.second ? found->joint : kNoIndex;
}

/// The joined pairs of a detection that overlap.
struct Found
{
    const Contact* deepest = nullptr;
    std::uint32_t joint = kNoIndex;
    std::size_t pairs = 0;
    std::pair<std::uint32_t, std::uint32_t> last{kNoIndex, kNoIndex};  ///< contacts of one pair follow one another
};

Event warning(const RunView& s, const Detector& d, const Found& found)
{
    const world::World& world = s.world;
    const Contact& c = *found.deepest;
    const std::string a = world.id_of(c.a), b = world.id_of(c.b);
    Event e;
    e.tick = s.tick, e.time = s.time, e.kind = "contact.joined", e.severity = Severity::Warning;
    e.component = d.component, e.a = c.a, e.b = c.b, e.values = {c.depth};
    e.message = a + " and " + b + " collide and overlap, while " + world.id_of(found.joint) +
                " holds them there; if that is meant, <component type=\"Collision/Exclude\" a=\"" + a + "\" b=\"" + b +
                "\"/> keeps them from colliding";
    if (const std::size_t more = found.pairs - 1; more > 0)
        e.message += " (" + std::to_string(more) + (more > 1 ? " more pairs" : " more pair") + " of this kind)";
    return e;
}

}  // namespace

void report_joined_overlaps(const RunView& s, std::span<const double> half_thickness, std::vector<Event>& events)
{
    const std::span<const Detector> detectors = s.stepper.detectors();
    std::vector<Joined> joined;
    std::vector<Found> found(detectors.size());
    for (const FoundContact& f : s.stepper.touching())
    {
        const Detector& d = detectors[f.detector];
        const Contact& c = f.contact;
        if (!d.by_force && !d.responds && !d.by_rows) continue;  // a sensor moves nothing
        const double one = half_thickness[c.a.index], two = half_thickness[c.b.index];
        if (!(c.depth > kOverlaps * std::min(one > 0 ? one : two, two > 0 ? two : one))) continue;
        if (joined.empty()) joined = joined_bodies(s.world);
        if (joined.empty()) return;
        const std::uint32_t joint = joint_of(joined, c);
        if (joint == kNoIndex) continue;
        Found& own = found[f.detector];
        const std::pair pair{c.a.index, c.b.index};
        if (pair != own.last) ++own.pairs, own.last = pair;
        if (!own.deepest || c.depth > own.deepest->depth) own.deepest = &c, own.joint = joint;
    }
    for (std::size_t k = 0; k < found.size(); ++k)
        if (found[k].deepest) events.push_back(warning(s, detectors[k], found[k]));
}

}  // namespace plab::simulation
