// Help, page of the manual and completion of a program that has no parser.
#include <doctest/doctest.h>

#include <vector>

#include "program/plain_help.h"
#include "support/text.h"

using namespace plab::program;
using plab::test::has;

namespace
{

CommandOutline outline()
{
    CommandOutline out;
    out.name = "plab-weigh", out.help = "plab-weigh: weighs a plugin";
    out.places = {place_of_file("LIBRARY", "the plugin")};
    out.options = {option_with("--unit", "UNIT", "of the weight"), flag("--quick", "only about")};
    out.footer = "Exit codes: 0 done, 2 wrong use";
    return out;
}

std::string answer(std::vector<const char*> words)
{
    words.insert(words.begin(), "plab-weigh");
    return answer_about(outline(), "1.2.3", static_cast<int>(words.size()), words.data()).value_or("(none)");
}

}  // namespace

TEST_CASE("--help, --version, the page of the manual and completion are of one outline")
{
    CHECK(answer({"--help"}) == help_text(outline()));
    CHECK(help_text(outline()) == R"(plab-weigh: weighs a plugin
Usage: plab-weigh [OPTIONS] LIBRARY

Positionals:
  LIBRARY                     the plugin

Options:
  --help                      Print this help message and exit
  --version                   Display program version information and exit
  --unit UNIT                 of the weight
  --quick                     only about

Exit codes: 0 done, 2 wrong use
)");
    CHECK(answer({"--version"}) == "plab-weigh 1.2.3\n");
    const std::string page = answer({"--print", "man"});
    CHECK(has(page, ".SH NAME\nplab\\-weigh \\- weighs a plugin\n"));
    CHECK(has(page, "\\fB\\-\\-unit\\fR \\fIUNIT\\fR\nof the weight\n"));
    CHECK(has(page, ".SH EXIT CODES\n"));
    for (const char* shell : {"bash", "zsh", "fish"}) CHECK(has(answer({"--print", shell}), "plab-weigh"));
    CHECK(answer({"--complete", "--q"}) == "--quick\tonly about\n");
    CHECK(answer({"--complete", ""}) == ":files\n");
}

TEST_CASE("other words are the program's own")
{
    CHECK(answer({}) == "(none)");
    CHECK(answer({"a.so"}) == "(none)");
    CHECK(answer({"a.so", "--help"}) == "(none)");
    CHECK(answer({"--print", "nothing"}) == "(none)");
}
