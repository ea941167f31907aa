// Contact points in packets: four pairs side by side give the same impulses, bit for bit, as the same pairs one after the other.
#include <algorithm>
#include <set>

#include "islands.h"
#include "managers/sequential.h"
#include "plab/random.h"

using namespace plab;
using namespace plab::managers;
using plab::test::IslandWorld;
using plab::test::problem_of;

namespace
{

/// Boxes at random places with faces between random pairs of 1 to 5 points, and with the ground: nothing that could lie so, but every
/// packet, colour and number of points occurs.
void add_tangle(IslandWorld& w, int boxes, int pairs, std::uint64_t seed)
{
    const auto between = [&](double low, double high) { return low + (high - low) * next_uniform(seed); };
    const std::uint32_t ground = w.add_box(0, {1, 1, 1}, {0, 0, -1});
    for (int i = 0; i < boxes; ++i)
        w.add_box(between(0.5, 2), {between(0.1, 0.6), between(0.1, 0.6), between(0.1, 0.6)},
                  {between(-1, 1), between(-1, 1), between(0, 1)});
    for (int i = 0; i < pairs; ++i)
    {
        const auto pick = [&] { return 1 + static_cast<std::uint32_t>(between(0, boxes - 1e-9)); };
        const std::uint32_t b = pick(), a = i % 7 == 0 ? ground : pick();
        if (a == b) continue;
        const Vec3 normal = normalized(Vec3{between(-1, 1), between(-1, 1), between(0.1, 1)});
        for (int k = 0; k <= i % 5; ++k)
            w.add_contact(std::min(a, b), std::max(a, b), {between(-1, 1), between(-1, 1), between(0, 1)}, normal, between(0, 1));
    }
    for (const std::uint32_t b : w.members) w.bodies.velocity[b] = {between(-1, 1), between(-1, 1), between(-2, 0)};
}

/// The contacts in the order in which a sweep over `list` visits them, pair by pair.
std::vector<std::size_t> sweep_order(const PacketList<4>& list)
{
    std::vector<std::vector<std::size_t>> contacts_of_lane(4 * list.points().size());
    for (std::size_t i = 0; i < list.size(); ++i)
        contacts_of_lane[4 * list.place(i).point + static_cast<std::size_t>(list.place(i).lane)] = {i};
    std::vector<std::size_t> out;
    for (const Packet<4>& packet : list.packets())
        for (std::size_t l = 0; l < 4; ++l)
            for (std::uint32_t k = packet.first; k < packet.first + packet.count; ++k)
                for (const std::size_t i : contacts_of_lane[4 * k + l]) out.push_back(i);
    return out;
}

}  // namespace

TEST_CASE("four pairs at a time give the bits of one pair after the other")
{
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u})
    {
        CAPTURE(seed);
        IslandWorld w;
        add_tangle(w, 40, 200, seed);
        Problem wide = problem_of(w);
        wide.fours.load(wide.points, wide.movers.size());
        const std::vector<std::size_t> order = sweep_order(wide.fours);
        REQUIRE(order.size() == wide.points.size());

        // The same contacts, listed in the order of the colours.
        std::vector<Contact> sorted;
        for (const std::size_t i : order) sorted.push_back(w.contacts[i]);
        w.contacts = sorted;
        Problem narrow = problem_of(w);
        narrow.single.load(narrow.points, narrow.movers.size());
        set_mobility(wide.fours, std::span<const Mover>(wide.movers));
        set_mobility(narrow.single, std::span<const Mover>(narrow.movers));
        const Sweeping how{7, 1e-9, 1.1};
        CHECK(sweep(wide, wide.fours, how).change == sweep(narrow, narrow.single, how).change);
        for (std::size_t k = 0; k < order.size(); ++k) CHECK(wide.fours.impulse(order[k]) == narrow.single.impulse(k));
        for (std::size_t i = 0; i < wide.movers.size(); ++i)
        {
            CHECK(Vec3(wide.movers[i].v) == Vec3(narrow.movers[i].v));
            CHECK(Vec3(wide.movers[i].w) == Vec3(narrow.movers[i].w));
        }
        double pressing = 0;
        for (std::size_t i = 0; i < wide.fours.size(); ++i) pressing += wide.fours.impulse(i).z > 0 ? 1 : 0;
        CHECK(pressing > 0.2 * static_cast<double>(order.size()));
    }
}

