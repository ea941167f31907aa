#include "lua/arena.h"

#include <bit>
#include <cassert>
#include <cstring>
#include <new>

namespace plab::scripts
{
namespace
{

constexpr std::size_t kGranularity = 16, kSmall = 512, kSmallClasses = kSmall / kGranularity;

/// Steps of 16 bytes to 512, then four sizes per octave.
constexpr std::size_t class_of(std::size_t size)
{
    if (size <= kSmall) return (size + kGranularity - 1) / kGranularity;
    const auto octave = static_cast<std::size_t>(std::bit_width(size - 1)) - 1;
    const std::size_t quarter = (size - 1) >> (octave - 2);  // 4..7
    return kSmallClasses + (octave - 9) * 4 + (quarter - 4) + 1;
}

constexpr std::size_t size_of(std::size_t piece_class)
{
    if (piece_class <= kSmallClasses) return piece_class * kGranularity;
    const std::size_t k = piece_class - kSmallClasses - 1;
    return (k % 4 + 5) << (9 + k / 4 - 2);
}

static_assert(size_of(class_of(512)) == 512 && size_of(class_of(513)) == 640 && size_of(class_of(1024)) == 1024 &&
              size_of(class_of(1025)) == 1280);

}  // namespace

Arena::Arena(std::size_t capacity) : block_(std::make_unique_for_overwrite<std::byte[]>(capacity)), capacity_(capacity) {}

void Arena::clear()
{
    fresh_ = used_ = 0;
    free_.fill(nullptr);
}

void* Arena::allocate(std::size_t size)
{
    if (size > capacity_) return nullptr;
    const std::size_t c = class_of(size), rounded = size_of(c);
    assert(c < kClasses);
    void* piece = free_[c];
    if (piece)
        free_[c] = free_[c]->next;
    else if (capacity_ - fresh_ >= rounded)
    {
        piece = block_.get() + fresh_;
        fresh_ += rounded;
    }
    else
        piece = take_larger(c);
    if (piece) used_ += rounded;
    return piece;
}

void* Arena::take_larger(std::size_t wanted)
{
    for (std::size_t c = wanted + 1; c < kClasses; ++c)
    {
        if (!free_[c]) continue;
        Piece* piece = free_[c];
        free_[c] = piece->next;
        std::byte* rest = reinterpret_cast<std::byte*>(piece) + size_of(wanted);
        for (std::size_t left = size_of(c) - size_of(wanted); left > 0;)
        {
            std::size_t part = class_of(left);
            if (size_of(part) > left) --part;
            keep(rest, size_of(part));
            rest += size_of(part);
            left -= size_of(part);
        }
        return piece;
    }
    return nullptr;
}

void Arena::keep(void* piece, std::size_t size)
{
    const std::size_t c = class_of(size);
    free_[c] = new (piece) Piece{free_[c]};
}

void Arena::release(void* piece, std::size_t size)
{
    if (!piece) return;
    keep(piece, size);
    used_ -= size_of(class_of(size));
}

void* Arena::resize(void* piece, std::size_t old_size, std::size_t size)
{
    const std::size_t from = class_of(old_size), to = class_of(size);
    if (from == to) return piece;
    void* moved = allocate(size);
    if (moved)
    {
        std::memcpy(moved, piece, old_size < size ? old_size : size);
        release(piece, old_size);
        return moved;
    }
    if (to > from) return nullptr;
    used_ -= size_of(from) - size_of(to);  // the piece is shrunk in place; its end is lost until clear()
    return piece;
}

}  // namespace plab::scripts
