/// Which parts may collide within a step: boxes grown by how far each body can move, found by sweep and prune along one axis.
/// ODE's spaces are not used here: they hold boxes of the present poses, whereas the growth differs in every step.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bounds.h"

namespace plab::detection
{

class NearSweep
{
public:
    using Pair = std::pair<std::uint32_t, std::uint32_t>;

    void reset(std::size_t parts);
    /// Sets the grown box of a part, m; of a half-space normal . p <= offset, its growth, which may be infinite.
    void set_box(std::uint32_t part, const Vec3& lower, const Vec3& upper);
    void set_half_space(std::uint32_t part, const Vec3& normal, double offset, double growth);
    /// Overlapping pairs (i, j), i < j, in ascending order.
    const std::vector<Pair>& find_all();
    /// The overlapping pairs with at least one part in `few` (ascending).
    const std::vector<Pair>& find_of(std::span<const std::uint32_t> few);

private:
    struct HalfSpace
    {
        std::uint32_t part = 0;
        Vec3 normal;
        double offset = 0, growth = 0;
    };
    bool bounded(std::uint32_t part) const { return boxes_[part].lower.x <= boxes_[part].upper.x; }
    const HalfSpace* half_space(std::uint32_t part) const;

    std::vector<Box> boxes_;              // empty for parts that never collide, and for half-spaces
    std::vector<HalfSpace> half_spaces_;  // by part
    std::vector<std::uint32_t> order_;    // by lower.x; nearly sorted from call to call
    std::vector<std::uint8_t> asked_;     // by part
    std::vector<Pair> pairs_;
};

}  // namespace plab::detection
