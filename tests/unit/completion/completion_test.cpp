// What may stand at the cursor of a command line, and the page of the manual, from a parser's outline.
#include <doctest/doctest.h>

#include "program/completion.h"
#include "program/man_page.h"

using namespace plab::program;

namespace
{

OptionOutline option(std::vector<std::string> names, const std::string& value, const std::string& help)
{
    OptionOutline out;
    out.names = std::move(names), out.value = value, out.has_value = !value.empty(), out.help = help, out.group = "Options";
    return out;
}

OptionOutline place(const std::string& name, const std::string& value, int most = 1)
{
    OptionOutline out = option({}, value, "which");
    out.place = name, out.most = most;
    return out;
}

/// prog [--server NAME] [--mode a|b] swap ID.. --to TYPE [--force] | play FILE
CommandOutline program()
{
    CommandOutline out;
    out.name = "prog", out.help = "prog: does things", out.footer = "Examples:\n  prog swap a --to B-C\nExit codes: 0 done,\n1 failed.\n";
    out.options = {option({"-h", "--help"}, "", "help"), option({"-s", "--server"}, "NAME", "which server to ask"),
                   option({"--mode"}, "WORD", "how\nor why")};
    out.options[2].words = {"slow", "fast"};
    CommandOutline swap, play;
    swap.name = "swap", swap.help = "exchange", swap.footer = "Examples:\n  prog swap x\n";
    swap.options = {option({"-h", "--help"}, "", "help"), option({"--to"}, "TYPE", ".new \\ type"), option({"--force"}, "", "do it")};
    swap.places = {place("id", "ID", 100)};
    play.name = "play", play.help = "play a file", play.places = {place("file", "FILE")};
    out.commands = {swap, play};
    return out;
}

std::vector<std::string> words(const std::vector<std::string>& line)
{
    std::vector<std::string> out;
    for (const Candidate& c : wanted_at(program(), line).candidates) out.push_back(c.word);
    return out;
}

/// "VALUE of OPTION in COMMAND" that is wanted.
std::string wanted(const std::vector<std::string>& line)
{
    const Wanted w = wanted_at(program(), line);
    return w.value + " of " + w.option + " in " + w.command;
}

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("commands, options and words from a list are offered where they may stand")
{
    CHECK(words({}) == Words{"swap", "play"});
    CHECK(words({"sw"}) == Words{"swap", "play"});  // completion_lines() removes words with another beginning
    CHECK(words({"-"}) == Words{"--help", "--server", "--mode"});
    CHECK(words({"swap", "--"}) == Words{"--help", "--to", "--force", "--help", "--server", "--mode"});
    CHECK(words({"--mode", ""}) == Words{"slow", "fast"});
    CHECK(words({"--mode=f"}) == Words{"slow", "fast"});
    CHECK(words({"--mode", "slow", ""}) == Words{"swap", "play"});
    CHECK(words({"--unknown", "x", ""}) == Words{"swap", "play"});
}

TEST_CASE("a value is requested by its name, option and command, and the words before it are known")
{
    CHECK(wanted({"-s", ""}) == "NAME of --server in ");
    CHECK(wanted({"swap", ""}) == "ID of id in swap");
    CHECK(wanted({"swap", "a", "b"}) == "ID of id in swap");
    CHECK(wanted({"swap", "a", "--to", "S"}) == "TYPE of --to in swap");
    CHECK(wanted({"swap", "--force", ""}) == "ID of id in swap");
    CHECK(wanted({"play", "a", ""}) == " of  in play");
    const Wanted w = wanted_at(program(), {"--server=lab", "swap", "a", "b", "--to=Solver"});
    CHECK(w.first("--server") == "lab");
    CHECK(w.given.at("id") == Words{"a", "b"});
    CHECK(w.first("--nothing").empty());
    CHECK(w.before == "--to=");
    CHECK(w.begun == "Solver");
}

TEST_CASE("lines for shells: words with the given beginning, sorted, without duplicates and control characters")
{
    const auto values = [](const Wanted& w)
    {
        Values out;
        if (w.value == "ID")
            out.candidates = {{"b", "two\nlines"}, {"bad\tword", ""}, {"a", "one"}, {"b", "again"}, {":files", ""}}, out.go_on = true;
        out.are_files = w.value == "FILE";
        return out;
    };
    CHECK(completion_lines(program(), {"swap", "b"}, values) == ":nospace\nb\ttwo lines\nbad word\t\n");
    CHECK(completion_lines(program(), {"play", ""}, values) == ":files\n");
    CHECK(completion_lines(program(), {"--mode=f"}, values) == "--mode=fast\t\n");
    CHECK(completion_lines(program(), {"p"}, {}) == "play\tplay a file\n");
    CHECK(completion_lines(program(), {"swap", "b"}, {}).empty());
}

TEST_CASE("scripts name the program, and there is none for an unknown shell")
{
    for (const char* shell : {"bash", "zsh", "fish"})
    {
        const std::string script = completion_script("prog", shell);
        CHECK(script.find("prog") != std::string::npos);
        CHECK(script.find("--complete") != std::string::npos);
        CHECK(script.find("%NAME%") == std::string::npos);
    }
    CHECK(completion_script("prog", "csh").empty());
}

TEST_CASE("the man page has all options and commands, and the titles of the footer")
{
    const std::string page = man_page(program(), "1.2");
    const auto has = [&](const std::string& part) { return page.find(part) != std::string::npos; };
    CHECK(has(".TH PROG 1 \"\" \"pLab 1.2\""));
    CHECK(has("prog \\- does things\n"));
    CHECK(has("\\fB\\-s\\fR, \\fB\\-\\-server\\fR \\fINAME\\fR\nwhich server to ask\n"));
    CHECK(has("\\fB\\-\\-mode\\fR \\fIslow|fast\\fR\nhow or why\n"));
    CHECK(has(".SS \\fBswap\\fR [\\fIID\\fR ...]\nexchange\n"));
    CHECK(has("\n\\&.new \\e type\n"));
    CHECK(has(".SH EXAMPLES\n.PP\n.nf\n  prog swap a \\-\\-to B\\-C\n.fi\n"));
    CHECK(has(".SH EXIT CODES\n0 done,\n1 failed.\n"));
    CHECK(has(".SS \\fBplay\\fR [\\fIFILE\\fR]\n"));
}
