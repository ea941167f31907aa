// The tree against table.h, and each rule against files that break it.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "rules.h"
#include "table.h"

using namespace plab::architecture;

namespace
{

const std::vector<File>& tree()
{
    static const std::vector<File> files = read_tree(PLAB_SOURCE_DIR);
    return files;
}

template <class Check>
int complain_about(Check&& check, bool sources_only)
{
    int checked = 0;
    for (const File& file : tree())
    {
        if (sources_only && !is_source(file.path)) continue;
        ++checked;
        for (const std::string& complaint : check(file)) FAIL_CHECK(complaint);
    }
    return checked;
}

bool breaks(const char* path, const std::string& text)
{
    static const Paths known = paths_of(tree());
    return !check_includes({path, text + "\n"}, known).empty();
}

}  // namespace

TEST_CASE("every include runs downhill")
{
    const Paths known = paths_of(tree());
    CHECK(complain_about([&](const File& file) { return check_includes(file, known); }, true) > 200);
}

TEST_CASE("no files include one another in a circle")
{
    for (const std::string& circle : check_circles(tree())) FAIL_CHECK(circle);
    const std::vector<File> knot{{"server/model/a.h", "#include \"model/b.h\"\n"},
                                 {"server/model/a.cpp", ""},
                                 {"server/model/b.h", ""},
                                 {"server/model/b.cpp", "#include \"model/a.h\"\n"}};
    CHECK(check_circles(knot) == Complaints{"server/model/a -> server/model/b -> server/model/a"});
    CHECK(check_circles({knot[0], knot[2]}).empty());
}

TEST_CASE("no folders include one another in a circle, in the sources or by the table")
{
    for (const std::string& complaint : check_folder_circles(tree())) FAIL_CHECK(complaint);
    // No two of these files include one another.
    const std::vector<File> knot{{"server/study/write.cpp", "#include \"study/plot/plot.h\"\n"},
                                 {"server/study/study.h", ""},
                                 {"server/study/plot/plot.h", "#include \"study/study.h\"\n"}};
    CHECK(check_circles(knot).empty());
    CHECK(check_folder_circles(knot) == Complaints{"server/study -> server/study/plot -> server/study"});
    CHECK(check_folder_circles({knot[1], knot[2]}).empty());

    for (const std::string& complaint : check_table(layers())) FAIL_CHECK(complaint);
    CHECK(check_table({{"a", {"b"}, {}}, {"b", {"c"}, {}}, {"c", {"a"}, {}}}) == Complaints{"a -> b -> c -> a"});
    CHECK(check_table({{"a/x", {"b"}, {}}, {"b", {"a"}, {}}}) == Complaints{"a/x -> b -> a/x"});
    CHECK(check_table({{"a/x", {"a"}, {}}, {"a", {"b"}, {}}, {"b", {}, {}}}).empty());
}

TEST_CASE("each folder of the rooms with many has a row of its own")
{
    for (const std::string& complaint : check_own_rows(paths_of(tree()))) FAIL_CHECK(complaint);
    for (const char* folder : {"server/simulation/new_room", "server/simulation/step/new_room", "interactions/fields/new_room",
                               "clients/viewer/new_room", "idl/new_room"})
        CHECK(check_own_rows({std::string(folder) + "/a.cpp"}) == Complaints{std::string(folder) + ": has no row of its own in the table"});
    CHECK(check_own_rows({"server/simulation/step/a.cpp", "interactions/fields/a.cpp", "server/new_room/a.cpp"}).empty());
}

TEST_CASE("a class has no friends in other folders")
{
    for (const std::string& complaint : check_friends(tree())) FAIL_CHECK(complaint);
    const File house{"server/world/a.h", "class A\n{\n    friend class Guest;\n};\n"};
    CHECK(check_friends({house, {"server/model/b.h", "class Guest final : public B\n{\n};\n"}}) ==
          Complaints{"server/world/a.h: has a friend of another folder: Guest"});
    CHECK(check_friends({house, {"server/world/b.h", "class Guest\n{\n};\n"}}).empty());
}

