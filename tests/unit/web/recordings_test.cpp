// The folder to which pages record: what can be named there, and what is listed.
#include "web/recordings.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "support/process.h"

using namespace plab;
using namespace plab::web;

namespace
{

namespace fs = std::filesystem;

std::string empty_folder()
{
    const std::string folder = test::scratch_file("recordings");
    fs::remove_all(folder);
    return folder;
}

Recordings opened(const std::string& folder)
{
    auto recordings = Recordings::open(folder, 1'000'000);
    REQUIRE_MESSAGE(recordings.ok(), recordings.error().text());
    return recordings.take();
}

}  // namespace

TEST_CASE("a name is that of a file in the folder, and of nothing else")
{
    const std::string folder = empty_folder();
    Recordings recordings = opened(folder);
    CHECK(recordings.path_of("run_1").value() == fs::canonical(folder).string() + "/run_1.mcap");
    for (const std::string& name :
         {std::string(), std::string("."), std::string(".."), std::string("../x"), std::string("a/b"), std::string("/tmp/x"),
          std::string(".x"), std::string("-x"), std::string("a b"), std::string("a\0b", 3), std::string(65, 'x')})
    {
        INFO(name);
        CHECK_FALSE(recordings.path_of(name));
        CHECK_FALSE(recordings.has(name));
        CHECK_FALSE(recordings.remove(name));
    }
}

TEST_CASE("regular files of recordings are listed and counted, the newest first, and no links")
{
    const std::string folder = empty_folder(), outside = test::scratch_file("outside.mcap");
    Recordings recordings = opened(folder);
    std::ofstream(outside) << "outside";
    std::ofstream(folder + "/notes.txt") << "no recording";
    std::ofstream(folder + "/old.mcap") << std::string(100, 'x');
    std::ofstream(folder + "/new.mcap") << std::string(50, 'x');
    std::ofstream(folder + "/bad name.mcap") << std::string(50, 'x');
    fs::create_symlink(outside, folder + "/link.mcap");
    fs::create_directory(folder + "/folder.mcap");
    fs::last_write_time(folder + "/old.mcap", fs::file_time_type::clock::now() - std::chrono::hours(1));
    recordings.update();
    REQUIRE(recordings.list().size() == 2);
    CHECK(recordings.list()[0].name == "new");
    CHECK(recordings.list()[1].name == "old");
    CHECK_FALSE(recordings.list()[0].is_closed);
    CHECK_FALSE(recordings.list()[0].seconds);
    CHECK(recordings.bytes() == 150);
    CHECK_FALSE(recordings.remove("link"));
    REQUIRE(recordings.remove("old"));
    CHECK_FALSE(recordings.remove("old"));
    recordings.update();
    CHECK(recordings.bytes() == 50);
    CHECK(fs::exists(outside));
}

TEST_CASE("a folder that cannot be one is refused, and a missing one is made")
{
    const std::string file = test::scratch_file("file");
    std::ofstream(file) << "a file";
    for (const std::string& folder : {file, file + "/below"})
    {
        const auto refused = Recordings::open(folder, 1);
        REQUIRE_FALSE(refused.ok());
        CHECK(refused.error().text() == "'" + folder + "' is no folder, and cannot be made one");
    }
    const std::string fresh = empty_folder() + "/a/b";
    CHECK(Recordings::open(fresh, 1).ok());
    CHECK(fs::is_directory(fresh));
}
