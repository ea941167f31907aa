/// Of many errors of one kind, the first few and the number of the others are reported.
#include "model/alike.h"

#include <doctest/doctest.h>

using namespace plab;

namespace
{

Error at(std::uint32_t line, const std::string& element, const std::string& why) { return {{"s.xml", line, 7}, element, why}; }

}  // namespace

TEST_CASE("of errors that differ in numbers alone the first three are reported, and the number of the others")
{
    Errors many;
    for (int i = 0; i < 1000; ++i)
    {
        const std::string n = std::to_string(i);
        many.push_back(at(2, "b." + n, "mass must be positive, not -" + n));
        if (i == 1) many.push_back(at(3, "other", "has no shape"));
    }
    const Errors few = model::first_of_alike(many);
    REQUIRE(few.size() == 5);
    CHECK(few[0].text() == "s.xml:2:7: b.0: mass must be positive, not -0");
    CHECK(few[1].element == "b.1");
    CHECK(few[2].element == "other");
    CHECK(few[3].element == "b.2");
    CHECK(few[4].text() == "s.xml:2:7: and 997 more like it");
}

TEST_CASE("errors at other places, or with another text, are reported")
{
    Errors many;
    for (std::uint32_t line = 1; line <= 20; ++line) many.push_back(at(line, "b", "mass must be positive, not -1"));
    for (const char c : std::string("abcdefgh")) many.push_back(at(30, "x", std::string("has no field ") + c));
    CHECK(model::first_of_alike(many).size() == 28);
    CHECK(model::first_of_alike({}).empty());
}
