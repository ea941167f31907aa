// plabd --replay --verify of recordings in which something is not as it was, and of those of older builds.
#include <doctest/doctest.h>
#include <signal.h>

#include <filesystem>
#include <set>

#include "edited_recording.h"
#include "idl/recording/format.h"
#include "support/process.h"
#include "support/text.h"

namespace plab::test
{
namespace
{

const std::string kGolden = std::string(PLAB_SOURCE_DIR) + "/tests/daemon/golden/format_2.mcap";

Outcome plabd(std::vector<std::string> arguments)
{
    arguments.insert(arguments.begin(), program("plabd"));
    return run(std::move(arguments));
}

/// The golden recording with something changed.
std::string edited(const std::string& name, const Edits& edits)
{
    const std::string file = scratch_file(name);
    const auto copied = copy_recording(kGolden, file, edits);
    REQUIRE_MESSAGE(copied, copied.error().text());
    return file;
}

Outcome verify(const std::string& file, std::vector<std::string> more = {})
{
    more.insert(more.begin(), {"--replay", file, "--verify"});
    return plabd(std::move(more));
}

std::string with_format(const std::string& format)
{
    return edited("format.mcap", {nullptr, [&](recording::Pairs& about) { about["format"] = format; }});
}

/// Leaves messages out: those of a topic whose place among its own is `n`; all if n < 0.
Edits without(const std::string& topic, int n, int& count)
{
    return {[&count, topic, n](const std::string& at, recording::Bytes&) { return at != topic || (n >= 0 && ++count != n); }, nullptr};
}

}  // namespace

TEST_CASE("a recording of format 2 is read, and is the same run again")
{
    REQUIRE(std::filesystem::file_size(kGolden) < 100'000);
    auto reader = recording::open_recording(kGolden);
    REQUIRE_MESSAGE(reader, reader.error().text());
    CHECK(reader->index().is_closed);
    std::set<std::string> topics;
    for (const auto& [id, channel] : reader->channels()) topics.insert(channel.topic);
    CHECK(topics == std::set<std::string>{"plab/collisions", "plab/events", "plab/hashes", "plab/interactions", "plab/journal",
                                          "plab/metrics", "plab/objects", "plab/scene", "plab/server", "plab/shapes", "plab/snapshots",
                                          "plab/states", "plab/types"});
    recording::Sample<plab_v2_Frame> frame;
    const auto last = reader->last_at("plab/states", ~std::uint64_t{0});
    REQUIRE(last);
    REQUIRE(*last);
    REQUIRE(recording::Decoder().decode((*last)->data, frame));
    CHECK(frame->step == 180);
    CHECK(frame->bodies._length == 2);
    CHECK(frame->shafts._length == 2);
    for (const std::string threads : {"1", "2"})
    {
        const Outcome again = verify(kGolden, {"--threads", threads});
        CHECK_MESSAGE(again.code == 0, again.output, again.errors);
        CHECK_MESSAGE(has(again.output, "1 run, 180 steps replayed, 2 requests\nverified: 180 state hashes are identical"), again.output);
    }
    CHECK(has(verify(kGolden, {"--from", "130"}).output, "verified: 60 state hashes"));
    const Outcome info = run({program("plabctl"), "info", kGolden, "--json"});
    CHECK(info.code == 0);
    CHECK(has(info.output, "\"whole\":true"));
}

TEST_CASE("a recording of a newer or of an unknown format is refused by every reader")
{
    const std::string file = with_format("3"), picture = scratch_file("format.svg"), page = scratch_file("format.html");
    const std::string why = "is of format 3, this build reads format 2: a newer pLab";
    const std::string plabctl = program("plabctl");
    const std::vector<std::vector<std::string>> readers{{program("plabd"), "--replay", file},
                                                        {plabctl, "info", file},
                                                        {plabctl, "play", file},
                                                        {plabctl, "export", file, "--csv"},
                                                        {plabctl, "plot", file, "-q", "low.speed", "-o", picture},
                                                        {plabctl, "report", file, "-o", page},
                                                        {plabctl, "diff", kGolden, file},
                                                        {plabctl, "log", file},
                                                        {program("plab-view"), file, "--png", scratch_file("format.png")}};
    for (const std::vector<std::string>& command : readers)
    {
        const Outcome refused = run(command);
        CHECK_MESSAGE(refused.code == 1, command[0], " ", command[1], ": ", refused.code, refused.errors);
        CHECK_MESSAGE(has(refused.errors, why), command[0], " ", command[1], ": ", refused.errors);
    }
    for (const std::string unknown : {"0", "1.5", "one", "-1"})
        CHECK(has(plabd({"--replay", with_format(unknown)}).errors, "has the unknown format '" + unknown + "'"));
    CHECK(has(plabd({"--replay", with_format("")}).errors, "does not state its format"));
    CHECK(plabd({"--replay", with_format("2")}).code == 0);
}

TEST_CASE("a recording of format 1, whose types are plab::v1, is refused with the pLab that reads it")
{
    const std::string old = std::string(PLAB_SOURCE_DIR) + "/tests/daemon/golden/format_1.mcap";
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{program("plabd"), "--replay", old}, {program("plabctl"), "info", old}})
    {
        const Outcome refused = run(command);
        CHECK(refused.code == 1);
        CHECK_MESSAGE(has(refused.errors, "is of format 1, this build reads format 2: an older pLab, "), refused.errors);
    }
}