TEST_CASE("the table names folders that exist")
{
    for (const Layer& layer : layers())
    {
        const std::string_view folder = layer.folder.substr(0, layer.folder.find("/*"));
        CAPTURE(folder);
        CHECK(std::ranges::any_of(tree(), [&](const File& file) { return file.path.starts_with(folder); }));
    }
}

TEST_CASE("Eigen is included by sources, and through plab/eigen.h")
{
    // That header sets how Eigen computes. Any other header would add two seconds to every source that includes it.
    const auto has = [](const File& file, std::string_view what) { return file.text.find(what) != std::string::npos; };
    for (const File& file : tree())
    {
        if (!is_source(file.path) || file.path.starts_with("tests/") || file.path == "server/sdk/plab/eigen.h") continue;
        CAPTURE(file.path);
        const bool asks = has(file, "#include \"plab/eigen.h\""), may = !file.path.ends_with(".h");
        CHECK((!has(file, "<Eigen/") || (asks && may)));
        CHECK((!asks || may || file.path == "server/linear/dense_view.h"));
    }
}

TEST_CASE("headers that take long to compile are parsed where they are needed only")
{
    // nlohmann: headers name its types by <nlohmann/json_fwd.hpp>. CLI11: one file of a program, which hands its options to the rest.
    std::map<std::string, int> files_with_parser;
    for (const File& file : tree())
    {
        if (!is_source(file.path) || file.path.starts_with("tests/")) continue;
        CAPTURE(file.path);
        CHECK((!file.path.ends_with(".h") || file.text.find("<nlohmann/json.hpp>") == std::string::npos));
        if (file.text.find("<CLI/CLI.hpp>") == std::string::npos) continue;
        const std::size_t folder = file.path.find('/', file.path.find('/') + 1);
        ++files_with_parser[file.path.substr(0, folder)];
    }
    CHECK(files_with_parser.size() == 8);  // plabctl, plab-log, plab-view, plab-web, plab-foxglove, plabd, plab-study, and what all of them share
    for (const auto& [folder, files] : files_with_parser)
    {
        CAPTURE(folder);
        CHECK(files == 1);
    }
}

TEST_CASE("no file is long")
{
    for (const File& file : tree())
        if (is_source(file.path))
            for (const std::string& long_file : check_length(file, kLinesWanted)) MESSAGE(long_file);
    CHECK(complain_about([](const File& file) { return check_length(file, kLinesAllowed); }, true) > 200);
}

TEST_CASE("nothing is left to be done") { CHECK(complain_about(check_leftovers, false) > 300); }

TEST_CASE("no file names a folder of one machine") { CHECK(complain_about(check_machine_paths, false) > 300); }

TEST_CASE("every folder that builds something says what it is for") { CHECK(check_readmes(paths_of(tree())) == Complaints{}); }

