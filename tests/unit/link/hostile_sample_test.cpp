// Bytes that no correct writer sends. Under AddressSanitizer this is also the proof that nothing is read past the end.
#include <doctest/doctest.h>

#include <ctime>
#include <nlohmann/json.hpp>
#include <random>

#include "cdr.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// In a buffer of exactly this size, so that reading one byte beyond it is detected.
std::string json_of_exactly(const DynamicTypePtr& type, std::span<const std::byte> bytes)
{
    const auto copy = std::make_unique<std::byte[]>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), copy.get());
    const auto text = link::json_of(*type, {copy.get(), bytes.size()});
    return text ? link::line_of(*text) : "error: " + text.error().text();
}

bool is_error(const std::string& text) { return text.starts_with("error: "); }
}  // namespace

TEST_CASE("a sample that is truncated anywhere is refused, and the message says where")
{
    const auto bytes = rich_sample().bytes();
    REQUIRE(!is_error(json_of_exactly(rich_type(), bytes)));
    for (std::size_t n = 0; n < bytes.size(); ++n)
    {
        CAPTURE(n);
        CHECK(is_error(json_of_exactly(rich_type(), std::span(bytes).first(n))));
    }
    const std::string cut_in_grid = json_of_exactly(rich_type(), std::span(bytes).first(bytes.size() - 16));
    CHECK(has(cut_in_grid, "grid[1]"));
    CHECK(has(cut_in_grid, "the sample ends here"));
}

TEST_CASE("randomly altered bytes are refused or read as some value, and the output is valid JSON")
{
    std::mt19937 random(7);
    int refused = 0, read = 0;
    for (int round = 0; round < 20000; ++round)
    {
        auto bytes = rich_sample().bytes();
        for (unsigned i = 0; i <= random() % 3; ++i) bytes[random() % bytes.size()] = static_cast<std::byte>(random());
        const std::string text = json_of_exactly(rich_type(), bytes);
        ++(is_error(text) ? refused : read);
        if (!is_error(text)) CHECK_MESSAGE(nlohmann::json::accept(text), text);
    }
    CHECK(refused > 1000);
    CHECK(read > 1000);
}

TEST_CASE("lengths beyond the sample are refused before memory is allocated for them")
{
    const auto list = structure({{"list", sequence(simple(Kind::Octet))}});
    CHECK(has(json(list, Cdr().put(~std::uint32_t{0}).bytes()), "list: a sequence of 4294967295 elements, but 0 bytes are left"));
    const auto text = structure({{"text", simple(Kind::String)}});
    CHECK(has(json(text, Cdr().put(~std::uint32_t{0}).bytes()), "a string of 4294967295 bytes, but 0 are left"));
    CHECK(has(json(text, Cdr().put(std::uint32_t{0}).bytes()), "terminating zero"));
    CHECK(has(json(text, Cdr().put(std::uint32_t{1}).put('x').bytes()), "without its terminating zero"));
    const auto words = structure({{"words", sequence(simple(Kind::String))}});
    CHECK(has(json(words, Cdr(7).put(~std::uint32_t{0}).bytes()), "a part of 4294967295 bytes"));
}

TEST_CASE("a list inside of a part may not read beyond that part")
{
    const auto inner = structure({{"a", simple(Kind::Uint32)}}, true);
    const auto type = structure({{"inner", inner}, {"after", simple(Kind::Uint32)}}, true);
    // The inner part claims two bytes: its member needs four, which are present, but not inside the part.
    const auto bytes = Cdr(9).put(std::uint32_t{12}).put(std::uint32_t{2}).put(std::uint32_t{1}).put(std::uint32_t{2}).bytes();
    CHECK(has(json(type, bytes), "inner.a: the sample ends here"));
}

TEST_CASE("bounds of the type are enforced")
{
    const auto list = structure({{"list", sequence(simple(Kind::Octet), 1)}});
    CHECK(has(json(list, Cdr().put(std::uint32_t{2}).put('a').put('b').bytes()), "at most 1"));
    auto text = std::make_shared<DynamicType>();
    text->kind = Kind::String, text->bound = 2;
    CHECK(has(json(structure({{"t", text}}), Cdr().text("abc").bytes()), "at most 2"));
}

TEST_CASE("elements without bytes, and types without end, cost no more than a limit")
{
    const std::clock_t begin = std::clock();
    const auto empty = structure({});
    CHECK(has(json(structure({{"list", sequence(empty)}}), Cdr().put(~std::uint32_t{0}).bytes()), "more than"));
    CHECK(has(json(structure({{"grid", array(empty, {65535, 65535, 65535})}}), Cdr().bytes()), "more than"));
    CHECK(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC < 30);  // s of this process; 1 without sanitizers
    DynamicTypePtr deep = simple(Kind::Octet);
    for (int i = 0; i < 100; ++i) deep = structure({{"m", deep}});
    CHECK(has(json(deep, Cdr().put('x').bytes()), "deeper than"));
}

TEST_CASE("samples that do not fit the type are refused: surplus bytes, invalid booleans, other encodings")
{
    const auto type = structure({{"flag", simple(Kind::Boolean)}});
    CHECK(has(json(type, Cdr().put('\2').bytes()), "flag: a boolean is 0 or 1, not 2"));
    CHECK(json(type, Cdr().put('\1').put('\0').put('\0').put('\0').bytes()) == R"({"flag":true})");  // padded to a word
    CHECK(has(json(type, Cdr().put('\1').put(std::uint64_t{0}).bytes()), "15 bytes are left over"));
    for (const int encoding : {2, 3, 4, 10, 11}) CHECK(has(json(type, Cdr(encoding).put('\1').bytes()), "encoding"));
    CHECK(has(json(type, {}), "begins with 4 header bytes"));
}
