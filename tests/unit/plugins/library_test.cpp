#include <doctest/doctest.h>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "plugins/library.h"

using namespace plab;
using plugins::PluginLibrary;
namespace fs = std::filesystem;

namespace
{

const std::string kSamples = SAMPLE_DIR;

std::string sample(const std::string& flaw) { return kSamples + "/sample_" + flaw + ".so"; }

const std::string kHead = "plab-manifest 3\nplugin\tsample\n";

/// A line for a type of which only the name is given.
std::string bare_type(const std::string& name) { return "type\t" + name + "\tSample\t0\t\t\t\t\t\t\n"; }

std::string manifest(const std::string& types)
{
    std::string out = kHead;
    for (std::size_t begin = 0; begin < types.size();)
    {
        const std::size_t end = std::min(types.find('\n', begin), types.size());
        out += bare_type(types.substr(begin, end - begin));
        begin = end + 1;
    }
    return out;
}

/// A folder of plugins for one test.
class Folder
{
public:
    explicit Folder(const std::string& name)
        : path_(fs::temp_directory_path() / ("plab_library_test_" + std::to_string(getpid()) + "_" + name))
    {
        fs::remove_all(path_);
        fs::create_directories(path_);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path_); }

    std::string path() const { return fs::canonical(path_).string(); }
    std::string file(const std::string& name) const { return path() + "/" + name; }
    void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
    /// A manifest that lists `types`, a line each, and beside it the sample with this flaw.
    void plugin(const std::string& name, const std::string& flaw, const std::string& types) const
    {
        write(name + ".manifest", manifest(types));
        if (!flaw.empty()) fs::copy_file(sample(flaw), path_ / (name + ".so"));
    }

private:
    fs::path path_;
};

std::string refusal(PluginLibrary& library, const std::string& type)
{
    const auto result = library.require(type);
    return result.ok() ? "accepted" : result.error().text();
}

std::string load_refusal(const std::string& flaw)
{
    PluginLibrary library(std::vector<std::string>{});
    const auto result = library.load_plugin(sample(flaw));
    CHECK(library.loaded().empty());
    CHECK(library.names().empty());
    return result.ok() ? "accepted" : result.error().text();
}

bool is_mapped(const std::string& path)
{
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
        if (line.find(path) != line.npos) return true;
    return false;
}

}  // namespace

TEST_CASE("a plugin is loaded when one of its types is asked for, not before")
{
    const Folder folder("demand");
    folder.plugin("good", "none", "Sample/Good\nSample/Better\n");
    PluginLibrary library({folder.path()});
    CHECK(library.problems().empty());
    CHECK(library.names() == std::vector<std::string>{"Sample/Better", "Sample/Good"});
    CHECK(library.loaded().empty());
    CHECK(!is_mapped(folder.file("good.so")));

    const auto type = library.require("Sample/Good");
    REQUIRE_MESSAGE(type.ok(), (type.ok() ? "" : type.error().text()));
    CHECK((*type)->info.name == "Sample/Good");
    CHECK((*type)->plugin == "sample");
    REQUIRE((*type)->schema.find_field("value"));
    CHECK((*type)->schema.find_field("value")->fallback == Value(2.0));
    CHECK(is_mapped(folder.file("good.so")));
    REQUIRE(library.loaded().size() == 1);
    CHECK(library.loaded()[0].name == "sample");
    CHECK(library.loaded()[0].path == folder.file("good.so"));
    CHECK(library.loaded()[0].types == std::vector<std::string>{"Sample/Good", "Sample/Better"});

    const auto same = library.require("Sample/Good");
    CHECK(*same == *type);
    CHECK(library.require("Sample/Better").ok());
    CHECK(library.loaded().size() == 1);
}

TEST_CASE("the destructor of a library unloads its plugins after their types")
{
    const Folder folder("gone");
    folder.plugin("good", "none", "Sample/Good\n");
    {
        PluginLibrary library({folder.path()});
        REQUIRE(library.require("Sample/Good").ok());
        CHECK(is_mapped(folder.file("good.so")));
    }
    CHECK(!is_mapped(folder.file("good.so")));
}

