#include "simulation/contacts/point_block.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace plab::simulation
{

void PointBlock::reserve(std::uint32_t room, std::uint32_t used)
{
    if (room <= capacity_) return;
    const std::uint32_t capacity = std::bit_ceil(room);
    auto larger = std::make_unique<KnownContact[]>(capacity);
    std::copy_n(points_.get(), used, larger.get());
    points_ = std::move(larger), capacity_ = capacity;
}

void PointPool::reserve(PointBlock& block, std::uint32_t room, std::uint32_t used)
{
    if (room <= block.capacity()) return;
    PointBlock larger;
    // A larger block than needed serves as well.
    for (std::size_t k = static_cast<std::size_t>(std::countr_zero(std::bit_ceil(room))); k < free_.size(); ++k)
    {
        if (free_[k].empty()) continue;
        larger = std::move(free_[k].back());
        free_[k].pop_back();
        break;
    }
    larger.reserve(room, 0);
    std::copy_n(block.begin(), used, larger.begin());
    block.swap(larger);
    recycle(larger);
}

void PointPool::recycle(PointBlock& block)
{
    if (block.capacity() == 0) return;
    free_[static_cast<std::size_t>(std::countr_zero(block.capacity()))].push_back(std::move(block));
}

}  // namespace plab::simulation