TEST_CASE("a journal with another value: step, object, column and both values are reported")
{
    const auto change = [](const std::string& topic, recording::Bytes& data)
    {
        (void)edit<plab_v2_Journal>(topic, data,
                                    [](plab_v2_Journal& j)
                                    {
                                        if (std::string(j.operations._buffer[0].verb) == "swap")
                                            put_text(j.operations._buffer[0].argument, "Response/Impulse");
                                    });
        return true;
    };
    const std::string file = edited("value.mcap", {change, nullptr});
    const Outcome again = verify(file);
    CHECK(again.code == 1);
    CHECK_MESSAGE(has(again.output, "DIFFERENT after "), again.output, again.errors);
    CHECK_MESSAGE(has(again.output, "run 1, step "), again.output);
    CHECK_MESSAGE(has(again.output, "in the snapshot of step 120:\n"), again.output);
    CHECK_MESSAGE(has(again.output, "in the recorded frame of step 64:\n  high.position: recorded "), again.output);
    CHECK(has(again.output, ", replayed "));
    CHECK(!has(again.output, "verified: "));
}

TEST_CASE("one bit of a hash in the file, with and without a state beside it")
{
    const auto flip = [](const std::string& topic, recording::Bytes& data)
    {
        (void)edit<plab_v2_Hashes>(topic, data,
                                   [](plab_v2_Hashes& h)
                                   {
                                       const std::int64_t at = 100 - h.step;
                                       if (at >= 0 && at < h.values._length) h.values._buffer[at] ^= 1;
                                   });
        (void)edit<plab_v2_Frame>(topic, data,
                                  [](plab_v2_Frame& f)
                                  {
                                      if (f.step == 100) f.bodies._buffer[0].position.x += 1e-12;
                                  });
        return true;
    };
    const Outcome again = verify(edited("bit.mcap", {flip, nullptr}));
    CHECK(again.code == 1);
    CHECK_MESSAGE(has(again.output, "DIFFERENT after 99 identical steps\nrun 1, step 100: recorded hash "), again.output);
    CHECK_MESSAGE(has(again.output, "in the recorded frame of that step:\n  high.position: recorded 0.13589839780291846 "), again.output);
    CHECK_MESSAGE(has(again.output, "the snapshot of step 120 is identical again"), again.output);
    // A hash alone, behind the last snapshot.
    const auto alone = [](const std::string& topic, recording::Bytes& data)
    {
        (void)edit<plab_v2_Hashes>(topic, data,
                                   [](plab_v2_Hashes& h)
                                   {
                                       const std::int64_t at = 141 - h.step;
                                       if (at >= 0 && at < h.values._length) h.values._buffer[at] ^= 1;
                                   });
        return true;
    };
    const Outcome alone_wrong = verify(edited("bit.mcap", {alone, nullptr}));
    CHECK(alone_wrong.code == 1);
    CHECK_MESSAGE(has(alone_wrong.output, "run 1, step 141: recorded hash "), alone_wrong.output);
    CHECK_MESSAGE(
        has(alone_wrong.output, "the recorded frame of step 144 is identical: the difference is in data that frames do not contain"),
        alone_wrong.output);
    // And where nothing is recorded behind it.
    const auto last = [&](const std::string& topic, recording::Bytes& data) { return topic != "plab/states" && alone(topic, data); };
    const Outcome blind = verify(edited("bit.mcap", {last, nullptr}));
    CHECK(blind.code == 1);
    CHECK_MESSAGE(has(blind.output, "it is not known what differs; record every step (without --record-states)"), blind.output);
}

