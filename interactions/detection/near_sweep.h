/// Which parts may meet within a step: boxes grown by how far each body gets, swept along one axis. ODE is not asked: its
/// spaces hold boxes of the present poses, and the reach is another in every step.
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
    /// The grown box of a part, m. Of a half-space normal . p <= offset: its growth; may be infinite.
    void set_box(std::uint32_t part, const Vec3& lower, const Vec3& upper);
    void set_half_space(std::uint32_t part, const Vec3& normal, double offset, double growth);
    /// Pairs (i, j), i < j, that overlap, in ascending order.
    const std::vector<Pair>& find_all();
    /// Those of which one is in `few` (ascending).
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

    std::vector<Box> boxes_;              // empty for what never touches, and for half-spaces
    std::vector<HalfSpace> half_spaces_;  // by part
    std::vector<std::uint32_t> order_;    // of lower.x; nearly right from look to look
    std::vector<std::uint8_t> asked_;     // by part
    std::vector<Pair> pairs_;
};

}  // namespace plab::detection
