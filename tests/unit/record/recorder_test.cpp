// A run that a recorder observes, and the file read back.
#include "record/recorder.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "publish/collector.h"
#include "record/file_log.h"
#include "replay/replay.h"
#include "simulation/snapshot/format.h"
#include "support/ball.h"
#include "support/scene.h"

namespace plab::test
{
namespace
{

std::string fresh_file(const std::string& name)
{
    const std::string file = std::string(PLAB_BINARY_DIR) + "/" + name + "-" + std::to_string(getpid()) + ".mcap";
    std::filesystem::remove(file);
    return file;
}

record::RecordOptions options_for(const std::string& file)
{
    record::RecordOptions options;
    options.file = file, options.server = "unit", options.version = "test", options.scene_file = "balls.xml", options.dt = 0.01;
    options.blueprint = "<plab version=\"1\"/>", options.snapshot_interval = 0.25;
    options.log = [](void* lines, const char* line) { static_cast<std::vector<std::string>*>(lines)->push_back(line); };
    return options;
}

/// What plabd does with a recorder, step by step.
class Recorded
{
public:
    explicit Recorded(const record::RecordOptions& options)
        : file(options.file), scene(kBall, "dt=\"1/100\""), collector({}, library().summaries())
    {
        REQUIRE_MESSAGE(scene.loaded(), scene.error());
        auto opened = record::Recorder::open(options);
        REQUIRE_MESSAGE(opened, first_error(opened.errors()));
        recorder = opened.take();
        collector.attach(*recorder);
        publish(false);
    }
    void publish(bool stepped)
    {
        simulation::Simulation& s = scene.simulation();
        collector.collect(s, s.take_changes(), stepped);
        if (const auto cause = collector.wants_snapshot(s))
        {
            wire::Snapshot record;
            const simulation::Snapshot snapshot = s.capture();
            record.run = s.run(), record.step = s.tick(), record.time = s.time(), record.cause = *cause;
            record.state_hash = snapshot->state_hash, record.data = simulation::encode(snapshot).take();
            collector.snapshot(record);
        }
    }
    void step(int n)
    {
        for (int i = 0; i < n; ++i)
        {
            scene.step();
            hashes.push_back(scene.hash());
            publish(true);
        }
    }
    void ask(wire::Operation operation)
    {
        wire::Request text;
        text.operations = {operation};
        auto wanted = control::wanted_of(text, library());
        REQUIRE(wanted);
        REQUIRE(scene.simulation().carry_out_now(wanted->request).done);
        publish(false);
        wire::Journal entry;
        entry.run = scene.simulation().run(), entry.step = scene.simulation().tick(), entry.time = scene.simulation().time();
        entry.origin = "client", entry.operations = {std::move(operation)};
        collector.journal(std::move(entry));
    }