TEST_CASE("a journal that has a gap, or is not there, is named as the cause")
{
    int count = 0;
    const Outcome gap = verify(edited("gap.mcap", without("plab/journal", 1, count)));
    CHECK(gap.code == 1);
    CHECK_MESSAGE(has(gap.output, "the cause may be: the journal has a gap: entry 1 is missing, before step 90 of run 1"), gap.output);
    CHECK_MESSAGE(has(gap.output, "until then 1 more changes of the scene took effect than the journal contains"), gap.output);
    Edits none = without("plab/journal", -1, count);
    none.about = [](recording::Pairs& about) { about["topics"] = "plab/states plab/hashes plab/snapshots plab/objects"; };
    const Outcome absent = verify(edited("none.mcap", none));
    CHECK(absent.code == 1);
    CHECK_MESSAGE(has(absent.output, "the cause may be: the recording was made without plab/journal"), absent.output);
    none = without("plab/snapshots", -1, count);
    none.about = [](recording::Pairs& about) { about["topics"] = "plab/states plab/hashes plab/journal"; };
    const Outcome nowhere = verify(edited("none.mcap", none));
    CHECK(nowhere.code == 1);
    CHECK_MESSAGE(has(nowhere.errors, "no snapshot to start from: it was made without plab/snapshots"), nowhere.errors);
}

TEST_CASE("a verification without anything to compare states why, and does not claim that something was verified")
{
    const Outcome late = verify(kGolden, {"--from", "100000"});
    CHECK(late.code == 1);
    CHECK_MESSAGE(has(late.errors, "--from 100000 is beyond the last step: of run 1 it is 180"), late.errors);
    CHECK(plabd({"--replay", kGolden, "--from", "181"}).code == 1);
    CHECK(plabd({"--replay", kGolden, "--from", "180"}).code == 0);
    const Outcome early = verify(kGolden, {"--until", "0"});
    CHECK(early.code == 1);
    CHECK_MESSAGE(has(early.errors, "nothing was verified: --until 0 ends where the recording begins"), early.errors);
    const std::string empty = scratch_file("empty.mcap");
    REQUIRE(plabd({std::string(PLAB_SOURCE_DIR) + "/tests/daemon/golden/scene.xml", "--no-bus", "--until", "0", "--record", empty,
                   "--overwrite"})
                .code == 0);
    const Outcome nothing = verify(empty);
    CHECK(nothing.code == 1);
    CHECK(!has(nothing.output, "verified: 0"));
    CHECK_MESSAGE(has(nothing.errors, "nothing was verified: the recording ends at step 0, where it begins"), nothing.errors);
    int count = 0;
    Edits none = without("plab/hashes", -1, count);
    none.about = [](recording::Pairs& about) { about["topics"] = "plab/states plab/snapshots plab/journal"; };
    CHECK(has(verify(edited("none.mcap", none)).errors, "nothing was verified: the recording was made without plab/hashes"));
}

TEST_CASE("a recording of a different build is replayed with a warning before, one of the same without")
{
    const std::string file = scratch_file("own.mcap"), scene = std::string(PLAB_SOURCE_DIR) + "/tests/daemon/golden/scene.xml";
    REQUIRE(plabd({scene, "--no-bus", "--until", "0.1", "--record", file, "--overwrite"}).code == 0);
    const Outcome same = verify(file);
    CHECK(same.code == 0);
    CHECK(!has(same.errors, "a different build"));
    const std::string other = scratch_file("other.mcap");
    REQUIRE(copy_recording(file, other, {nullptr, [](recording::Pairs& about) { about["build"] = "plab 0.1.9"; }}));
    CHECK(has(verify(other).errors, "recorded by a different build: digits may differ\n  recorded: plab 0.1.9\n"));
    // Recorded from the bus: its snapshots show it.
    REQUIRE(copy_recording(file, other, {nullptr, [](recording::Pairs& about) { about.erase("build"); }}));
    CHECK(!has(verify(other).errors, "a different build"));
    // What is stated about the build names no place.
    auto reader = recording::McapReader::open(file);
    REQUIRE(reader);
    const std::string build = reader->metadata("plab")->values.at("build");
    CHECK(has(build, "compiler "));
    CHECK(!has(build, "/"));
}