TEST_CASE("unknown types: the nearest names of all manifests, and what could not be read")
{
    const Folder a("near_a"), b("near_b");
    a.plugin("x", "", "Solver/RungeKutta4\n");
    b.plugin("y", "", "Solver/SemiImplicitEuler\n");
    PluginLibrary library({a.path(), b.path(), a.path() + "/../" + fs::path(a.path()).filename().string()});
    CHECK(library.names().size() == 2);
    CHECK(refusal(library, "Solver/RungeKuta4") == "unknown type 'Solver/RungeKuta4', did you mean 'Solver/RungeKutta4'?");
    CHECK(refusal(library, "") == "unknown type ''");
    CHECK(refusal(library, "Solver/RungeKutta4").find("cannot be loaded") != std::string::npos);  // and not that it is in two plugins

    PluginLibrary nowhere({a.file("missing")});
    CHECK(refusal(nowhere, "A/B") ==
          "unknown type 'A/B'; no plugins were found; plugin folder " + a.file("missing") + " cannot be read: No such file or directory");
}

TEST_CASE("a type in two plugins is refused, naming both; the other types are available")
{
    const Folder folder("two");
    folder.plugin("a", "none", "Sample/Good\nSample/Better\n");
    folder.plugin("b", "none", "Sample/Good\n");
    PluginLibrary library({folder.path()});
    CHECK(refusal(library, "Sample/Good") ==
          "type 'Sample/Good' is in two plugins, " + folder.file("a.so") + " and " + folder.file("b.so") + "; remove one of them");
    CHECK(refusal(library, "Sample/Better") == "accepted");
}

TEST_CASE("bad manifests are reported as problems and do not stop the search")
{
    const Folder folder("bad");
    struct Case
    {
        std::string text, problem;
    };
    const std::vector<Case> cases{
        {"plab-manifest 1\nA/B\n", ":1:1: is not a manifest of this version: the first line must be 'plab-manifest 3'"},
        {"", ": cannot be read"},
        {"plab-manifest 3\n" + bare_type("A/B"), ": names no plugin"},
        {kHead + "plugin\tother\n", ":3:1: names a second plugin"},
        {kHead + bare_type("A/B") + bare_type("no spaces please"), ":4:1: is not a type name; letters, digits, '_' and '/' are allowed"},
        {kHead + bare_type("A/B") + bare_type("C/D") + bare_type("A/B"), ": names A/B twice"},
        {kHead + "A/B\n", ":3:1: does not begin with a keyword of a manifest; plugin, type, role and field are allowed"},
        {kHead + "type\tA/B\tA\t0\n", ":3:1: a 'type' line has 10 cells, not 4"},
        {kHead + "type\tA/B\tA\t4x\t\t\t\t\t\t\n", ":3:1: the order of convergence is not a whole number in range"},
        {kHead + "field\tx\tparam\treal\tm\t0\toptional\t\t\n", ":3:1: a field before the first type"},
        {kHead + bare_type("A/B") + "field\tx\tparam\treal\tm\t0\tmaybe\t\t\n", ":4:1: a field must be 'required' or 'optional'"},
        {kHead + bare_type("A/B") + "role\tx\tbody\t1\t4294967296\t\n",
         ":4:1: the largest number of participants is not a whole number in range"},
        {kHead + "type\tA/B\tA\t0\tdo\\c\t\t\t\t\t\n", ":3:1: holds a '\\' that is neither '\\\\' nor '\\x' and two digits"},
        {kHead + "type\tA/B\tA\t0\tdo\\x0\t\t\t\t\t\n", ":3:1: holds a '\\' that is neither '\\\\' nor '\\x' and two digits"},
        {kHead + "type\tA/B\tA\t0\tdo\rc\t\t\t\t\t\n", ":3:1: holds a control character; it must be written as \\x and two digits"},
    };
    std::vector<std::string> expected;
    for (std::size_t i = 0; i < cases.size(); ++i)
    {
        const std::string name = std::string(1, static_cast<char>('a' + i)) + ".manifest";
        folder.write(name, cases[i].text);
        expected.push_back(folder.file(name) + cases[i].problem);
    }
    folder.write("z.manifest", kHead + "\n" + bare_type("E/F"));
    folder.write("not_a_manifest.txt", "A/B");
    PluginLibrary library({folder.path()});
    std::vector<std::string> problems;
    for (const Error& e : library.problems()) problems.push_back(e.text());
    CHECK(problems == expected);
    CHECK(library.names() == std::vector<std::string>{"E/F"});
    CHECK(refusal(library, "G/H").find("a.manifest:1:1") != std::string::npos);
}