TEST_CASE("no packet holds a mover twice, and each contact is in one packet, however many pairs a mover has")
{
    // One box under 150 others: more pairs than there are colours.
    IslandWorld w;
    const std::uint32_t table = w.add_box(10, {5, 5, 0.1}, {0, 0, 0});
    for (int i = 0; i < 150; ++i)
    {
        const Vec3 at{0.05 * i, 0, 0.6};
        w.add_face(table, w.add_box(1, {0.5, 0.5, 0.5}, at), {at.x, at.y, 0.1}, 0.5, 0.5, 0.3);
    }
    Problem p = problem_of(w);
    p.fours.load(p.points, p.movers.size());
    std::set<std::pair<std::uint32_t, int>> places;
    for (std::size_t i = 0; i < p.fours.size(); ++i) places.insert({p.fours.place(i).point, p.fours.place(i).lane});
    CHECK(places.size() == w.contacts.size());
    std::size_t lanes = 0;
    for (const Packet<4>& packet : p.fours.packets())
    {
        std::vector<std::uint32_t> movers;
        for (const auto& side : {packet.a, packet.b})
            for (const std::uint32_t m : side)
                if (m != kNoIndex) movers.push_back(m);
        std::sort(movers.begin(), movers.end());
        CHECK(std::adjacent_find(movers.begin(), movers.end()) == movers.end());
        lanes += movers.size();
    }
    CHECK(lanes == 2 * 150);
    // Falls on the table: all boxes press it, and momentum is kept.
    w.kick({0, 0, -1});
    w.bodies.velocity[table] = {};
    p = problem_of(w);
    (void)sweep(p, {20});
    p.apply_impulses();
    double momentum = 0;
    for (std::size_t i = 0; i < p.movers.size(); ++i) momentum += p.anchors[i].mass * p.movers[i].v.z;
    CHECK(momentum == doctest::Approx(-150.0).epsilon(1e-12));
    CHECK(p.points.front().impulse.z > 0);
}

TEST_CASE("the sums of the impulses by velocities are those of the impulses")
{
    IslandWorld w;
    add_tangle(w, 30, 150, 9);
    Problem p = problem_of(w);
    (void)sweep(p, {20, 1e-9});
    p.sum_by_velocities();
    const std::vector<Momentum> by_velocities = p.sums;
    p.apply_impulses();
    double largest = 0;
    for (const Momentum& m : p.sums) largest = std::max(largest, length(m.push));
    CHECK(largest > 0.1);
    for (std::size_t i = 0; i < p.sums.size(); ++i)
    {
        CHECK(length(p.sums[i].push - by_velocities[i].push) < 1e-13 * largest);
        CHECK(length(p.sums[i].turn - by_velocities[i].turn) < 1e-13 * largest);
    }
}

TEST_CASE("contacts between two bodies along two normals are two pairs, of different colours")
{
    IslandWorld w;
    for (int i = 0; i < 12; ++i) w.add_box(1, {0.5, 0.5, 0.5}, {1.0 * i, 0, 0});
    for (std::uint32_t i = 0; i < 12; i += 2)
    {
        for (int k = 0; k < 3; ++k) w.add_contact(i, i + 1, {i + 0.5, 0.1 * k, 0}, {1, 0, 0}, 0.5);
        for (int k = 0; k < 2; ++k) w.add_contact(i, i + 1, {i + 0.5, 0.1 * k, 0.5}, normalized(Vec3{1, 0, 1}), 0.5);
    }
    Problem p = problem_of(w);
    p.fours.load(p.points, p.movers.size());
    std::vector<Vec3> normals;
    for (std::size_t i = 0; i < p.fours.size(); ++i)
    {
        const auto place = p.fours.place(i);
        CHECK(lane(p.fours.packets()[place.packet].n, place.lane) == p.points[i].n);
        CHECK(place.point >= p.fours.packets()[place.packet].first);
    }
    CHECK(p.fours.packets().size() == 4);  // two colours of six pairs each
}

