// What rests on what: the closure over persistent pairs is the same by the index of pairs and by passes over all of them.
#include <algorithm>
#include <random>
#include <set>

#include "simulation/contacts/resting_pairs.h"
#include "support/scene.h"

using namespace plab;
using namespace plab::simulation;
using test::Scene;

namespace
{

constexpr std::uint32_t kMany = 40;

std::string crowd()
{
    std::string out = "<component id='s' type='Shape/Sphere' radius='0.1'/><component id='g' type='State/Static' shape='s'/>";
    for (std::uint32_t i = 0; i < kMany; ++i)
        out += "<component id='b" + std::to_string(i) + "' type='State/RigidBody' mass='1' shape='s' position='" + std::to_string(i + 1) +
               " 0 0'/>";
    return out + "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/None' response='Response/Rows'/>";
}

struct Crowd
{
    Scene scene{crowd()};
    const world::World& world = scene.simulation().world();
    std::uint32_t detector = world.find("contact");
    ContactCache cache;
    Groups groups;
    std::uint64_t visited = 0;
    RestingPairs resting{world, groups, cache, visited};

    Crowd()
    {
        const Bodies& bodies = world.host().bodies;
        for (std::uint32_t b = 0; b < bodies.size(); ++b)
            groups.group_of_body.push_back(bodies.dynamic(b) ? static_cast<std::uint32_t>(groups.all.size()) : kNoIndex),
                groups.all.resize(groups.all.size() + (bodies.dynamic(b) ? 1 : 0));
    }
    void join(std::uint32_t a, std::uint32_t b, bool rests)
    {
        bool added = false;
        cache.get_or_add(detector, {Facet::Body, std::min(a, b)}, {Facet::Body, std::max(a, b)}, world, 0, added).resting = rests;
    }
    /// Groups reached from `from`, step by step, and the places of their pairs.
    std::set<std::uint32_t> closure(std::set<std::uint32_t> from) const
    {
        for (std::size_t before = 0; before != from.size();)
        {
            before = from.size();
            for (const PairState& p : cache.pairs())
            {
                const std::uint32_t a = groups.of(p.a), b = groups.of(p.b);
                if (p.resting && a != kNoIndex && b != kNoIndex && (from.count(a) || from.count(b))) from.insert(a), from.insert(b);
            }
        }
        return from;
    }
    void check(const std::set<std::uint32_t>& from)
    {
        IndexSet reached;
        reached.begin(groups.all.size());
        for (const std::uint32_t g : from) reached.add(g);
        std::vector<std::uint32_t> places, wanted;
        resting.close_over(reached, places);
        const std::set<std::uint32_t> all = closure(from);
        CHECK(std::set<std::uint32_t>(reached.members().begin(), reached.members().end()) == all);
        CHECK(reached.members().size() == all.size());
        for (std::uint32_t i = 0; i < cache.pairs().size(); ++i)
            if (const PairState& p = std::as_const(cache).pairs()[i]; p.resting && (all.count(groups.of(p.a)) || all.count(groups.of(p.b))))
                wanted.push_back(i);
        CHECK(places == wanted);
    }
};

}  // namespace

TEST_CASE("closures over persistent pairs, from few groups and from most of them")
{
    std::mt19937 random(3);
    const auto below = [&](std::uint32_t size) { return static_cast<std::uint32_t>(random() % size); };
    for (const std::uint32_t pairs : {5u, 20u, 40u, 90u})
    {
        Crowd crowd;
        const auto size = static_cast<std::uint32_t>(crowd.groups.group_of_body.size());
        for (std::uint32_t k = 0; k < pairs; ++k)
            if (const std::uint32_t a = below(size), b = below(size); a != b) crowd.join(a, b, k % 5 != 0);
        for (const std::uint32_t start : {1u, 3u, 12u, 25u, kMany})
        {
            std::set<std::uint32_t> from;
            while (from.size() < start) from.insert(below(kMany));
            crowd.check(from);
        }
    }
}

TEST_CASE("a chain that each pass follows for one link only is followed to its end")
{
    Crowd crowd;
    // Pairs are visited in the order of ids; from the last one on, each pass reaches one more.
    std::vector<std::uint32_t> bodies;
    for (std::uint32_t b = 0; b < crowd.groups.group_of_body.size(); ++b)
        if (crowd.groups.group_of_body[b] != kNoIndex) bodies.push_back(b);
    std::sort(bodies.begin(), bodies.end(),
              [&](std::uint32_t x, std::uint32_t y) {
                  return crowd.world.rank(Ref{Facet::Body, x}) > crowd.world.rank(Ref{Facet::Body, y});
              });
    for (std::size_t i = 0; i + 1 < bodies.size(); ++i) crowd.join(bodies[i], bodies[i + 1], true);
    std::set<std::uint32_t> from;
    for (std::uint32_t k = 0; k <= kMany / 4; ++k) from.insert(crowd.groups.group_of_body[bodies[k]]);
    crowd.check(from);
}