TEST_CASE("a manifest without its plugin, and one that lists too many types")
{
    const Folder folder("promise");
    folder.plugin("missing", "", "Sample/Missing\n");
    folder.plugin("liar", "none", "Sample/Good\nSample/Other\n");
    PluginLibrary library({folder.path()});
    const std::string missing = refusal(library, "Sample/Missing");
    CHECK(missing.starts_with("plugin " + folder.file("missing.so") + ": cannot be loaded: "));
    CHECK(refusal(library, "Sample/Missing") == missing);
    CHECK(refusal(library, "Sample/Other") ==
          "type 'Sample/Other' is in " + folder.file("liar.manifest") + ", but its plugin does not declare it; build the plugin again");
    CHECK(refusal(library, "Sample/Good") == "accepted");
}

TEST_CASE("each mismatch of the stamp has its own message")
{
    const std::string again = "; build it again with this SDK";
    CHECK(load_refusal("version") == "plugin " + sample("version") + ": was built for version 2 of the SDK, version 1 is needed" + again);
    CHECK(load_refusal("size") == "plugin " + sample("size") + ": its stamp has " + std::to_string(sizeof(PluginStamp) + 8) + " bytes, " +
                                      std::to_string(sizeof(PluginStamp)) + " are needed" + again);
    CHECK(load_refusal("layout") == "plugin " + sample("layout") +
                                        ": its structures are laid out differently: layout 42 (compiler " __VERSION__ "), " +
                                        std::to_string(layout_stamp()) + " (compiler " __VERSION__ ") is needed" + again);
    CHECK(load_refusal("name") == "plugin " + sample("name") + ": its stamp has no name");
    CHECK(load_refusal("stamp") == "plugin " + sample("stamp") + ": is not a pLab plugin: it has no symbol plab_plugin_stamp");
    CHECK(load_refusal("entry") == "plugin " + sample("entry") + ": has no symbol plab_plugin_register");
}

TEST_CASE("plugins that fail while registering leave no types behind")
{
    CHECK(load_refusal("throws") == "plugin " + sample("throws") + ": threw an exception while registering its types");
    CHECK(load_refusal("empty") == "plugin " + sample("empty") + ": declares no types");
    CHECK(load_refusal("twice") == "plugin " + sample("twice") + ": Sample/Good: is declared twice");
}

TEST_CASE("a failure is reported each time, and the same types can be loaded from a good plugin later")
{
    const Folder folder("again");
    folder.plugin("twice", "twice", "Sample/Good\n");
    PluginLibrary library({folder.path()});
    const std::string first = refusal(library, "Sample/Good");
    CHECK(first == "plugin " + folder.file("twice.so") + ": Sample/Good: is declared twice");
    CHECK(refusal(library, "Sample/Good") == first);
    CHECK(library.loaded().empty());
    REQUIRE(library.load_plugin(sample("none")).ok());
    CHECK(refusal(library, "Sample/Good") == "accepted");
}

TEST_CASE("load_plugin: a second call has no effect; other plugins with the same types and files that are not libraries are refused")
{
    PluginLibrary library(std::vector<std::string>{});
    const auto first = library.load_plugin(sample("none"));
    REQUIRE(first.ok());
    CHECK(first->types.size() == 2);
    CHECK(library.load_plugin(kSamples + "/../" + fs::path(kSamples).filename().string() + "/sample_none.so").ok());
    CHECK(library.loaded().size() == 1);
    CHECK(library.names().size() == 2);

    const Folder folder("copy");
    folder.plugin("copy", "none", "Sample/Good\n");
    const auto copy = library.load_plugin(folder.file("copy.so"));
    REQUIRE(!copy.ok());
    CHECK(copy.error().text() == "plugin " + folder.file("copy.so") + ": Sample/Good: is already declared by plugin 'sample'");
    CHECK(library.loaded().size() == 1);

    folder.write("text.so", "no library");
    const auto text = library.load_plugin(folder.file("text.so"));
    REQUIRE(!text.ok());
    CHECK(text.error().text().starts_with("plugin " + folder.file("text.so") + ": cannot be loaded: "));
}

