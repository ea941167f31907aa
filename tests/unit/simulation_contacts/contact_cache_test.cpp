// Known pairs stay sorted with their keys, whatever is added, dropped or assigned, and are found wherever a search begins.
#include <algorithm>
#include <random>
#include <set>

#include "simulation/contacts/contacts.h"
#include "support/scene.h"

using namespace plab;
using namespace plab::simulation;
using test::Scene;

namespace
{

constexpr std::uint32_t kBodies = 12;

std::string bodies()
{
    std::string out = "<component id='s' type='Shape/Sphere' radius='0.1'/>";
    // The order of ids is not the order in which the bodies are stored.
    for (std::uint32_t i = 0; i < kBodies; ++i)
        out += "<component id='" + std::string(1, static_cast<char>('a' + i * 7 % kBodies)) +
               "' type='State/RigidBody' mass='1' shape='s' position='" + std::to_string(i) + " 0 0'/>";
    return out + "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/None' response='Response/Rows'/>";
}

struct Pairs
{
    Scene scene{bodies()};
    const world::World& world = scene.simulation().world();
    std::uint32_t detector = world.find("contact");
    ContactCache cache;

    static Ref body(std::uint32_t i) { return {Facet::Body, i}; }
    PairState& add(std::uint32_t a, std::uint32_t b)
    {
        bool added = false;
        return cache.get_or_add(detector, body(a), body(b), world, 0, added);
    }
    PairState bare(std::uint32_t a, std::uint32_t b) const
    {
        PairState p;
        p.detector = detector, p.a = body(a), p.b = body(b);
        return p;
    }
    /// Every fourth pair of bodies, each with as many contacts as `a` says, whose features tell the pair.
    void fill(std::uint32_t which)
    {
        for (std::uint32_t a = 0; a < kBodies; ++a)
            for (std::uint32_t b = a + 1; b < kBodies; ++b)
                if ((a + b) % 4 == which)
                    for (std::uint32_t k = 0; k <= a; ++k) cache.contact_of(add(a, b), a * 1000 + b * 20 + k);
    }
    void check() const
    {
        const auto& pairs = cache.pairs();
        REQUIRE(cache.keys().size() == pairs.size());
        for (std::size_t i = 0; i < pairs.size(); ++i)
        {
            CHECK(cache.keys()[i] == PairKey(world, pairs[i].detector, pairs[i].a, pairs[i].b));
            if (i > 0) CHECK(cache.keys()[i - 1] < cache.keys()[i]);
            for (std::uint32_t k = 0; k < pairs[i].count; ++k)
                CHECK(pairs[i].contacts[k].feature == pairs[i].a.index * 1000 + pairs[i].b.index * 20 + k);
            for (std::size_t from = 0; from <= pairs.size(); ++from)
            {
                std::size_t near = from;
                CHECK(cache.find(detector, pairs[i].a, pairs[i].b, world, near) == &pairs[i]);
                CHECK(near == i);
            }
        }
    }
};

}  // namespace

TEST_CASE("pairs that are added one by one are sorted and found from anywhere")
{
    Pairs p;
    p.fill(1);
    p.check();
    std::size_t near = 3;
    CHECK(std::as_const(p.cache).find(p.detector, Pairs::body(0), Pairs::body(2), p.world, near) == nullptr);
    CHECK(p.cache.find(p.detector, Pairs::body(0), Pairs::body(2), p.world) == nullptr);
}

TEST_CASE("a sorted list is merged among the pairs, which keep their points")
{
    Pairs p;
    p.fill(1);
    const std::size_t before = p.cache.pairs().size();
    std::vector<PairState> fresh;
    for (std::uint32_t a = 0; a < kBodies; ++a)
        for (std::uint32_t b = a + 1; b < kBodies; ++b)
            if ((a + b) % 4 != 1) fresh.push_back(p.bare(a, b));
    const auto key = [&](const PairState& x) { return PairKey(p.world, x.detector, x.a, x.b); };
    std::sort(fresh.begin(), fresh.end(), [&](const PairState& x, const PairState& y) { return key(x) < key(y); });
    p.cache.add_sorted(fresh, p.world);
    CHECK(p.cache.pairs().size() == before + fresh.size());
    p.check();
}

TEST_CASE("pairs that are dropped leave the others as they were, and their blocks serve pairs that come")
{
    Pairs p;
    p.fill(1), p.fill(2);
    std::set<const KnownContact*> blocks;
    for (const PairState& pair : p.cache.pairs()) blocks.insert(pair.contacts.begin());
    std::size_t asked = 0;
    const std::size_t before = p.cache.pairs().size();
    p.cache.drop_if([&](const PairState& pair) { return ++asked, (pair.a.index + pair.b.index) % 4 == 2; });
    CHECK(asked == before);
    p.check();
    p.cache.erase(p.cache.pairs()[2]);
    p.check();
    PairState& fresh = p.add(0, 2);
    p.cache.contact_of(fresh, 40);
    CHECK(blocks.count(fresh.contacts.begin()) == 1);
    p.check();
}

TEST_CASE("pairs are assigned in any order and copied into a cache that had others")
{
    Pairs p;
    p.fill(3);
    std::vector<PairState> pairs = std::as_const(p.cache).pairs();
    std::shuffle(pairs.begin(), pairs.end(), std::mt19937(1));
    p.cache.has_no_rest_depth();
    p.cache.assign(std::move(pairs), p.world);
    CHECK(p.cache.may_have_rest_depth());
    p.check();
    ContactCache copy = p.cache;
    for (const std::uint32_t which : {0u, 1u, 2u})
    {
        p.cache.drop_if([&](const PairState& pair) { return pair.a.index % 3 == which; });
        p.fill(which);
        copy.copy(p.cache);
        CHECK(copy.state_hash(p.world, 1) == p.cache.state_hash(p.world, 1));
        CHECK(copy.next_id() == p.cache.next_id());
    }
    std::swap(copy, p.cache);
    p.check();
}

TEST_CASE("a full manifold reuses its last point")
{
    Pairs p;
    PairState& pair = p.add(0, 1);
    for (std::uint32_t k = 0; k < PairState::kMostContacts + 3; ++k) p.cache.contact_of(pair, k);
    CHECK(pair.count == PairState::kMostContacts);
    CHECK(pair.contacts[PairState::kMostContacts - 1].feature == PairState::kMostContacts + 2);
    CHECK(pair.contacts[0].feature == 0);
}
