#include <doctest/doctest.h>

#include <algorithm>

#include "cdr.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("a sample of XCDR1 is read member by member, each at its alignment")
{
    CHECK(json(rich_type(), rich_sample().bytes()) ==
          R"({"name":"ball","flag":true,"color":"BLUE","points":[{"x":0.5,"y":1.5},{"x":-2.0,"y":0.25}],)"
          R"("words":["a",""],"grid":[[1,2,3],[4,5,6]],"count":18446744073709551615})");
}

TEST_CASE("each primitive has its size and its sign")
{
    const auto type = structure({{"o", simple(Kind::Octet)},
                                 {"c", simple(Kind::Char)},
                                 {"i16", simple(Kind::Int16)},
                                 {"u16", simple(Kind::Uint16)},
                                 {"i32", simple(Kind::Int32)},
                                 {"u32", simple(Kind::Uint32)},
                                 {"i64", simple(Kind::Int64)},
                                 {"f", simple(Kind::Float32)}});
    Cdr cdr;
    cdr.put(std::uint8_t{255}).put('x').put(std::int16_t{-2}).put(std::uint16_t{65535}).put(std::int32_t{-3});
    cdr.put(std::uint32_t{4000000000u}).put(std::int64_t{-4}).put(0.1f);
    CHECK(json(type, cdr.bytes()) == R"({"o":255,"c":"x","i16":-2,"u16":65535,"i32":-3,"u32":4000000000,"i64":-4,"f":0.1})");
}

TEST_CASE("the bytes of big-endian samples are swapped")
{
    std::vector<std::byte> bytes;
    for (const int b : {0, 0, 0, 0, 0, 0, 1, 2}) bytes.push_back(static_cast<std::byte>(b));
    CHECK(json(structure({{"n", simple(Kind::Uint32)}}), bytes) == R"({"n":258})");
}

TEST_CASE("XCDR2 aligns to four bytes at most and writes lengths before members that are not primitive")
{
    const auto type = structure({{"n", simple(Kind::Uint32)},
                                 {"d", simple(Kind::Float64)},
                                 {"words", sequence(simple(Kind::String))},
                                 {"numbers", sequence(simple(Kind::Uint32))}});
    Cdr cdr(7);
    cdr.put(std::uint32_t{1}).put(0.5);
    cdr.put(std::uint32_t{4 + 6}).put(std::uint32_t{1}).text("a");  // of the list, in bytes; elements; the string
    cdr.put(std::uint32_t{1}).put(std::uint32_t{9});
    CHECK(json(type, cdr.bytes()) == R"({"n":1,"d":0.5,"words":["a"],"numbers":[9]})");
}

TEST_CASE("an appendable struct may have more members than its type, or fewer")
{
    const auto inner = structure({{"a", simple(Kind::Uint32)}, {"b", simple(Kind::Uint32)}}, true);
    const auto type = structure({{"inner", inner}, {"last", simple(Kind::Uint32)}}, true);
    const auto with = [&](std::uint32_t members)
    {
        Cdr cdr(9);
        cdr.put(std::uint32_t{4 + 4 * members + 4}).put(4 * members);
        for (std::uint32_t i = 0; i < members; ++i) cdr.put(i + 1);
        return cdr.put(std::uint32_t{7}).bytes();
    };
    CHECK(json(type, with(2)) == R"({"inner":{"a":1,"b":2},"last":7})");
    CHECK(json(type, with(3)) == R"({"inner":{"a":1,"b":2},"last":7})");
    CHECK(json(type, with(1)) == R"({"inner":{"a":1},"last":7})");
}

TEST_CASE("an enum's value without a literal is its number")
{
    const auto type = structure({{"c", colors()}});
    CHECK(json(type, Cdr().put(std::int32_t{0}).bytes()) == R"({"c":"RED"})");
    CHECK(json(type, Cdr().put(std::int32_t{3}).bytes()) == R"({"c":3})");
    CHECK(*link::tree_of(*type, Cdr().put(std::int32_t{3}).bytes(), 9) == "c: 3 (no literal)\n");
}

TEST_CASE("the tree has a line for each member; flat members are on one line")
{
    CHECK(*link::tree_of(*rich_type(), rich_sample().bytes(), 100) ==
          "name: \"ball\"\n"
          "flag: true\n"
          "color: BLUE\n"
          "points:\n"
          "  - {x: 0.5, y: 1.5}\n"
          "  - {x: -2, y: 0.25}\n"
          "words: [\"a\", \"\"]\n"
          "grid:\n"
          "  - [1, 2, 3]\n"
          "  - [4, 5, 6]\n"
          "count: 18446744073709551615\n");
}

TEST_CASE("structs with lists in them are indented below their dash")
{
    const auto element = structure({{"n", simple(Kind::Uint32)}, {"list", sequence(simple(Kind::Uint32))}});
    Cdr cdr;
    cdr.put(std::uint32_t{2});
    for (const std::uint32_t n : {1u, 2u}) cdr.put(n).put(std::uint32_t{1}).put(n * 10);
    CHECK(*link::tree_of(*structure({{"all", sequence(element)}}), cdr.bytes(), 100) ==
          "all:\n"
          "  - n: 1\n"
          "    list: [10]\n"
          "  - n: 2\n"
          "    list: [20]\n");
}

TEST_CASE("a long list is truncated, and this is shown")
{
    Cdr cdr;
    cdr.put(std::uint32_t{5});
    for (std::uint32_t i = 0; i < 5; ++i) cdr.put(i);
    const auto flat = structure({{"list", sequence(simple(Kind::Uint32))}});
    CHECK(*link::tree_of(*flat, cdr.bytes(), 2) == "list: [0, 1, ... and 3 more]\n");
    const auto deep = structure({{"list", sequence(structure({{"n", simple(Kind::Uint32)}}))}, {"after", sequence(simple(Kind::Octet))}});
    cdr.put(std::uint32_t{0});
    CHECK(*link::tree_of(*deep, cdr.bytes(), 2) ==
          "list:\n"
          "  - {n: 0}\n"
          "  - {n: 1}\n"
          "  ... and 3 more\n"
          "after: []\n");
    CHECK(json(deep, cdr.bytes()) == R"({"list":[{"n":0},{"n":1},{"n":2},{"n":3},{"n":4}],"after":[]})");
}

TEST_CASE("the key of a type has its key members, and all members of a struct that marks none")
{
    const auto marked = structure({{"a", simple(Kind::Uint32), true}, {"b", simple(Kind::Uint32)}});
    const auto unmarked = structure({{"a", simple(Kind::Uint32)}, {"b", simple(Kind::Uint32)}});
    const auto type = structure({{"one", marked, true}, {"two", unmarked, true}, {"three", simple(Kind::String)}});
    const auto key = link::key_of(*type);
    REQUIRE(key);
    const auto bytes = Cdr().put(std::uint32_t{1}).put(std::uint32_t{2}).put(std::uint32_t{3}).bytes();
    CHECK(json(key, bytes) == R"({"one":{"a":1},"two":{"a":2,"b":3}})");
    CHECK(link::key_of(*unmarked) == nullptr);
}