TEST_CASE("where plugins are searched for")
{
    unsetenv("PLAB_PLUGIN_PATH");
    const auto installed = PluginLibrary::default_directories();
    REQUIRE(installed.size() == 1);
    CHECK(fs::path(installed[0]) == fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "lib" / "plab");
    setenv("PLAB_PLUGIN_PATH", ":/a/b::/c:", 1);
    CHECK(PluginLibrary::default_directories() == std::vector<std::string>{"/a/b", "/c", installed[0]});
    setenv("PLAB_PLUGIN_PATH", "/a/b", 1);
    CHECK(PluginLibrary().require("State/RigidBody"));  // an additional folder does not replace the default one
    setenv("PLAB_PLUGIN_PATH", "", 1);
    CHECK(PluginLibrary::default_directories() == installed);
    unsetenv("PLAB_PLUGIN_PATH");
}

TEST_CASE("manifests are written sorted, completely or not at all, and read back with any text")
{
    const Folder folder("write");
    model::TypeSummary odd, plain;
    plain.name = "A/B", plain.family = "A", plain.plugin = odd.plugin = "sample";
    odd.name = "B/C", odd.family = "B", odd.doc = "a tab\t, a line\nbreak, a back\\slash, \x7f and \xc3\xa9";
    odd.order = -3, odd.accuracy = "1e-12", odd.strengths = "\t", odd.cost = "\\x41", odd.limits = " ", odd.source = "|";
    odd.roles = {{"between", "body or shaft", "bodies\r", 0, 4294967295}};
    odd.fields = {{"code", "param", "text", "", "x = 1\n\ty = 2", "", "", false},
                  {"mass", "param", "real", "kg", "", "positive", "", true}};
    REQUIRE(plugins::write_manifest(folder.file("m.manifest"), "sample", {odd, plain}).ok());
    const auto back = plugins::read_manifest(folder.file("m.manifest"));
    REQUIRE_MESSAGE(back.ok(), (back.ok() ? "" : back.error().text()));
    CHECK(back->types == std::vector<std::string>{"A/B", "B/C"});
    CHECK(back->summaries == std::vector<model::TypeSummary>{plain, odd});
    CHECK(back->plugin == folder.file("m.so"));
    CHECK(!fs::exists(folder.file("m.manifest.tmp")));
    const auto nowhere = plugins::write_manifest(folder.file("missing/m.manifest"), "sample", {plain});
    REQUIRE(!nowhere.ok());
    CHECK(nowhere.error().text() == folder.file("missing/m.manifest.tmp") + ": cannot be written");
}

TEST_CASE("a type is described identically by its manifest and by its plugin")
{
    PluginLibrary library({PLAB_BINARY_DIR "/lib/plab"});
    std::vector<model::TypeSummary> reported = library.summaries();
    CHECK(library.loaded().empty());
    REQUIRE(reported.size() == library.names().size());
    REQUIRE(reported.size() > 20);
    for (model::TypeSummary& type : reported)
    {
        CHECK(!type.loaded);
        CHECK(!type.family.empty());
        REQUIRE(library.require(type.name).ok());
        type.loaded = true;
    }
    CHECK(library.summaries() == reported);

    const auto named = [&](const std::string& name)
    { return std::find_if(reported.begin(), reported.end(), [&](const auto& t) { return t.name == name; }); };
    const model::TypeSummary& gravity = *named("Field/Gravity");
    CHECK(gravity.plugin == "fields");
    REQUIRE(gravity.fields.size() == 1);
    CHECK(gravity.fields[0] ==
          model::FieldSummary{"acceleration", "param", "vector", "m/s^2", "0 0 -9.81", "", "of free fall, in the world", false});
    REQUIRE(gravity.roles.size() == 1);
    CHECK(gravity.roles[0].accepts == "body");
    CHECK(gravity.roles[0].least == 1);
    CHECK(gravity.roles[0].most == 4294967295);
    CHECK(named("Solver/RungeKutta4")->order == 4);
}

TEST_CASE("rules and defaults in words")
{
    PluginLibrary library(std::vector<std::string>{});
    REQUIRE(library.load_plugin(sample("none")).ok());
    const std::vector<model::TypeSummary> types = library.summaries();
    REQUIRE(types.size() == 2);
    CHECK(types[0].name == "Sample/Better");
    CHECK(types[0].loaded);
    CHECK(types[0].fields == std::vector<model::FieldSummary>{{"value", "param", "real", "m", "2", "positive", "a length", false}});
}
