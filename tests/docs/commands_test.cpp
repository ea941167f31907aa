// Every command that README.md and server/docs/*.md show is run, against the programs of this build, each block with a server of its
// own in a folder of its own; what they print is compared with what is shown, in its shape.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "docs/shown_commands.h"
#include "support/process.h"

namespace plab::test
{
namespace
{

namespace fs = std::filesystem;

enum class How : std::uint8_t
{
    Skip,     ///< not run
    Follow,   ///< has no end of its own: Ctrl-C after two seconds, exit code 130
    Code,     ///< ends with `value` as exit code
    With,     ///< `value` is added to it
    Instead,  ///< `value` is run
    Before,   ///< `value` is run first
    Beside,   ///< `value` is run while it runs
};

/// A command that is not just run and expected to end with 0.
struct Special
{
    std::string_view begins;  ///< as the command does
    How how = How::Skip;
    std::string_view value, why;
};

constexpr Special kSpecial[] = {
    {"server/run ", How::Skip, "", "installs packages and builds"},
    {"tests/run ", How::Skip, "", "runs this test, among others"},
    {"cmake ", How::Skip, "", "builds and installs; tests/outside does it"},
    {"(cd build && cpack)", How::Skip, "", "makes packages; tests/outside does it"},
    {"docker ", How::Skip, "", "containers have a test of their own, tests/container"},
    {"podman ", How::Skip, "", "containers have a test of their own, tests/container"},
    {"DOCKER_HOST=", How::Skip, "", "containers have a test of their own, tests/container"},
    {"plabctl [OPTIONS] COMMAND", How::Skip, "", "a synopsis"},
    {"plabd SCENE [--name N]", How::Skip, "", "a synopsis"},
    {"plab-study SCENE --vary ID=TypeA", How::Skip, "", "a synopsis"},
    {"build/bin/plab-study --suite -o suite", How::With, "--list", "the studies take minutes; the list reads and checks all of them"},
    {"plab-study scenes/", How::With, "--list", "takes minutes; the list checks scene, ids, types and step lengths"},
    {"plabctl swap gears --to Field/Gravity", How::Code, "4", "shows a refusal"},
    {"plabctl diff run.mcap again.mcap", How::Code, "1", "the two differ"},
    {"build/bin/plabctl recover run.mcap", How::Code, "5", "shows a loss"},
    {"plabctl watch events   ", How::Follow, "", "until Ctrl-C"},
    {"plab-log --out run.log", How::Follow, "", "until Ctrl-C"},
    {"plab-web", How::Instead,
     "if [ -e build/share/plab/web/page.js ]; then timeout --preserve-status -k 5 -s INT 2 plab-web --write-address a.txt; [ $? = 130 ]; "
     "fi",
     "until Ctrl-C; without npm there is no page"},
    {"plab-foxglove --file", How::Instead, "timeout --preserve-status -k 5 -s INT 2 plab-foxglove --port 0 --file run.mcap; [ $? = 130 ]",
     "until Ctrl-C"},
    {"plab-foxglove", How::Instead, "timeout --preserve-status -k 5 -s INT 2 plab-foxglove --port 0; [ $? = 130 ]", "until Ctrl-C"},
    {"plabd scenes/imported/arm.urdf --ros", How::With, "--until 1", "has no end of its own"},
    {"plabctl topics rate plab/states", How::Follow, "", "until Ctrl-C"},
    {"plabctl watch events --json -n 1", How::Beside, "sleep 1; plabctl swap gears --to Constraint/AngularVelocity/Impulse",
     "waits for an event"},
    {"plabctl step 10 && plabctl wait --step 1239", How::Before, "plabctl resume; plabctl wait --step 1239; plabctl pause",
     "the step that is shown depends on when one asks"},
    {"plabctl record -o live.mcap -d 60", How::Instead, "plabctl record -o live.mcap -d 1", "a second will do"},
    {"plabctl watch collisions -n 3", How::Before, "plabctl reset", "the balloons meet 3.3 s into the scene"},
    {"plabctl pause --at 1000", How::Before, "plabctl reset", "that step has passed"},
    {"build/bin/plabctl rewind --by 1", How::Before, "plabctl wait --time 1.2", "so far back"},
};

/// Nothing in the table begins as the command does: it is run as it stands.
const Special* special_of(const std::string& command, std::set<std::string_view>& used)
{
    for (const Special& s : kSpecial)
        if (command.starts_with(s.begins))
        {
            used.insert(s.begins);
            return &s;
        }
    return nullptr;
}

/// Placeholders of the manual.
std::string filled_in(std::string text)
{
    const auto replace = [&](const std::string& what, const std::string& by)
    {
        for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
            text.replace(at, what.size(), by);
    };
    replace(" SCENE", " scenes/fan_and_balloons.xml");
    replace(" DIR", " out");
    static const bool has_jq = std::system("command -v jq > /dev/null") == 0;
    if (!has_jq) text = text.substr(0, text.find(" | jq"));
    return text;
}

std::string quoted(const std::string& text) { return "'" + std::regex_replace(text, std::regex("'"), "'\\''") + "'"; }

/// The block as a script that leaves what command i prints in I.out and its exit code in I.code.
std::string script_of(const ShownBlock& block, std::set<std::string_view>& used)
{
    std::ostringstream out;
    for (std::size_t i = 0; i < block.commands.size(); ++i)
    {
        const Special* const special = special_of(block.commands[i].text, used);
        std::string text = filled_in(block.commands[i].text), before, beside;
        if (special != nullptr) switch (special->how)
            {
                case How::Skip:
                    continue;
                case How::Follow:
                    text = "timeout --preserve-status -k 5 -s INT 2 " + text;
                    break;
                case How::With:
                    text = text.substr(0, text.find("  #")) + " " + std::string(special->value);
                    break;
                case How::Instead:
                    text = special->value;
                    break;
                case How::Before:
                    before = special->value;
                    break;
                case How::Beside:
                    beside = special->value;
                    break;
                case How::Code:
                    break;
            }
        const std::string n = std::to_string(i);
        if (!before.empty()) out << "{ " << before << "; } > before.out 2>&1\n";
        if (!beside.empty()) out << "( " << beside << " ) > beside.out 2>&1 &\n";
        out << "{ " << text << "\n} > " << n << ".out 2>&1\necho $? > " << n << ".code\n";
    }
    // Whatever is left of the block ends with it.
    out << "for job in $(jobs -p); do kill $job; done 2> /dev/null\nwait\n";
    return out.str();
}

std::string text_of(const fs::path& file)
{
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

std::vector<std::string> words_of(const std::string& line)
{
    std::istringstream in(line);
    std::vector<std::string> out;
    for (std::string word; in >> word;) out.push_back(word);
    return out;
}

bool has_digit(const std::string& word)
{
    return std::any_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::set<std::string> keys_in(const std::string& text)
{
    static const std::regex key("\"([A-Za-z_]+)\":");
    std::set<std::string> out;
    for (std::sregex_iterator at(text.begin(), text.end(), key), end; at != end; ++at) out.insert((*at)[1]);
    return out;
}

/// Why what is shown is not what is printed; "": nothing speaks against it. Compared are the first words of lines, all words of the head of
/// a table, the keys of JSON; not numbers, nor what stands for more ("...").
std::string stale_in(const ShownCommand& shown, const std::string& printed)
{
    std::set<std::string> first, all;
    std::istringstream lines(printed);
    for (std::string line; std::getline(lines, line);)
    {
        const std::vector<std::string> words = words_of(line);
        if (!words.empty()) first.insert(words.front());
        all.insert(words.begin(), words.end());
    }
    for (std::size_t i = 0; i < shown.output.size(); ++i)
    {
        const std::string& line = shown.output[i];
        const std::vector<std::string> words = words_of(line);
        if (words.empty() || words.front().starts_with("...")) continue;
        if (line.find('{') != std::string::npos || line.find("\":") != std::string::npos)
        {
            const std::set<std::string> keys = keys_in(printed);
            for (const std::string& key : keys_in(line))
                if (!keys.contains(key)) return "no key '" + key + "'";
            continue;
        }
        const bool is_head = i == 0 && words.size() >= 4 && !has_digit(line) && line.find("  ") != std::string::npos;
        if (is_head)
            for (const std::string& word : words)
                if (!all.contains(word)) return "no column '" + word + "'";
        if (!has_digit(words.front()) && !first.contains(words.front())) return "no line that begins with '" + words.front() + "'";
    }
    return {};
}

/// Recordings that the examples read: made once, without a bus.
fs::path recordings()
{
    static const fs::path folder = []
    {
        const fs::path made = scratch_file("recorded");
        fs::create_directories(made);
        for (const auto& [name, swap] :
             {std::pair{"run.mcap", "600:contact.response=Response/None"}, std::pair{"again.mcap", "100:contact.response=Response/Rows"}})
        {
            const Outcome run =
                test::run({program("plabd"), scene_file("fan_and_balloons.xml"), "--no-bus", "--until", "4", "--record",
                           (made / name).string(), "--swap", swap, "--swap", "700:gears=Constraint/AngularVelocity/Impulse"});
            REQUIRE_MESSAGE(run.code == 0, run.errors);
        }
        return made;
    }();
    return folder;
}

bool mentions(const ShownBlock& block, const std::string& text)
{
    return std::any_of(block.commands.begin(), block.commands.end(),
                       [&](const ShownCommand& c) { return c.text.find(text) != std::string::npos; });
}

/// The folder that a block is run in: the tree as one sees it, and the files that the examples speak of.
fs::path folder_for(const ShownBlock& block, std::size_t number)
{
    const fs::path folder = scratch_file("block_" + std::to_string(number)), source = PLAB_SOURCE_DIR;
    fs::create_directories(folder);
    for (const char* name : {"scenes", "idl", "clients", "server"}) fs::create_directory_symlink(source / name, folder / name);
    fs::create_directory_symlink(PLAB_BINARY_DIR, folder / "build");
    std::ofstream(folder / "ball.xml") << R"(<plab version="1"><component id="blue" type="State/RigidBody" mass="20 g" )"
                                          R"(inertia="1e-5 1e-5 1e-5" position="3 0 1"/></plab>)";
    const bool makes_its_own = mentions(block, "record -o run.mcap") || mentions(block, "--record run.mcap");
    for (const char* name : {"run.mcap", "again.mcap"})
        if (!makes_its_own) fs::copy_file(recordings() / name, folder / name);
    return folder;
}

std::uint32_t domain() { return 20 + static_cast<std::uint32_t>(getpid()) % 200; }

std::vector<std::string> environment()
{
    return {"PLAB_DOMAIN=" + std::to_string(domain()), "PLAB_SERVER", "PLAB_INTERFACE", "NO_COLOR=1",
            "PATH=" + std::string(PLAB_BINARY_DIR) + "/bin:" + std::getenv("PATH")};
}

Outcome shell(const fs::path& folder, const std::string& script, Milliseconds timeout)
{
    return run({"bash", "-c", "cd " + quoted(folder.string()) + " && " + script}, timeout, environment());
}

/// A server of the examples' name that is a second into its scene, with a snapshot "before"; four times as fast as real time.
class Lab
{
public:
    explicit Lab(const fs::path& folder)
        : server_({"bash", "-c",
                   "cd " + quoted(folder.string()) + " && exec plabd scenes/fan_and_balloons.xml --name lab --rate 4 --states all"},
                  environment())
    {
        REQUIRE_MESSAGE(server_.wait_for("ready after", Milliseconds(10000)), server_.errors());
        const Outcome ready = shell(folder, "plabctl wait --time 1 && plabctl snapshot before", Milliseconds(15000));
        REQUIRE_MESSAGE(ready.code == 0, ready.errors);
    }
    ~Lab()
    {
        server_.signal(15);
        (void)server_.wait(Milliseconds(5000));
    }
    Lab(const Lab&) = delete;
    Lab& operator=(const Lab&) = delete;

private:
    Process server_;
};

std::string expected_code(const ShownCommand& command, std::set<std::string_view>& used)
{
    const Special* const special = special_of(command.text, used);
    if (special == nullptr) return "0";
    if (special->how == How::Follow) return "130";
    return special->how == How::Code ? std::string(special->value) : "0";
}

void check(const ShownBlock& block, const fs::path& folder, std::set<std::string_view>& used)
{
    for (std::size_t i = 0; i < block.commands.size(); ++i)
    {
        const ShownCommand& command = block.commands[i];
        const Special* const special = special_of(command.text, used);
        if (special != nullptr && special->how == How::Skip) continue;
        const std::string printed = text_of(folder / (std::to_string(i) + ".out"));
        const std::vector<std::string> code = words_of(text_of(folder / (std::to_string(i) + ".code")));
        CHECK_MESSAGE((code.empty() ? "none" : code.front()) == expected_code(command, used), block.where << ": " << command.text << "\n"
                                                                                                          << printed);
        const std::string stale = stale_in(command, printed);
        CHECK_MESSAGE(stale.empty(), block.where << ": " << command.text << ": what is shown below it is not what it prints: " << stale
                                                 << "\n"
                                                 << printed);
    }
}

void run_block(const ShownBlock& block, std::size_t number, std::set<std::string_view>& used)
{
    const std::string script = script_of(block, used);
    const bool is_run = script.find(".code") != std::string::npos;
    if (!is_run) return;
    const fs::path folder = folder_for(block, number);
    const bool has_its_own_server = mentions(block, "plabd scenes/") && !mentions(block, "--no-bus");
    const bool needs_server = mentions(block, "plabctl ") || mentions(block, "plab-log") || mentions(block, "plab-view") ||
                              mentions(block, "plab-web") || mentions(block, "plab-foxglove");
    std::unique_ptr<Lab> lab;
    if (needs_server && !has_its_own_server) lab = std::make_unique<Lab>(folder);
    const Outcome done = shell(folder, script, Milliseconds(60000));
    CHECK_MESSAGE(done.code != -1, block.where << ": does not end");
    check(block, folder, used);
    std::error_code ignored;
    fs::remove_all(folder, ignored);
}

std::vector<ShownBlock> all_blocks()
{
    const fs::path root = PLAB_SOURCE_DIR;
    // The one is generated; the other is run against what is installed, by tests/outside.
    const std::set<fs::path> elsewhere{"reference.md", "tutorial.md"};
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(root / "server/docs"))
        if (entry.path().extension() == ".md" && !elsewhere.contains(entry.path().filename())) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    files.insert(files.begin(), root / "README.md");
    std::vector<ShownBlock> out;
    for (const fs::path& file : files)
        for (ShownBlock& block : shown_commands(text_of(file), fs::relative(file, root).string())) out.push_back(std::move(block));
    return out;
}

}  // namespace

TEST_CASE("commands, their continued lines, and what is shown below them are found in a document")
{
    const auto blocks = shown_commands(
        "# T\n\n```\n$ plabctl a \\\n    b\nout 1\n\n$ plabctl c; plabd d\n```\n"
        "```xml\n<plab/>\n```\n  ```\n  plab-study S --x 1\n       --y 2\n  server/run   # words\n  ```\n"
        "| command | example |\n|---|---|\n| `rate` | `plabctl rate 1`; or `plabctl rate` |\n| `no` | none |\n",
        "t.md");
    REQUIRE(blocks.size() == 3);
    CHECK(blocks[0].where == "t.md:3");
    REQUIRE(blocks[0].commands.size() == 2);
    CHECK(blocks[0].commands[0].text == "plabctl a  b");
    CHECK(blocks[0].commands[0].output == std::vector<std::string>{"out 1"});
    CHECK(blocks[0].commands[1].text == "plabctl c; plabd d");
    REQUIRE(blocks[1].commands.size() == 2);
    CHECK(blocks[1].commands[0].text == "plab-study S --x 1 --y 2");
    CHECK(blocks[2].commands[0].text == "plabctl rate 1");
}

TEST_CASE("output that is not what a command prints is found")
{
    const std::string printed = "server  state\nlab     running\n  kept  mesh\n{\"run\":1,\"time\":2.5}\n";
    CHECK(stale_in({"c", {"lab     paused", "  kept  other", "{\"run\":7}", "..."}}, printed).empty());
    CHECK(stale_in({"c", {"dropped  mesh"}}, printed) == "no line that begins with 'dropped'");
    CHECK(stale_in({"c", {"server  state  host  up"}}, printed) == "no column 'host'");
    CHECK(stale_in({"c", {"{\"rnu\":7}"}}, printed) == "no key 'rnu'");
}

TEST_CASE("every command of README.md and server/docs does what the text says")
{
    std::set<std::string_view> used;
    const std::vector<ShownBlock> blocks = all_blocks();
    CHECK(blocks.size() > 40);
    const char* const only = std::getenv("PLAB_DOCS_ONLY");  // part of a place, such as "plabctl.md:11": to look at one
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (only == nullptr || blocks[i].where.find(only) != std::string::npos) run_block(blocks[i], i, used);
    if (only != nullptr) return;
    for (const Special& s : kSpecial) CHECK_MESSAGE(used.contains(s.begins), "no command begins with '" << s.begins << "' any more");
}

}  // namespace plab::test
