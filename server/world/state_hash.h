/// Building blocks of the 64-bit hash over the raw bits of the state (server/docs/determinism.md): word-wise FNV-1a, in short independent
/// chains.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "plab/vector.h"

namespace plab::world
{

inline constexpr std::uint64_t kHashPrime = 0x100000001b3ull;

constexpr std::uint64_t mix(std::uint64_t h, std::uint64_t word)
{
    h = (h ^ word) * kHashPrime;
    return h ^ (h >> 29);  // mixes high bits down: a plain word-wise FNV would ignore many changes of sign
}

constexpr std::uint64_t mix(std::uint64_t h, double value) { return mix(h, std::bit_cast<std::uint64_t>(value)); }

constexpr std::uint64_t hash_of(const Vec3& v) { return mix(mix(mix(0, v.x), v.y), v.z); }

constexpr std::uint64_t hash_of(const Quat& q) { return mix(mix(mix(mix(0, q.w), q.x), q.y), q.z); }

/// Adds bytes in words of eight, then the remaining ones singly.
std::uint64_t hash_bytes(std::uint64_t h, std::span<const std::uint8_t> bytes);

}  // namespace plab::world
