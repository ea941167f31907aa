// The block from which a script's memory is allocated.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "lua/arena.h"
#include "plab/random.h"

using plab::scripts::Arena;

namespace
{

bool is_filled(const void* piece, std::size_t size, unsigned char mark)
{
    const auto* bytes = static_cast<const unsigned char*>(piece);
    return std::all_of(bytes, bytes + size, [mark](unsigned char b) { return b == mark; });
}

}  // namespace

TEST_CASE("pieces do not overlap, keep their content when resized, and can be used again")
{
    struct Piece
    {
        void* at = nullptr;
        std::size_t size = 0;
        unsigned char mark = 0;
    };
    Arena arena(1 << 20);
    std::vector<Piece> pieces(200);
    std::uint64_t seed = 1;
    int refused = 0;
    for (int i = 0; i < 100000; ++i)
    {
        Piece& p = pieces[plab::next_random(seed) % pieces.size()];
        const std::size_t size = 1 + plab::next_random(seed) % (i % 50 == 0 ? 60000 : 700);
        REQUIRE(is_filled(p.at, p.size, p.mark));
        if (p.at && i % 3 == 0)
        {
            arena.release(p.at, p.size);
            p = {};
            continue;
        }
        void* at = p.at ? arena.resize(p.at, p.size, size) : arena.allocate(size);
        refused += at == nullptr;
        if (!at)
        {
            CHECK((!p.at || size > p.size));  // a smaller size always fits
            continue;
        }
        REQUIRE(reinterpret_cast<std::uintptr_t>(at) % 16 == 0);
        REQUIRE(is_filled(at, std::min(p.size, size), p.mark));
        p = {at, size, static_cast<unsigned char>(i)};
        std::memset(at, p.mark, size);
        REQUIRE(arena.used() <= arena.capacity());
    }
    CHECK(refused > 0);
    for (Piece& p : pieces) arena.release(p.at, p.size);
    CHECK(arena.used() == 0);
}

TEST_CASE("a full arena refuses, and reuses released memory")
{
    Arena arena(64 << 10);
    CHECK(arena.allocate(65 << 10) == nullptr);
    void* large = arena.allocate(48 << 10);
    REQUIRE(large);
    CHECK(arena.allocate(20 << 10) == nullptr);
    arena.release(large, 48 << 10);
    int small = 0;
    while (arena.allocate(100))  // cut from the large piece
        ++small;
    CHECK(small > 500);  // 585 without loss
    arena.clear();
    CHECK(arena.used() == 0);
    CHECK(arena.allocate(64 << 10) != nullptr);
}
