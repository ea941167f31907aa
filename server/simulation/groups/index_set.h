/// A set of small numbers, such as groups or bodies of a scene. Adding and asking take constant time, and clearing takes as long as there
/// are members, so that what an impact touches can be marked without going through the whole scene.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace plab::simulation
{

class IndexSet
{
public:
    /// Empties the set; members must be below `size` from now on. Costs nothing but the members where the size stays the same.
    void begin(std::size_t size)
    {
        clear();
        if (flags_.size() != size) flags_.assign(size, 0);
    }
    /// False if it is a member already.
    bool add(std::uint32_t i)
    {
        if (flags_[i] != 0) return false;
        flags_[i] = 1;
        members_.push_back(i);
        return true;
    }
    bool has(std::uint32_t i) const { return flags_[i] != 0; }
    void clear()
    {
        for (const std::uint32_t i : members_) flags_[i] = 0;
        members_.clear();
    }
    void sort() { std::sort(members_.begin(), members_.end()); }
    /// By number: 1 for members, otherwise 0.
    const std::vector<std::uint8_t>& flags() const { return flags_; }
    /// In the order in which they were added, or ascending after sort().
    const std::vector<std::uint32_t>& members() const { return members_; }

private:
    std::vector<std::uint8_t> flags_;
    std::vector<std::uint32_t> members_;
};

}  // namespace plab::simulation