    std::string file;
    Scene scene;
    publish::Collector collector;
    std::unique_ptr<record::Recorder> recorder;
    std::vector<std::uint64_t> hashes;
};

replay::ReplayReport replayed(const std::string& file)
{
    auto log = record::FileLog::open(file);
    REQUIRE_MESSAGE(log, first_error(log.errors()));
    simulation::Simulation simulation(library());
    replay::ReplayOptions options;
    options.verify = true;
    auto report = replay::replay(**log, simulation, library(), options);
    REQUIRE_MESSAGE(report, first_error(report.errors()));
    return *report;
}

}  // namespace

TEST_CASE("a recording holds hashes, journal, snapshots, frames and origin, and reproduces the run")
{
    const std::string file = fresh_file("recorder");
    Recorded run(options_for(file));
    run.step(30);
    run.ask({"set", "ball", "", "", {{"mass", "2 kg"}}});
    run.step(70);
    REQUIRE(run.recorder->close());
    CHECK(run.recorder->progress().dropped == 0);
    CHECK(run.recorder->progress().bytes == std::filesystem::file_size(file));

    auto log = record::FileLog::open(file);
    REQUIRE(log);
    CHECK((*log)->damage() == "");
    CHECK((*log)->origin("server") == "unit");
    CHECK((*log)->origin("scene_file") == "balls.xml");
    const std::uint64_t number = run.scene.simulation().run();
    const auto journal = (*log)->journal(number);
    REQUIRE(journal);
    REQUIRE(journal->size() == 1);
    CHECK(journal->front().step == 30);
    CHECK(journal->front().operations.front().values.front().text == "2 kg");
    CHECK((*log)->snapshots().size() == 5);  // at 0, 0.25, 0.5, 0.75, 1 s
    const auto frame = (*log)->frame(number, 100);
    REQUIRE(frame);
    REQUIRE(*frame);
    REQUIRE((*frame)->bodies.size() == 1);
    CHECK((*frame)->bodies[0].position.z == run.scene.vec("ball", "position").z);
    const auto objects = (*log)->objects(number);
    REQUIRE(objects);
    CHECK(std::any_of(objects->begin(), objects->end(), [&](const auto& o) { return o.first == (*frame)->bodies[0].handle; }));

    const replay::ReplayReport report = replayed(file);
    CHECK(!report.mismatch);
    CHECK(report.verified == 100);
    CHECK(report.last_hash == run.hashes.back());
    std::filesystem::remove(file);
}

TEST_CASE("frames that name only moved objects give the same frames in a smaller file")
{
    record::RecordOptions options = options_for(fresh_file("moved"));
    options.moved_only = true, options.compression = "none";
    Recorded run(options);
    run.step(150);
    REQUIRE(run.recorder->close());
    auto log = record::FileLog::open(options.file);
    REQUIRE(log);
    const auto frame = (*log)->frame(run.scene.simulation().run(), 150);
    REQUIRE(frame);
    REQUIRE(*frame);
    CHECK((*frame)->bodies.size() == 1);
    CHECK((*frame)->bodies[0].position.x == run.scene.vec("ball", "position").x);
    std::filesystem::remove(options.file);
}

TEST_CASE("frames are recorded at the requested interval of simulated time")
{
    record::RecordOptions options = options_for(fresh_file("interval"));
    options.state_interval = 0.1;
    options.topics = {"plab/states"};
    Recorded run(options);
    run.step(100);
    REQUIRE(run.recorder->close());
    auto reader = recording::McapReader::open(options.file);
    REQUIRE(reader);
    const recording::Statistics& statistics = reader->index().statistics;
    CHECK(reader->channels().size() == 1);
    CHECK(statistics.messages == 11);
    std::filesystem::remove(options.file);
}

TEST_CASE("when the writer cannot keep up, frames are dropped and counted, and the journal is kept")
{
    record::RecordOptions options = options_for(fresh_file("full"));
    options.most_waiting_bytes = 3000;
    Recorded run(options);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // the catalogue is large, and is written alone
    // Only frames, faster than any thread can write them.
    for (int i = 0; i < 5000; ++i)
    {
        run.recorder->begin_frame().bodies.resize(10);
        run.recorder->end_frame();
    }
    run.ask({"set", "ball", "", "", {{"mass", "2 kg"}}});
    REQUIRE(run.recorder->close());
    const wire::RecordingInfo status = run.recorder->progress();
    CHECK(status.dropped > 0);
    auto reader = recording::McapReader::open(options.file);
    REQUIRE(reader);
    const auto gap = reader->metadata("gap");
    CHECK_MESSAGE(gap, first_error(gap.errors()));
    auto log = record::FileLog::open(options.file);
    REQUIRE(log);
    const auto journal = (*log)->journal(run.scene.simulation().run());
    REQUIRE(journal);
    CHECK(journal->size() == 1);
    std::filesystem::remove(options.file);
}

TEST_CASE("a full disk stops the recording and is reported; the simulation is not affected")
{
    Scene alone(kBall, "dt=\"1/100\"");
    alone.step(300);

    const std::string file = fresh_file("disk");
    std::vector<std::string> lines;
    record::RecordOptions options = options_for(file);
    options.log_argument = &lines, options.compression = "none";
    (void)std::signal(SIGXFSZ, SIG_IGN);
    Recorded run(options);
    run.step(20);
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
    rlimit tight = before;
    tight.rlim_cur = 128 * 1024;
    REQUIRE(setrlimit(RLIMIT_FSIZE, &tight) == 0);
    for (int i = 0; i < 7; ++i)
    {
        run.step(40);
        std::this_thread::sleep_for(std::chrono::milliseconds(40));
    }
    (void)run.recorder->close();
    REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
    CHECK(run.scene.hash() == alone.hash());
    const wire::RecordingInfo status = run.recorder->progress();
    CHECK(status.dropped > 0);
    CHECK(status.bytes <= 128 * 1024);
    REQUIRE(!lines.empty());
    CHECK(lines.front().find("recording is stalled, the simulation continues: ") != std::string::npos);
    // The part before is in the file and reproduces the run.
    const replay::ReplayReport report = replayed(file);
    CHECK(!report.mismatch);
    CHECK(report.verified > 0);
    std::filesystem::remove(file);
}

TEST_CASE("recordings that cannot be made are refused before anything is written")
{
    const std::string file = fresh_file("refused");
    record::RecordOptions options = options_for(file);
    options.topics = {"plab/nonsense"};
    auto topic = record::Recorder::open(options);
    REQUIRE(!topic);
    CHECK(topic.error().reason == "'plab/nonsense' is not a pLab topic");
    CHECK(!std::filesystem::exists(file));
    options.topics.clear(), options.compression = "zip";
    auto compression = record::Recorder::open(options);
    REQUIRE(!compression);
    CHECK(compression.error().reason.find("is not a compression") != std::string::npos);
    CHECK(!std::filesystem::exists(file));
    options.compression = "zstd";
    REQUIRE(record::Recorder::open(options));
    CHECK_MESSAGE(!record::Recorder::open(options), "an existing recording was overwritten");
    std::filesystem::remove(file);
}

}  // namespace plab::test
