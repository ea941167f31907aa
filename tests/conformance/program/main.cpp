// plab-conformance LIBRARY: whether a plugin keeps what every plugin promises (../README.md). The checks are those of pLab's own tests.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "program/plain_help.h"
#include "subjects.h"

namespace
{

namespace fs = std::filesystem;

plab::program::CommandOutline outline()
{
    using namespace plab::program;
    CommandOutline out;
    out.name = "plab-conformance", out.help = "plab-conformance: checks that a plugin keeps what every plugin promises";
    out.places = {place_of_file("LIBRARY", "the plugin: a .so with its .manifest beside it")};
    out.options = {option_with("--scenes", "DIR",
                               "where its types have their scenes (may be repeated), before those of pLab; default: \"conformance\" beside "
                               "LIBRARY"),
                   flag("--extremes", "instead: numeric fields at the ends of what numbers hold"),
                   flag("--list", "only say which types and scenes there are")};
    out.footer =
        R"(A plugin that conforms describes its types, refuses bad values, steps alike from a memento, in any order and with any number of
threads, asks for no memory in a warm step, and can be exchanged without a trace.
Scenes: TYPE.xml, with dots for slashes; $TYPE stands for the type in it, and the component under test has the id "subject".
Plugins that the scenes need are looked for in the folders of PLAB_PLUGIN_PATH and among those installed with this program.
Exit codes: 0 it conforms, 1 it does not, 2 wrong use)";
    return out;
}

struct ConformanceOptions
{
    std::string library;
    std::vector<std::string> scenes;
    bool extremes = false, list = false;
};

/// Nothing: not to be understood.
std::optional<ConformanceOptions> parse(const std::vector<std::string>& words)
{
    ConformanceOptions out;
    for (std::size_t i = 0; i < words.size(); ++i)
        if (words[i] == "--scenes" && i + 1 < words.size())
            out.scenes.push_back(words[++i]);
        else if (words[i] == "--extremes")
            out.extremes = true;
        else if (words[i] == "--list")
            out.list = true;
        else if (!words[i].starts_with("-") && out.library.empty())
            out.library = words[i];
        else
            return {};
    if (out.library.empty()) return {};
    return out;
}

void choose(const ConformanceOptions& options)
{
    using namespace plab;
    const fs::path file = fs::weakly_canonical(options.library);
    test::target().plugin = file.string();
    test::target().scene_folders = options.scenes;
    if (options.scenes.empty()) test::target().scene_folders.push_back((file.parent_path() / "conformance").string());
    test::plugin_folders() = {file.parent_path().string()};
    for (const std::string& folder : plugins::PluginLibrary::default_directories()) test::plugin_folders().push_back(folder);
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    test::target().scene_folders.push_back((program.parent_path() / "../share/plab/conformance").lexically_normal().string());
}

int list()
{
    for (const plab::test::Subject& s : plab::test::subjects()) std::printf("%s: %s\n", s.type.c_str(), s.blueprint.file.c_str());
    for (const std::string& why : plab::test::subjects_missing()) std::printf("%s\n", why.c_str());
    return plab::test::subjects_missing().empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv)
{
    if (const auto answer = plab::program::answer_about(outline(), PLAB_VERSION, argc, argv))
        return std::fputs(answer->c_str(), stdout) < 0 ? 1 : 0;
    const auto options = parse({argv + 1, argv + argc});
    if (!options) return std::fputs(plab::program::help_text(outline()).c_str(), stderr), 2;
    if (const auto opened = plab::plugins::open_plugin(options->library); !opened)
        return std::fprintf(stderr, "plab-conformance: %s\n", opened.error().text().c_str()), 1;
    choose(*options);
    if (options->list) return list();
    doctest::Context context;
    context.setOption("no-intro", true);
    context.setOption("no-version", true);
    context.setOption("no-path-filenames", true);
    constexpr const char* kExtremes = "numeric fields*";
    context.addFilter(options->extremes ? "test-case" : "test-case-exclude", kExtremes);
    const int code = context.run();
    std::printf("%s: %zu types %s\n", options->library.c_str(), plab::test::tested_types().size(),
                code == 0 ? "conform" : "do not conform");
    return code;
}