TEST_CASE("what breaks the table is seen, layer by layer")
{
    CHECK(breaks("server/sdk/plab/a.h", "#include \"model/text.h\""));
    CHECK(breaks("server/sdk/plab/a.h", "#include <ode/ode.h>"));
    CHECK(breaks("server/sdk/plab/a.h", "#include <math.h>"));
    CHECK(breaks("server/linear/a.cpp", "#include \"model/text.h\""));
    CHECK(breaks("server/model/a.cpp", "#include \"world/world.h\""));
    CHECK(breaks("server/model/a.cpp", "#include <expat.h>"));
    CHECK(breaks("server/world/a.cpp", "#include \"simulation/step/stepper.h\""));
    CHECK(breaks("server/blueprint/a.cpp", "#include \"world/world.h\""));
    CHECK(breaks("server/blueprint/a.h", "#include <expat.h>"));
    CHECK(breaks("server/plugins/a.cpp", "#include \"blueprint/tree.h\""));
    CHECK(breaks("server/plugins/a.h", "#include <dlfcn.h>"));
    CHECK(breaks("server/simulation/a.cpp", "#include \"plugins/library.h\""));
    CHECK(breaks("server/simulation/a.cpp", "#include <spdlog/spdlog.h>"));
    CHECK(breaks("server/daemon/a.cpp", "#include \"support/scene.h\""));
    CHECK(breaks("server/daemon/a.cpp", "#include <dlfcn.h>"));
    CHECK(breaks("server/objects/bodies/a.cpp", "#include \"model/text.h\""));
    CHECK(breaks("server/objects/bodies/a.cpp", "#include \"objects/shapes/primitives.h\""));
    CHECK(breaks("interactions/fields/a.cpp", "#include \"world/world.h\""));
    CHECK(breaks("interactions/fields/a.cpp", "#include \"../response/impulse.h\""));
    CHECK(breaks("interactions/response/a.cpp", "#include <ode/ode.h>"));
    CHECK(breaks("interactions/detection/a.cpp", "#include <lua.hpp>"));
    CHECK(breaks("interactions/managers/a.cpp", "#include \"simulation/rows/row_system.h\""));
    CHECK(breaks("interactions/scripts/lua/a.cpp", "#include <ode/ode.h>"));
    CHECK(breaks("tests/a.cpp", "#include <spdlog/spdlog.h>"));
    CHECK(breaks("server/new_layer/a.cpp", ""));
    CHECK(breaks("server/model/a.cpp", "#include \"no_such_file.h\""));
    CHECK(breaks("server/model/a.cpp", "  #  include HEADER"));
}

TEST_CASE("what keeps to the table is not")
{
    CHECK_FALSE(breaks("server/model/a.cpp", "#include \"plab/result.h\"\n#include <vector>\n// #include <ode/ode.h>"));
    CHECK_FALSE(breaks("server/simulation/a.cpp", "#include \"world/world.h\"  // why"));
    CHECK_FALSE(breaks("server/blueprint/a.cpp", "#include <expat.h>"));
    CHECK_FALSE(breaks("server/objects/shapes/a.cpp", "#include \"primitives.h\""));
    CHECK_FALSE(
        breaks("interactions/constraints/angular_velocity/a.cpp", "#include \"ratio.h\"\n#include \"angular_velocity/couplings.h\""));
    CHECK_FALSE(breaks("tests/unit/a.cpp", "#include \"world/world.h\"\n#include <doctest/doctest.h>"));
}

TEST_CASE("what breaks the other rules is seen, with its place")
{
    CHECK(check_length({"a.cpp", "1\n2\n3\n"}, 2) == Complaints{"a.cpp:1: 3 lines, at most 2"});
    CHECK(check_length({"a.cpp", "1\n2\n3\n"}, 3).empty());
    CHECK(check_leftovers({"a.cpp",
                           "int a;\n// TO"
                           "DO: more\n"}) == Complaints{"a.cpp:2: unfinished: TO"
                                                        "DO"});
    CHECK(check_leftovers({"a.cpp",
                           "// FIX"
                           "ME\n"})
              .size() == 1);
    CHECK(check_leftovers({"a.cpp",
                           "// XX"
                           "X\n"})
              .size() == 1);
    CHECK(check_machine_paths({"a.md",
                               "see\n/ho"
                               "me/me/notes\n"}) == Complaints{"a.md:2: names a folder of one machine: /ho"
                                                               "me/"});
    CHECK(check_machine_paths({"a.md",
                               "cd /wo"
                               "rk/main"})
              .size() == 1);
    CHECK(check_machine_paths({"a.md",
                               "docs/ho"
                               "me/index"})
              .empty());
    CHECK(check_readmes({"server/CMakeLists.txt", "server/README.md", "server/world/CMakeLists.txt"}) ==
          Complaints{"server/world: has no README.md"});
}
