#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "link/json.h"
#include "link/names.h"
#include "link/text.h"

using namespace plab::link;

TEST_CASE("numbers are short and read back to the same value")
{
    CHECK(number_text(0.1) == "0.1");
    CHECK(number_text(0.1f) == "0.1");
    CHECK(std::stod(number_text(1.0 / 3)) == 1.0 / 3);
    CHECK(line_of(-2.5e-300) == "-2.5e-300");
    CHECK(line_of(std::numeric_limits<double>::infinity()) == "null");
    CHECK(line_of(std::numeric_limits<double>::quiet_NaN()) == "null");
}

TEST_CASE("every number in JSON reads back to the same bits")
{
    std::mt19937_64 random(1);
    for (int i = 0; i < 10'000; ++i)
    {
        const auto value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        CHECK(std::bit_cast<std::uint64_t>(std::strtod(line_of(value).c_str(), nullptr)) == std::bit_cast<std::uint64_t>(value));
    }
    CHECK(line_of(~std::uint64_t{0}) == "18446744073709551615");
    CHECK(line_of(-0.0) == "-0.0");
}

TEST_CASE("JSON text is valid whatever was received from the bus")
{
    CHECK(line_of("a\"b\\c\nd") == R"("a\"b\\c\nd")");
    CHECK(line_of("\x1b[31m") == R"("\u001b[31m")");
    CHECK(line_of("gr\xC3\xBC\xC3\x9F") == "\"gr\xC3\xBC\xC3\x9F\"");
    // Truncated, overlong, surrogate, beyond U+10FFFF, stray continuation.
    for (const char* bad : {"\xC3", "\xE2\x82", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\x80", "\xFF\xFE"})
    {
        CAPTURE(bad);
        CHECK(nlohmann::json::accept(line_of(bad)));
        CHECK(line_of(bad).find("\xEF\xBF\xBD") != std::string::npos);
    }
    std::string all;
    for (int c = 1; c < 256; ++c) all += static_cast<char>(c);
    CHECK(nlohmann::json::accept(line_of(all)));
}

TEST_CASE("JSON is safe for terminals and keeps its meaning")
{
    const Json value{{"text",
                      "\x7F\xC2\x9B"
                      "31m \xC3\xBC\n"}};
    const std::string safe = line_of(value);
    CHECK(safe == "{\"text\":\"\\u007f\\u009b31m \xC3\xBC\\n\"}");
    CHECK(Json::parse(safe) == value);
    CHECK(line_of("\xC2\x9F") == "\"\\u009f\"");   // the last of them
    CHECK(line_of("\xC2\xA0") == "\"\xC2\xA0\"");  // a space that does not break
}

TEST_CASE("no received text controls the terminal")
{
    CHECK(terminal_text("\x1b]0;title\x07") == "\\x1b]0;title\\x07");
    CHECK(terminal_text("two\nlines\t\r") == "two\\nlines\\t\\x0d");
    CHECK(terminal_text("\xC2\x9B"
                        "31m") == "\\x9b31m");  // CSI as one character
    CHECK(terminal_text("gr\xC3\xBC\xC3\x9F") == "gr\xC3\xBC\xC3\x9F");
}

TEST_CASE("the keys of an object stay in the order in which they were set")
{
    const Json json{{"time", 0.5}, {"names", {"a", "b"}}, {"empty", Json::object()}, {"list", {Json::array(), true, -3}}};
    CHECK(line_of(json) == R"({"time":0.5,"names":["a","b"],"empty":{},"list":[[],true,-3]})");
}

TEST_CASE("the id at the beginning of a name is the longest one that is known, since ids may contain dots")
{
    const auto is_id = [](const std::string& id) { return id == "ball" || id == "ball.3" || id == "contact.response"; };
    const auto split = [&](const std::string& text) { return plab::split_id(text, is_id); };
    CHECK(split("ball.position.z").id == "ball");
    CHECK(split("ball.position.z").rest == "position.z");
    CHECK(split("ball.3.position").id == "ball.3");
    CHECK(split("contact.response.cost").rest == "cost");
    CHECK(split("energy.kinetic").id.empty());
    CHECK(split("energy.kinetic").rest == "energy.kinetic");
    CHECK(split("ball").id.empty());  // the whole is not a beginning
    CHECK(split(".x").id.empty());
}
