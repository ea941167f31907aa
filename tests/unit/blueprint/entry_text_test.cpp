#include <doctest/doctest.h>

#include "blueprint/entry_text.h"

using namespace plab;
using blueprint::format_entry;
using blueprint::parse_entry;
using EntryValue = std::variant<bool, double, std::string>;

namespace
{

std::string entry_refusal(std::string_view text)
{
    const auto value = parse_entry(text);
    return value.ok() ? "accepted" : value.error().reason;
}

}  // namespace

TEST_CASE("truth values, numbers, words and quoted texts")
{
    CHECK(*parse_entry(" true ") == EntryValue(true));
    CHECK(*parse_entry("false") == EntryValue(false));
    CHECK(*parse_entry("\n-0.1\n") == EntryValue(-0.1));
    CHECK(*parse_entry("+3") == EntryValue(3.0));
    CHECK(*parse_entry("1e-300") == EntryValue(1e-300));
    CHECK(*parse_entry("left") == EntryValue(std::string("left")));
    CHECK(*parse_entry("two words") == EntryValue(std::string("two words")));
    CHECK(*parse_entry("\" 12 \"") == EntryValue(std::string(" 12 ")));
    CHECK(*parse_entry("'true'") == EntryValue(std::string("true")));
    CHECK(*parse_entry("\"\"") == EntryValue(std::string()));
}

TEST_CASE("text that looks like a number but is not one is refused as text")
{
    CHECK(entry_refusal("") == "needs a value; \"\" is the empty text");
    CHECK(entry_refusal("1,5") ==
          "'1,5': use a point, not a comma, in numbers, and spaces between them; write it in double quotes if it is a "
          "text");
    CHECK(entry_refusal("3 apples") == "'3 apples' is not a number; write it in double quotes if it is a text");
    CHECK(entry_refusal("inf") == "'inf' is not finite; write it in double quotes if it is a text");
    CHECK(entry_refusal("1e999") == "'1e999' is out of range; write it in double quotes if it is a text");
    CHECK(entry_refusal("nan").starts_with("'nan' is not a finite number"));
    CHECK(entry_refusal("\"open") == "the quote of the text '\"open' is not closed");
    CHECK(entry_refusal("\"") == "the quote of the text '\"' is not closed");
}

TEST_CASE("written values read back the same")
{
    for (const EntryValue& v : {EntryValue(true), EntryValue(false), EntryValue(0.1), EntryValue(-0.0), EntryValue(5e-324),
                                EntryValue(1.7976931348623157e308), EntryValue(std::string()), EntryValue(std::string("true")),
                                EntryValue(std::string(" \"quoted\" ")), EntryValue(std::string("12"))})
    {
        CAPTURE(format_entry(v));
        const auto back = parse_entry(format_entry(v));
        REQUIRE(back.ok());
        CHECK(*back == v);
    }
}
