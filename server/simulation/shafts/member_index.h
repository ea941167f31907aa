/// Numbers the members of a subset of rows: 0, 1, 2 ... in the order in which they are added. Memory grows with the number of members,
/// not with the size of the table, so ten thousand small systems of a large scene can each have their own.
///
/// Open addressing with linear probing (Knuth, The Art of Computer Programming 3, 6.4, Algorithm L) after Fibonacci hashing (ibid., p.
/// 518).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "plab/ref.h"

namespace plab::simulation
{

class MemberIndex
{
public:
    /// Keeps its memory.
    void clear()
    {
        for (Place& place : places_) place = {};
        members_.clear();
        consecutive_ = 0;
    }
    /// The number of a row; kNoIndex if it is no member. Rows that follow one another and were added first, in that order, need no search.
    std::uint32_t find(std::uint32_t row) const
    {
        const std::uint32_t i = row - first_;
        return i < consecutive_ ? i : search(row);
    }
    /// The number of a row, which becomes a member if it is none.
    std::uint32_t add(std::uint32_t row)
    {
        const std::uint32_t known = find(row);
        if (known != kNoIndex) return known;
        if (members_.empty()) first_ = row;
        if (consecutive_ == members_.size() && row - first_ == consecutive_) ++consecutive_;
        members_.push_back(row);
        if (2 * members_.size() > places_.size())
            grow();
        else
            place(row, static_cast<std::uint32_t>(members_.size() - 1));
        return static_cast<std::uint32_t>(members_.size() - 1);
    }
    /// Rows by number.
    std::span<const std::uint32_t> members() const { return members_; }

private:
    struct Place
    {
        std::uint32_t row = 0;
        std::uint32_t number = kNoIndex;  ///< kNoIndex: free
    };

    [[gnu::noinline]] std::uint32_t search(std::uint32_t row) const
    {
        if (places_.empty()) return kNoIndex;
        for (std::size_t i = start(row);; i = (i + 1) & (places_.size() - 1))
            if (places_[i].number == kNoIndex || places_[i].row == row) return places_[i].number;
    }
    std::size_t start(std::uint32_t row) const { return (row * 0x9E3779B9u) >> shift_; }
    void place(std::uint32_t row, std::uint32_t number)
    {
        std::size_t i = start(row);
        while (places_[i].number != kNoIndex) i = (i + 1) & (places_.size() - 1);
        places_[i] = {row, number};
    }
    void grow()
    {
        places_.assign(std::size_t{1} << (32 - --shift_), {});
        for (std::uint32_t i = 0; i < members_.size(); ++i) place(members_[i], i);
    }

    std::uint32_t first_ = 0, consecutive_ = 0;  // the members first_, first_ + 1 ... have the numbers 0, 1 ... consecutive_ - 1
    int shift_ = 30;                             // 32 - log2 of the number of places; the first ones are 8
    std::vector<Place> places_;                  // a power of 2, at most half of them taken
    std::vector<std::uint32_t> members_;
};

}  // namespace plab::simulation
