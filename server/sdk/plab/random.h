/// Seeded random numbers, the same on every machine (SplitMix64: Steele, Lea, Flood, OOPSLA 2014).
#pragma once

#include <cstdint>

namespace plab
{

/// The next number of a stream; the state is the stream's only memory.
constexpr std::uint64_t next_random(std::uint64_t& state)
{
    state += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

/// Uniform in [0, 1), 53 bits.
constexpr double next_uniform(std::uint64_t& state) { return static_cast<double>(next_random(state) >> 11) * 0x1p-53; }

/// A different seed for each name.
constexpr std::uint64_t seed_for(std::uint64_t seed, const char* text, std::size_t n)
{
    std::uint64_t h = seed ^ 0xcbf29ce484222325ull;
    for (std::size_t i = 0; i < n; ++i) h = (h ^ static_cast<unsigned char>(text[i])) * 0x100000001b3ull;
    return next_random(h);
}

}  // namespace plab
