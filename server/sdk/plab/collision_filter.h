/// Which bodies and shapes do not collide although a detection names them. The host empties it before Phase::Connect, in which components
/// add to it; detections read it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "plab/ref.h"

namespace plab
{

class CollisionFilter
{
public:
    void clear() { *this = {}; }
    /// No two of these bodies and shapes collide. A body stands for all its shapes.
    void exclude_within(std::span<const Ref> members) { add(members, kWithin), ++exclusions_; }
    /// None of `a` collides with one of `b`.
    void exclude_between(std::span<const Ref> a, std::span<const Ref> b) { add(a, kFirst), add(b, kSecond), ++exclusions_; }

    bool excludes_bodies(std::uint32_t a, std::uint32_t b) const { return meet(of(of_body_, a), of(of_body_, b)); }
    /// Whether shapes are excluded one by one: then excludes_shapes() must be asked.
    bool has_shapes() const { return !of_shape_.empty(); }
    /// Two shapes, and the bodies that they are on, for which excludes_bodies() is false.
    bool excludes_shapes(std::uint32_t body_a, std::uint32_t shape_a, std::uint32_t body_b, std::uint32_t shape_b) const
    {
        const Marks a = of(of_shape_, shape_a), b = of(of_shape_, shape_b);
        return meet(a, b) || meet(a, of(of_body_, body_b)) || meet(of(of_body_, body_a), b);
    }
    /// The exclusions that name a body, as numbers that stay the same until a component is added or removed.
    std::span<const std::uint32_t> of_body(std::uint32_t body) const { return of(of_body_, body); }
    std::span<const std::uint32_t> of_shape(std::uint32_t shape) const { return of(of_shape_, shape); }

private:
    enum Side : std::uint32_t
    {
        kWithin = 0,
        kFirst = 1,
        kSecond = 2,
    };
    /// 4 times the number of an exclusion, plus the side; ascending.
    using Marks = std::span<const std::uint32_t>;
    using Table = std::vector<std::vector<std::uint32_t>>;  ///< by host index, as far as there are marks

    static Marks of(const Table& table, std::uint32_t i) { return i < table.size() ? Marks(table[i]) : Marks(); }
    void add(std::span<const Ref> members, Side side)
    {
        for (const Ref r : members)
        {
            Table& table = r.facet == Facet::Shape ? of_shape_ : of_body_;
            if (r.index >= table.size()) table.resize(r.index + 1);
            table[r.index].push_back(4 * exclusions_ + side);
        }
    }
    /// The mark that may not meet this one.
    static std::uint32_t partner(std::uint32_t mark)
    {
        const std::uint32_t side = mark & 3u;
        return side == kWithin ? mark : mark - side + (side == kFirst ? kSecond : kFirst);
    }
    /// Costs the shorter list times the logarithm of the longer one: a base may have thousands of neighbours.
    static bool meet(Marks a, Marks b)
    {
        if (a.size() > b.size()) std::swap(a, b);
        return std::ranges::any_of(a, [&](std::uint32_t mark) { return std::ranges::binary_search(b, partner(mark)); });
    }

    std::uint32_t exclusions_ = 0;
    Table of_body_, of_shape_;
};

}  // namespace plab