TEST_CASE("what a replay or a shadow has no use for is refused")
{
    for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{"--swap", "5:contact.response=Response/None"},
                                                                                      {"--set", "5:low.mass=1"},
                                                                                      {"--from", "-5"},
                                                                                      {"--table"},
                                                                                      {"--history", "1"},
                                                                                      {"--record", "x.mcap"},
                                                                                      {"--check"},
                                                                                      {"--for", "2"},
                                                                                      {"--json"}})
    {
        std::vector<std::string> command{"--replay", kGolden};
        command.insert(command.end(), more.begin(), more.end());
        const Outcome refused = plabd(command);
        CHECK_MESSAGE(refused.code == 2, more[0], refused.errors);
        CHECK_MESSAGE(has(refused.errors, more[0]), refused.errors);
    }
    CHECK(has(plabd({"--replay", kGolden, "--swap", "5:a=b"}).errors, "the recording contains the requests"));
    CHECK(plabd({"scene.xml", "--record-compression", "lz4"}).code == 2);
}

TEST_CASE("a recording that cannot be replayed is announced as one")
{
    const std::string file = scratch_file("few.mcap"), scene = std::string(PLAB_SOURCE_DIR) + "/tests/daemon/golden/scene.xml";
    const Outcome few = plabd({scene, "--no-bus", "--until", "0.1", "--record", file, "--overwrite", "--record-topics", "plab/states"});
    CHECK(few.code == 0);
    CHECK_MESSAGE(has(few.errors, "cannot be replayed: --record-topics does not include plab/snapshots, plab/journal, plab/hashes"),
                  few.errors);
    const Outcome all = plabd({scene, "--no-bus", "--until", "0.1", "--record", file, "--overwrite", "--record-topics",
                               "plab/states,plab/snapshots,plab/journal,plab/hashes"});
    CHECK(!has(all.errors, "cannot be replayed"));
    CHECK(verify(file).code == 0);
}

TEST_CASE("interrupted is not verified: it says how far it came, and ends with 130 or 143")
{
    const std::string file = scratch_file("long.mcap"), out = scratch_file("long.json");
    const Outcome made = plabd({scene_file("fan_and_balloons.xml"), "--no-bus", "--until", "400", "--record", file, "--record-states",
                                "0.01", "--record-snapshots", "1000"});
    REQUIRE_MESSAGE(made.code == 0, made.errors);
    for (const int signal : {SIGINT, SIGTERM})
    {
        Process replay({program("plabd"), "--replay", file, "--verify", "--hashes", "--out", out});
        REQUIRE(replay.wait_for("\n100 ", Milliseconds(20000)));
        replay.signal(signal);
        CHECK(replay.wait(Milliseconds(5000)) == 128 + signal);
        const std::string text = replay.output();
        CHECK(!has(text, "verified: "));
        CHECK_MESSAGE(has(text, signal == SIGINT ? "interrupted by SIGINT after step " : "interrupted by SIGTERM after step "), text);
        CHECK(has(text, "of run 1: NOT VERIFIED; "));
        CHECK(has(text, " state hashes were identical until then"));
        CHECK(!std::filesystem::exists(out));
    }
}

TEST_CASE("a run that is interrupted before its --until ends with 130 or 143; a server, whose end a signal is, with 0")
{
    const std::string scene = scene_file("fan_and_balloons.xml");
    for (const int signal : {SIGINT, SIGTERM})
        for (const bool has_end : {true, false})
        {
            const std::string file = scratch_file("cut.mcap");
            std::vector<std::string> command{program("plabd"), scene,      "--no-bus", "--rate",     "max",
                                             "--hashes",       "--record", file,       "--overwrite"};
            if (has_end) command.insert(command.end(), {"--until", "1e6"});
            Process run(command);
            REQUIRE(run.wait_for("\n100 ", Milliseconds(20000)));
            run.signal(signal);
            CHECK(run.wait(Milliseconds(10000)) == (has_end ? 128 + signal : 0));
            CHECK(has(run.errors(), "--until 1000000 was not reached") == has_end);
            // What is there is whole, as far as it goes.
            CHECK(verify(file).code == 0);
        }
}

}  // namespace plab::test
