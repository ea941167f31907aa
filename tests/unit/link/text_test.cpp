#include <doctest/doctest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "link/json_text.h"

using namespace plab::link;

TEST_CASE("numbers are short and read back to the same value")
{
    CHECK(number_text(0.1) == "0.1");
    CHECK(number_text(0.1f) == "0.1");
    CHECK(std::stod(number_text(1.0 / 3)) == 1.0 / 3);
    CHECK(json_number(-2.5e-300) == "-2.5e-300");
    CHECK(json_number(std::numeric_limits<double>::infinity()) == "null");
    CHECK(json_number(std::numeric_limits<float>::quiet_NaN()) == "null");
}

TEST_CASE("JSON text is valid whatever was received from the bus")
{
    CHECK(json_text("a\"b\\c\nd") == R"("a\"b\\c\nd")");
    CHECK(json_text("\x1b[31m") == R"("\u001b[31m")");
    CHECK(json_text("gr\xC3\xBC\xC3\x9F") == "\"gr\xC3\xBC\xC3\x9F\"");
    // Truncated, overlong, surrogate, beyond U+10FFFF, stray continuation.
    for (const char* bad : {"\xC3", "\xE2\x82", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\x80", "\xFF\xFE"})
    {
        CAPTURE(bad);
        CHECK(nlohmann::json::accept(json_text(bad)));
        CHECK(json_text(bad).find("\xEF\xBF\xBD") != std::string::npos);
    }
    std::string all;
    for (int c = 1; c < 256; ++c) all += static_cast<char>(c);
    CHECK(nlohmann::json::accept(json_text(all)));
}

TEST_CASE("the JSON of any writer is made safe for terminals and keeps its meaning")
{
    const nlohmann::json value{{"text",
                                "\x7F\xC2\x9B"
                                "31m \xC3\xBC\n"}};
    const std::string safe = safe_json(value.dump());
    CHECK(safe == "{\"text\":\"\\u007f\\u009b31m \xC3\xBC\\n\"}");
    CHECK(nlohmann::json::parse(safe) == value);
}

TEST_CASE("no received text controls the terminal")
{
    CHECK(terminal_text("\x1b]0;title\x07") == "\\x1b]0;title\\x07");
    CHECK(terminal_text("two\nlines\t\r") == "two\\nlines\\t\\x0d");
    CHECK(terminal_text("\xC2\x9B"
                        "31m") == "\\x9b31m");  // CSI as one character
    CHECK(terminal_text("gr\xC3\xBC\xC3\x9F") == "gr\xC3\xBC\xC3\x9F");
}

TEST_CASE("the writer puts its commas")
{
    JsonWriter json;
    json.open('{').key("time").value(0.5).key("names").open('[').value("a").value("b").close(']');
    json.key("empty").open('{').close('}').key("list").open('[').open('[').close(']').value(true).value(-3).close(']').close('}');
    CHECK(json.take() == R"({"time":0.5,"names":["a","b"],"empty":{},"list":[[],true,-3]})");
}
