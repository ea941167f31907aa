#include "simulation/contacts/contact_rules.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace plab::simulation
{
namespace
{

std::string type_name(const world::World& world, std::uint32_t component)
{
    return component == kNoIndex ? "nothing" : world.type_of(component)->info.name;
}

Error refused(const world::World& world, const Detector& d, std::string why)
{
    Error e;
    e.element = world.id_of(d.component) + " (" + type_name(world, d.component) + ")";
    e.reason = std::move(why);
    return e;
}

/// The role of a body in a detection: bodies in Between collide with one another and with those in Against.
enum class Side : std::uint8_t
{
    None,
    Between,
    Against,
};
constexpr std::size_t kSides = 3;

bool collide(std::size_t x, std::size_t y)
{
    const auto between = static_cast<std::size_t>(Side::Between), none = static_cast<std::size_t>(Side::None);
    return (x == between && y != none) || (y == between && x != none);
}

/// The side of each body, by host row.
std::vector<Side> sides_of(const world::World& world, const Detector& d)
{
    std::vector<Side> out(world.host().bodies.size(), Side::None);
    const auto enter = [&](const char* name, Side side)
    {
        const Role* role = world.tables()[d.table]->schema().find_role(name);
        if (!role || !role->many) return;
        for (const Ref body : (*role->many)[d.row])
            if (body.facet == Facet::Body && out[body.index] != Side::Between) out[body.index] = side;
    };
    enter("between", Side::Between), enter("against", Side::Against);
    return out;
}

/// Bodies with the same sides in two detections: the first two of them by id, for dynamic and for other bodies.
struct Alike
{
    std::array<std::uint32_t, 2> moving{kNoIndex, kNoIndex}, fixed{kNoIndex, kNoIndex};

    void add(std::uint32_t body, bool moves)
    {
        auto& list = moves ? moving : fixed;
        if (list[0] == kNoIndex)
            list[0] = body;
        else if (list[1] == kNoIndex)
            list[1] = body;
    }
};

/// A pair of bodies, at least one of them dynamic, that both detections handle; kNoIndex if there is none.
std::array<std::uint32_t, 2> shared_pair(const world::World& world, const std::vector<Side>& first, const std::vector<Side>& second)
{
    std::array<Alike, kSides * kSides> classes;
    const Bodies& bodies = world.host().bodies;
    for (const std::uint32_t component : world.in_id_order())
    {
        const world::Component& c = world.component(component);
        if (c.facet != Facet::Body || bodies.shapes[c.host_index].empty()) continue;
        const std::uint32_t body = c.host_index;
        classes[static_cast<std::size_t>(first[body]) * kSides + static_cast<std::size_t>(second[body])].add(body, bodies.dynamic(body));
    }
    for (std::size_t x = 0; x < classes.size(); ++x)
        for (std::size_t y = 0; y < classes.size(); ++y)
        {
            if (!collide(x / kSides, y / kSides) || !collide(x % kSides, y % kSides)) continue;
            const std::uint32_t a = classes[x].moving[0];
            if (a == kNoIndex) continue;
            const std::uint32_t other = classes[y].moving[x == y ? 1 : 0], b = other != kNoIndex ? other : classes[y].fixed[0];
            if (b != kNoIndex) return {a, b};
        }
    return {kNoIndex, kNoIndex};
}

using DetectorPair = std::pair<std::uint32_t, std::uint32_t>;

/// The pairs of detections that answer contacts of the same dynamic body: no others can handle the same pair of bodies. A scene may have
/// hundreds of detections, one for each heap, with nothing in common but the ground. In order.
std::vector<DetectorPair> with_a_body_in_common(const world::World& world, std::span<const Detector> detectors)
{
    std::vector<DetectorPair> entries;  // a dynamic body, and a detection that handles it
    for (std::uint32_t k = 0; k < detectors.size(); ++k)
    {
        const Detector& d = detectors[k];
        if (!d.responds && !d.by_rows && !d.by_force) continue;
        for (const char* name : {"between", "against"})
            if (const Role* role = world.tables()[d.table]->schema().find_role(name); role && role->many)
                for (const Ref body : (*role->many)[d.row])
                    if (body.facet == Facet::Body && world.host().bodies.dynamic(body.index)) entries.emplace_back(body.index, k);
    }
    const auto sort_once = [](std::vector<DetectorPair>& list)
    {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    sort_once(entries);
    std::vector<DetectorPair> out;
    for (auto first = entries.begin(); first != entries.end();)
    {
        const auto end = std::find_if(first, entries.end(), [&](const DetectorPair& e) { return e.first != first->first; });
        for (; first != end; ++first)
            for (auto other = first + 1; other != end; ++other) out.emplace_back(first->second, other->second);
    }
    sort_once(out);
    return out;
}

void refuse_shared_pairs(const world::World& world, std::span<const Detector> detectors, Errors& errors)
{
    std::vector<std::vector<Side>> sides(detectors.size());
    for (const auto& [i, k] : with_a_body_in_common(world, detectors))
    {
        for (const std::uint32_t d : {i, k})
            if (sides[d].empty()) sides[d] = sides_of(world, detectors[d]);
        const auto [a, b] = shared_pair(world, sides[i], sides[k]);
        if (a == kNoIndex) continue;
        const auto id = [&](std::uint32_t body) { return "'" + world.id_of(Ref{Facet::Body, body}) + "'"; };
        errors.push_back(refused(world, detectors[k],
                                 "the pair " + id(a) + ", " + id(b) + " is answered by '" + world.id_of(detectors[i].component) +
                                     "' as well: a pair may have only one detection. Remove it from `between` or `against` of one "
                                     "of them, or make one of them a sensor with Response/None"));
    }
}

}  // namespace

Errors check_contacts(const world::World& world, std::span<const Detector> detectors)
{
    Errors errors;
    for (const Detector& d : detectors)
    {
        if (d.resolution == kNoIndex) continue;
        const std::string resolution = type_name(world, d.resolution), response = type_name(world, d.response);
        if (d.speculates && !d.by_rows)
            errors.push_back(refused(world, d,
                                     resolution + " treats gaps that may close as contacts, which " + response +
                                         " cannot solve; it needs a response by rows, like Response/Rows"));
        if (world.type_of(d.resolution)->info.certifies && !d.gap)
            errors.push_back(refused(world, d,
                                     resolution + " finds contacts inside a step by measuring gaps, which " +
                                         type_name(world, d.component) + " cannot do; use Resolution/LocalBisection"));
    }
    refuse_shared_pairs(world, detectors, errors);
    return errors;
}

std::vector<std::string> unused_in_contacts(const world::World& world, std::span<const Detector> detectors)
{
    std::vector<std::string> out;
    for (const Detector& d : detectors)
    {
        if (d.resolution == kNoIndex || !d.by_force || !world.type_of(d.resolution)->info.locates) continue;
        out.push_back(world.id_of(d.component) + ": " + type_name(world, d.resolution) + " is not used, as contacts of " +
                      type_name(world, d.response) + " are forces: no time of impact is located");
    }
    return out;
}

}  // namespace plab::simulation
