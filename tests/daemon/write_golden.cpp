// Writes the golden file of a format of recordings: build/bin/recording_golden FILE. A new format gets a file of its own; those of
// older ones stay what they are. Of the machine nothing is in it but what its libm goes by.
#include <cstdio>
#include <filesystem>

#include "edited_recording.h"
#include "support/process.h"

namespace
{

bool forget_host(const std::string& topic, plab::recording::Bytes& data)
{
    const auto change = [](plab_v2_Server& s)
    {
        plab::test::put_text(s.host, "here");
        plab::test::put_text(s.recording.file, "golden.mcap");
        s.process = 1;
    };
    return topic != plab::wire::topic_of<plab_v2_Server>().name || plab::test::edit<plab_v2_Server>(topic, data, change);
}

}  // namespace

int main(int argc, char** argv)
{
    using namespace plab::test;
    if (argc != 2) return std::fputs("usage: recording_golden FILE\n", stderr), 2;
    const std::string out = std::filesystem::absolute(argv[1]).string(), made = scratch_file("golden.mcap");
    // The file contains the name under which the scene was given.
    std::filesystem::current_path(std::string(PLAB_SOURCE_DIR) + "/tests/daemon/golden");
    const Outcome recorded =
        run({program("plabd"), "scene.xml", "--no-bus", "--until", "0.75", "--record", made, "--overwrite", "--record-states", "60",
             "--record-snapshots", "0.5", "--swap", "60:contact.response=Response/None", "--set", "90:low.mass=0.75"});
    if (recorded.code != 0) return std::fputs(recorded.errors.c_str(), stderr), 1;
    const auto copied = copy_recording(made, out, {&forget_host, [](auto& about) { about["host"] = "here"; }});
    if (!copied) return std::fprintf(stderr, "%s\n", copied.error().text().c_str()), 1;
    return 0;
}
