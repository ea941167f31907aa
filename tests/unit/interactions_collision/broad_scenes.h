/// Random scenes of boxes and half-spaces, and the broad phase compared with a search by brute force.
#pragma once

#include <string>

#include "bodies.h"
#include "detection/broad.h"

namespace plab::test
{

using namespace plab::detection;

inline constexpr const char* kSearches[] = {"tree", "sweep_and_prune", "quadtree", "simple"};

/// Axis-aligned boxes, some static, some only against the others, and half-spaces in addition.
struct Crowd
{
    struct Part
    {
        std::size_t collider = 0;
        Membership membership;
        Pose pose;
        Vec3 half;  // m; unused for a half-space
        bool half_space = false;
    };
    std::uint64_t seed = 0;
    std::vector<Collider> colliders;
    std::vector<Part> parts;

    void add(const Vec3& half, const Vec3& at)
    {
        Geometry g;
        g.kind = GeometryKind::Box, g.size = half;
        colliders.emplace_back(g);
        const Membership m{next_uniform(seed) < 0.9, next_uniform(seed) < 0.9};
        parts.push_back({colliders.size() - 1, m, {at, {}}, half, false});
    }
    void add_ground(double height)
    {
        Geometry g;
        g.kind = GeometryKind::Plane;
        colliders.emplace_back(g);
        parts.push_back({colliders.size() - 1, {true, false}, {{0, 0, height}, {}}, {}, true});
    }
    /// Equal cubes in rough rows, as they lie in a pile.
    static Crowd pile(std::uint64_t seed, std::size_t count)
    {
        Crowd c{seed, {}, {}};
        const double h = 0.01 + next_uniform(c.seed), n = std::ceil(std::cbrt(static_cast<double>(count)));
        for (std::size_t i = 0; i < count; ++i)
        {
            const double x = std::fmod(static_cast<double>(i), n), y = std::fmod(std::floor(static_cast<double>(i) / n), n);
            const Vec3 cell{x, y, std::floor(static_cast<double>(i) / (n * n))};
            c.add({h, h, h}, (cell * 2.0 + random_vector(c.seed, 0.2)) * h);
        }
        c.add_ground(0);
        return c;
    }
    /// Sizes over three decades, anywhere.
    static Crowd mixture(std::uint64_t seed, std::size_t count)
    {
        Crowd c{seed, {}, {}};
        const double room = std::cbrt(static_cast<double>(count));
        for (std::size_t i = 0; i < count; ++i)
        {
            const double size = std::pow(10.0, -2.5 + 3 * next_uniform(c.seed));
            c.add({size * (0.1 + next_uniform(c.seed)), size, size * (0.1 + next_uniform(c.seed))}, random_vector(c.seed, room));
        }
        if (next_uniform(c.seed) < 0.5) c.add_ground(-room), c.add_ground(0.1);
        return c;
    }
    void move(double share)
    {
        for (Part& p : parts)
            if (next_uniform(seed) < share) p.pose.p += random_vector(seed, 0.5);
    }

    double gap(const Part& a, const Part& b) const
    {
        if (a.half_space) return b.pose.p.z - b.half.z - a.pose.p.z;
        if (b.half_space) return gap(b, a);
        double widest = -HUGE_VAL;
        for (int k = 0; k < 3; ++k) widest = std::max(widest, std::fabs(a.pose.p[k] - b.pose.p[k]) - a.half[k] - b.half[k]);
        return widest;
    }
    /// Pairs that overlap, and pairs that may be found because rounding and margins cannot tell.
    void brute_force(double margin, std::vector<PartPair>& must, std::vector<PartPair>& may) const
    {
        for (std::uint32_t i = 0; i < parts.size(); ++i)
            for (std::uint32_t j = i + 1; j < parts.size(); ++j)
            {
                if (!may_meet(parts[i].membership, parts[j].membership) || (parts[i].half_space && parts[j].half_space)) continue;
                const double g = gap(parts[i], parts[j]), size = length(parts[i].half) + length(parts[j].half);
                if (g <= margin) must.emplace_back(i, j);
                if (g <= margin + 1e-5 * size) may.emplace_back(i, j);
            }
    }
};

inline void compare(Crowd crowd, std::span<const char* const> searches)
{
    std::vector<BroadPhase> broad(searches.size());
    for (std::size_t s = 0; s < broad.size(); ++s)
    {
        broad[s].reset(searches[s], crowd.parts.size());
        for (std::uint32_t i = 0; i < crowd.parts.size(); ++i)
            broad[s].add(crowd.colliders[crowd.parts[i].collider], i, crowd.parts[i].membership);
    }
    for (const double share : {0.0, 0.02, 0.1, 1.0, 0.02})
    {
        crowd.move(share);
        const double margin = share == 0.1 ? 0.05 : 0;
        std::vector<PartPair> must, may;
        crowd.brute_force(margin, must, may);
        for (std::size_t s = 0; s < broad.size(); ++s)
        {
            for (std::uint32_t i = 0; i < crowd.parts.size(); ++i)
                broad[s].move(i, crowd.colliders[crowd.parts[i].collider], crowd.parts[i].pose);
            const std::vector<PartPair>& found = broad[s].find_pairs(margin);
            CHECK_MESSAGE(std::includes(found.begin(), found.end(), must.begin(), must.end()), std::string(searches[s]), " lost a pair of ",
                          crowd.parts.size(), " at share ", share);
            CHECK_MESSAGE(std::includes(may.begin(), may.end(), found.begin(), found.end()), std::string(searches[s]), " invented a pair");
        }
    }
}

inline void compare_scenes(int scenes, std::size_t largest)
{
    std::uint64_t seed = 41;
    for (int i = 0; i < scenes; ++i)
    {
        const double ratio = static_cast<double>(largest) / 10;
        const auto count = static_cast<std::size_t>(10 * std::pow(ratio, next_uniform(seed)));
        const std::uint64_t of_scene = next_random(seed);
        // With many boxes, ODE's space that tests all pairs, the last one, is left out: brute force does that already.
        const bool many = count > 1000;
        compare(i % 2 == 0 ? Crowd::pile(of_scene, count) : Crowd::mixture(of_scene, count), std::span(kSearches).first(many ? 3 : 4));
    }
}

}  // namespace plab::test
