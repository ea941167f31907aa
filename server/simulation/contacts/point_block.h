/// Where the contact points of a pair are kept. Most pairs have one to four points and a few have 16, so each pair has a block of its own
/// with room for 1, 2, 4, 8 or 16.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "plab/vector.h"

namespace plab::simulation
{

struct KnownContact
{
    std::uint32_t feature = 0;
    std::uint64_t id = 0;
    Vec3 impulse;           ///< N s per step on b, for warm starts
    Vec3 start_impulse;     ///< N s: `impulse` when the advance of the present piece of the step began, with the first of its parts
    Vec3 stretch;           ///< m, as in Contact: state of force contacts
    double rest_depth = 0;  ///< m
    double preload = 0;     ///< N

    /// The impulse that an advance starts from, and each of its parts if it has some (HardContacts). A trial repeats an advance that has
    /// replaced `impulse` by its result, and must give the same motion: otherwise events are located on another path, and the work of that
    /// advance cannot be taken back. `begins`: whether this is the first part of an advance that is no trial.
    const Vec3& warm_start(bool begins)
    {
        if (begins) start_impulse = impulse;
        return start_impulse;
    }
};

/// Room for the points of one pair. It does not know how many of them are in use.
class PointBlock
{
public:
    static constexpr std::uint32_t kMost = 16;

    PointBlock() = default;
    PointBlock(PointBlock&& other) noexcept { swap(other); }
    /// Swaps, so that moving pairs about in a list loses no block.
    PointBlock& operator=(PointBlock&& other) noexcept
    {
        swap(other);
        return *this;
    }

    KnownContact& operator[](std::size_t i) { return points_[i]; }
    const KnownContact& operator[](std::size_t i) const { return points_[i]; }
    KnownContact* begin() { return points_.get(); }
    const KnownContact* begin() const { return points_.get(); }
    std::uint32_t capacity() const { return capacity_; }
    /// Makes room for `room` points, at most kMost. Keeps the first `used`.
    void reserve(std::uint32_t room, std::uint32_t used);
    void swap(PointBlock& other) noexcept { points_.swap(other.points_), std::swap(capacity_, other.capacity_); }

private:
    std::unique_ptr<KnownContact[]> points_;
    std::uint32_t capacity_ = 0;
};

/// Blocks that are not in use, by size. A copy starts empty, and assignment keeps the blocks that are there.
class PointPool
{
public:
    PointPool() = default;
    PointPool(const PointPool&) {}
    PointPool& operator=(const PointPool&) { return *this; }

    /// As PointBlock::reserve, with a block of the pool if it has one. The former block comes into the pool.
    void reserve(PointBlock& block, std::uint32_t room, std::uint32_t used);
    /// Takes the block; what remains has no room.
    void recycle(PointBlock& block);

private:
    std::array<std::vector<PointBlock>, 5> free_;  ///< with room for 1, 2, 4, 8, 16
};

}  // namespace plab::simulation
