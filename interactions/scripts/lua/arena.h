/// The memory of one script: a block of fixed size, divided into pieces that are kept in free lists by size.
#pragma once

#include <array>
#include <cstddef>
#include <memory>

namespace plab::scripts
{

/// Never allocates from the system after construction, so a warm call allocates nothing and the limit is exact. Pages that are
/// never touched cost nothing. Freed pieces are not merged: a script that keeps changing the sizes it uses can use less of its
/// block than its limit says.
class Arena
{
public:
    explicit Arena(std::size_t capacity);

    /// 16-byte aligned; null if nothing fits.
    void* allocate(std::size_t size);
    void release(void* piece, std::size_t size);
    /// Shrinking a piece never fails. If it returns null, the piece is unchanged.
    void* resize(void* piece, std::size_t old_size, std::size_t size);
    /// Frees all pieces.
    void clear();

    std::size_t used() const { return used_; }  ///< bytes, including the rounding of sizes
    std::size_t capacity() const { return capacity_; }

private:
    struct Piece
    {
        Piece* next;
    };
    static constexpr std::size_t kClasses = 33 + 4 * 24;

    void* take_larger(std::size_t wanted);
    void keep(void* piece, std::size_t size);

    std::unique_ptr<std::byte[]> block_;
    std::size_t capacity_;
    std::size_t fresh_ = 0;  // offset of the part that has never been used
    std::size_t used_ = 0;
    std::array<Piece*, kClasses> free_{};
};

}  // namespace plab::scripts
