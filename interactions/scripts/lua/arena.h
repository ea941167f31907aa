/// Memory of one script: a block of fixed size, cut into pieces that are kept in lists by size.
#pragma once

#include <array>
#include <cstddef>
#include <memory>

namespace plab::scripts
{

/// Never asks the system for memory after construction, so a warm call allocates nothing and the limit is exact. Pages
/// that are never touched cost nothing. Freed pieces are not joined again: a script that keeps changing the sizes it
/// uses gets less out of its block than its limit says.
class Arena
{
public:
    explicit Arena(std::size_t capacity);

    /// 16-byte aligned; null when nothing fits.
    void* allocate(std::size_t size);
    void release(void* piece, std::size_t size);
    /// Making a piece smaller never fails. Null leaves the piece as it was.
    void* resize(void* piece, std::size_t old_size, std::size_t size);
    /// All pieces are free again.
    void clear();

    std::size_t used() const { return used_; }  ///< bytes, with the rounding of sizes
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
    std::size_t fresh_ = 0;  // offset of what was never used
    std::size_t used_ = 0;
    std::array<Piece*, kClasses> free_{};
};

}  // namespace plab::scripts