TEST_CASE("pairs that are arranged already give the bits of a list that is new")
{
    IslandWorld w;
    add_tangle(w, 40, 200, 5);
    Problem kept = problem_of(w);
    const auto sweep_with = [](Problem& p)
    {
        p.fours.load(p.points, p.movers.size());
        set_mobility(p.fours, std::span<const Mover>(p.movers));
        (void)sweep(p, p.fours, {3});
        p.fours.store(p.points);
    };
    sweep_with(kept);
    const auto compare = [&]
    {
        Problem fresh = problem_of(w), again = problem_of(w);
        again.fours = kept.fours;  // with what was arranged and computed before
        sweep_with(again), sweep_with(fresh);
        double pressing = 0;
        for (std::size_t i = 0; i < w.contacts.size(); ++i)
        {
            CHECK(again.points[i].impulse == fresh.points[i].impulse);
            pressing += fresh.points[i].impulse.z > 0 ? 1 : 0;
        }
        CHECK(pressing > 0);
    };
    // The same pairs at other places.
    for (Contact& c : w.contacts) c.point.x += 0.01, c.friction *= 0.5;
    compare();
    // The same number of contacts between other bodies.
    for (Contact& c : w.contacts)
        if (c.a.index == 0) c.b.index = c.b.index % 39 + 1;
    compare();
    // A pair less.
    w.contacts.resize(w.contacts.size() - 5);
    compare();
}

TEST_CASE("depths follow a move, and mobilities the bodies that have turned by much")
{
    IslandWorld w;
    add_tangle(w, 40, 200, 6);
    Problem p = problem_of(w);
    p.fours.load(p.points, p.movers.size()), p.single.load(p.points, p.movers.size());
    set_mobility(p.fours, std::span<const Mover>(p.movers)), set_mobility(p.single, std::span<const Mover>(p.movers));
    std::vector<SoftPoint<4>> wide(p.fours.points().size());
    std::vector<SoftPoint<1>> narrow(p.single.points().size());
    std::vector<MoverSpeeds> speeds;
    for (std::size_t i = 0; i < p.movers.size(); ++i) speeds.push_back({p.movers[i].v, Vec3{0.1 * static_cast<double>(i), 1, -0.3}});
    const std::vector<Mover> before = p.movers;
    for (std::size_t i = 0; i < p.movers.size(); ++i)
        p.movers[i].inverse_inertia = p.movers[i].inverse_inertia * 2.0, p.movers[i].turned = i % 3 == 0;
    const double h = 0.01;
    const Moved moved{speeds, h, 1 / h};
    follow_move(p.fours, std::span<const Mover>(p.movers), moved, std::span<SoftPoint<4>>(wide));
    follow_move(p.single, std::span<const Mover>(p.movers), moved, std::span<SoftPoint<1>>(narrow));
    const auto velocity_at = [&](std::uint32_t mover, const Vec3& r)
    { return mover == kNoIndex ? Vec3{} : speeds[mover].v + cross(speeds[mover].w, r); };
    std::size_t renewed = 0;
    for (std::size_t i = 0; i < p.points.size(); ++i)
    {
        const Point& at = p.points[i];
        const double depth = -h * dot(at.n, velocity_at(at.b, at.r_b) - velocity_at(at.a, at.r_a));
        const auto place = p.fours.place(i);
        const auto alone = p.single.place(i);
        CHECK(lane(wide[place.point].depth, place.lane) == doctest::Approx(depth).epsilon(1e-12));
        CHECK(lane(wide[place.point].depth, place.lane) == narrow[alone.point].depth);
        CHECK(p.single.points()[alone.point].least == doctest::Approx(std::min(depth, 0.0) / h));
        const auto turned = [&](std::uint32_t m) { return m != kNoIndex && p.movers[m].turned; };
        const double mass = (at.a == kNoIndex ? 0.0 : before[at.a].inverse_mass) + (at.b == kNoIndex ? 0.0 : before[at.b].inverse_mass);
        const double K = at.K(2, 2), twice = 2 * (K - mass) + mass;
        const bool is_new = turned(at.a) || turned(at.b);
        CHECK(p.single.points()[alone.point].inverse_normal == doctest::Approx(1 / (is_new ? twice : K)).epsilon(1e-12));
        renewed += is_new ? 1 : 0;
    }
    CHECK(renewed > 0.2 * static_cast<double>(p.points.size()));
    CHECK(renewed < 0.8 * static_cast<double>(p.points.size()));
}
