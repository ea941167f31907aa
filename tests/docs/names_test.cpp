// What the documents and the README.md of each folder name in backticks exists: files and folders, component types, stages, tests, and
// the commands and options of the programs. What is not checked: identifiers of the code, units, names on the wire, keys of JSON.
#include <doctest/doctest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include "docs/named_things.h"
#include "support/process.h"

namespace plab::test
{
namespace
{

/// Names that look like ours and are not. A document that no longer names one fails the test, so that the list stays short.
struct Foreign
{
    std::string_view document, text, why;
};
constexpr Foreign kForeign[] = {
    {"clients/link/README.md", "dds/ddsi/", "a folder of Cyclone DDS's headers"},
    {"idl/recording/README.md", "dds/", "a folder of Cyclone DDS's headers"},
    {"idl/recording/README.md", "blueprint.xml", "the name of an attachment in a recording"},
    {"interactions/detection/README.md", "ode/ode.h", "a header of ODE"},
    {"server/docs/blueprint.md", "type/", "a placeholder"},
    {"server/docs/bus.md", "rt/", "how ROS names begin"},
    {"server/docs/install.md", "share/plab/idl/plab.idl", "where the IDL is installed"},
    {"server/docs/peers.md", "results.json", "bench_peers writes it"},
    {"server/docs/peers.md", "summary.md", "bench_peers writes it"},
    {"server/docs/study.md", "results.json", "plab-study writes it"},
    {"server/docs/study.md", "reference_algorithm", "a key of a suite file, not a test"},
    {"server/docs/tutorial.md", "inverse_square.cpp", "a file that the reader writes"},
    {"server/docs/tutorial.md", "conformance/Field.Gravity.InverseSquare.xml", "a file that the reader writes"},
    {"server/docs/tutorial.md", "ball.xml", "a file that the reader writes"},
    {"server/docs/tutorial.md", "exchange.cpp", "a file that the reader writes"},
    {"server/docs/tutorial.md", "share/plab/idl/plab.idl", "where the IDL is installed"},
};
/// Options of other programs: docker, podman, cmake, scripts and programs of the tests.
constexpr std::string_view kForeignOptions[] = {"--format",  "--init",    "--no-healthcheck", "--component", "--network", "--internal",
                                                "--compile", "--seconds", "--pile",           "--all",       "--print",   "--strip"};

/// README.md of the root and of each folder, and server/docs without what is generated or describes the past.
std::vector<std::string> documents(const Declared& declared)
{
    std::vector<std::string> out;
    for (const std::string& path : declared.paths)
    {
        const std::string name = path.substr(path.rfind('/') + 1);
        const bool is_document = path.starts_with("server/docs/") && path.ends_with(".md") && name != "reference.md" &&
                                 name != "stability.md" && name != "changelog.md";
        if (name == "README.md" || is_document) out.push_back(path);
    }
    return out;
}

std::vector<NamedThing> all_named(const Declared& declared)
{
    std::vector<NamedThing> out;
    for (const std::string& document : documents(declared))
        for (NamedThing& thing : named_things(text_of_file(std::string(PLAB_SOURCE_DIR) + "/" + document), document))
            out.push_back(std::move(thing));
    return out;
}

std::string where(const NamedThing& thing) { return thing.document + ":" + std::to_string(thing.line) + ": `" + thing.text + "`"; }

std::string help_of(const std::string& name, const std::string& command = "")
{
    std::vector<std::string> line{program(name)};
    if (!command.empty()) line.push_back(command);
    line.emplace_back("--help");
    return run(line).output;
}

/// Why each of the things that `text` names does not exist.
std::vector<std::string> complaints(const std::string& text, const Declared& declared)
{
    std::vector<std::string> out;
    for (const NamedThing& thing : named_things(text, "server/docs/made_up.md"))
        if (const std::string reason = missing(thing, declared); !reason.empty()) out.push_back(std::to_string(thing.line) + ": " + reason);
    return out;
}

Declared made_up()
{
    Declared out;
    out.paths = {"README.md",          "server/", "server/run",          "server/docs/", "server/docs/step.md", "server/step/",
                 "server/step/tree.h", "tests/",  "tests/swaps_test.cpp"};
    out.builds = "plab_test(docs_names docs names_test.cpp)\n";
    out.reference = "# Types\n\n## Response\n\n### Response/None\n\n- exchangeable within: `Response`\n";
    complete(out);
    return out;
}

}  // namespace

TEST_CASE("names are found in sentences and tables, not in blocks of code")
{
    const auto found = named_things("Read `a.h` and\n`b\nc`.\n\n```\n`no`\n```\n| `d` | x |\none ` alone\n\n`e`\n", "t.md");
    std::vector<std::string> texts;
    for (const NamedThing& thing : found) texts.push_back(std::to_string(thing.line) + " " + thing.text);
    CHECK(texts == std::vector<std::string>{"1 a.h", "2 b c", "8 d", "11 e"});
}

TEST_CASE("a document that names what does not exist is found out")
{
    const Declared declared = made_up();
    const std::string good =
        "`server/run`, `server/docs/step.md`, `step.md`, `step/tree.h`, `server/step/`, `server/{run,docs}`, `server/docs/*.md`,\n"
        "`Response/None`, `Stage/Step`, `docs_names`, `reference_swaps`, `N m/s`, `plab/states`, `FILE.json`, `build/bin/plabd`\n";
    CHECK(complaints(good, declared).empty());
    CHECK(complaints("one\n`server/walk`\n", declared) == std::vector<std::string>{"2: no file or folder is called server/walk"});
    CHECK(complaints("`server/docs/stop.md`", declared) == std::vector<std::string>{"1: no file or folder is called server/docs/stop.md"});
    CHECK(complaints("`server/tree.h`", declared) == std::vector<std::string>{"1: no file or folder is called server/tree.h"});
    CHECK(complaints("`bush.h`", declared) == std::vector<std::string>{"1: no file or folder is called bush.h"});
    CHECK(complaints("`server/{run,walk}`", declared) == std::vector<std::string>{"1: no file or folder is called server/walk"});
    CHECK(complaints("`tests/*.md`", declared) == std::vector<std::string>{"1: no file or folder is called tests/*.md"});
    CHECK(complaints("`Response/Some`", declared) == std::vector<std::string>{"1: no type, family or command is called Response/Some"});
    CHECK(complaints("`Stage/Stop`", declared) == std::vector<std::string>{"1: no stage is called Stage/Stop"});
    CHECK(complaints("`reference_stops`", declared) == std::vector<std::string>{"1: no test is called reference_stops"});
}

TEST_CASE("commands and options are found in what a document names")
{
    CHECK(options_in("plabctl swap ID --at STEP --or-refuse") == std::vector<std::string>{"--at", "--or-refuse"});
    CHECK(options_in("--count N") == std::vector<std::string>{"--count"});
    CHECK(options_in("cmake --install BUILD").empty());
    CHECK(plabctl_command_in("plabctl swap gears") == "swap");
    CHECK(plabctl_command_in("plabctl COMMAND --help").empty());
    CHECK(has_word("  --at STEP", "--at"));
    CHECK_FALSE(has_word("  --at-once", "--at"));
}

TEST_CASE("files, types, stages and tests that documents name exist")
{
    const Declared declared = declared_in(PLAB_SOURCE_DIR);
    const std::vector<NamedThing> all = all_named(declared);
    CHECK(all.size() > 1000);
    std::set<const Foreign*> used;
    for (const NamedThing& thing : all)
    {
        const auto foreign = std::find_if(std::begin(kForeign), std::end(kForeign),
                                          [&](const Foreign& f) { return f.document == thing.document && f.text == thing.text; });
        if (foreign != std::end(kForeign))
        {
            used.insert(foreign);
            continue;
        }
        const std::string reason = missing(thing, declared);
        CHECK_MESSAGE(reason.empty(), where(thing) << ": " << reason);
    }
    for (const Foreign& f : kForeign) CHECK_MESSAGE(used.contains(&f), f.document << " does not name `" << f.text << "` any more");
}

TEST_CASE("commands and options of programs that documents name exist")
{
    const std::vector<NamedThing> all = all_named(declared_in(PLAB_SOURCE_DIR));
    const std::string overview = help_of("plabctl");
    REQUIRE(overview.size() > 100);
    std::string helps = overview;
    for (const char* name : {"plabd", "plab-log", "plab-view", "plab-web", "plab-foxglove", "plab-study"}) helps += help_of(name);
    // Commands begin lines of the overview. Of a word that is no command plabctl prints the overview again.
    std::set<std::string> commands;
    static const std::regex first_word("^ +([a-z]+)( .*)?$");
    std::istringstream in(overview);
    std::smatch match;
    for (std::string line; std::getline(in, line);)
    {
        if (!std::regex_match(line, match, first_word) || commands.contains(match[1].str())) continue;
        const std::string help = help_of("plabctl", match[1].str());
        if (help.empty() || help == overview) continue;
        commands.insert(match[1].str());
        helps += help;
    }
    CHECK(commands.size() > 30);
    for (const NamedThing& thing : all)
    {
        const std::string command = plabctl_command_in(thing.text);
        CHECK_MESSAGE((command.empty() || commands.contains(command)), where(thing) << ": plabctl has no command " << command);
    }
    for (const NamedThing& thing : all)
        for (const std::string& option : options_in(thing.text))
        {
            const bool is_foreign = std::find(std::begin(kForeignOptions), std::end(kForeignOptions), option) != std::end(kForeignOptions);
            CHECK_MESSAGE((is_foreign || has_word(helps, option)), where(thing) << ": no program has the option " << option);
        }
}

}  // namespace plab::test
