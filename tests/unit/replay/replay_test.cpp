// Recorded runs are repeated: the same hashes, and the first difference is found if there is one.
#include "replay/replay.h"

#include <algorithm>
#include <map>

#include "publish/states.h"
#include "simulation/snapshot/format.h"
#include "support/ball.h"
#include "support/scene.h"

namespace plab::test
{
namespace
{

/// A recording in memory: what a recorder would have written about a run.
class MemoryLog final : public record::RunLog
{
public:
    const std::vector<record::RecordedSnapshot>& snapshots() const override { return places; }
    Result<wire::Snapshot> read(const record::RecordedSnapshot& s) override { return records.at(s.place); }
    Result<std::vector<wire::Journal>> journal(std::uint64_t run) override
    {
        std::vector<wire::Journal> out;
        for (const wire::Journal& j : entries)
            if (j.run == run) out.push_back(j);
        return out;
    }
    Result<void> begin_hashes(std::uint64_t run) override
    {
        asked = run, next = 0;
        return {};
    }
    Result<std::optional<wire::Hashes>> next_hashes() override
    {
        while (next < hashes.size() && hashes[next].run != asked) ++next;
        if (next >= hashes.size()) return std::optional<wire::Hashes>();
        return std::optional(hashes[next++]);
    }
    Result<std::optional<wire::Frame>> frame(std::uint64_t run, Tick step) override
    {
        const auto found = frames.lower_bound({run, step});
        return found == frames.end() || found->first.first != run ? std::nullopt : std::optional(found->second);
    }
    Result<std::vector<std::pair<std::uint32_t, std::string>>> objects(std::uint64_t) override
    {
        return std::vector<std::pair<std::uint32_t, std::string>>{{1, "ball"}};
    }
    std::string origin(const std::string& key) const override
    {
        const auto found = about.find(key);
        return found == about.end() ? std::string() : found->second;
    }
    std::string damage() const override { return {}; }

    std::map<std::string, std::string> about;
    std::vector<record::RecordedSnapshot> places;
    std::vector<wire::Snapshot> records;
    std::vector<wire::Journal> entries;
    std::vector<wire::Hashes> hashes;
    std::map<std::pair<std::uint64_t, Tick>, wire::Frame> frames;
    std::uint64_t asked = 0;
    std::size_t next = 0;
};

/// Runs a scene and records it.
class RecordedScene
{
public:
    explicit RecordedScene(const std::string& body) : scene(body, "dt=\"1/100\"")
    {
        REQUIRE_MESSAGE(scene.loaded(), scene.error());
        keep_snapshot("begin");
    }
    void keep_snapshot(const char* cause)
    {
        const simulation::Simulation& s = scene.simulation();
        auto bytes = simulation::encode(s.capture());
        REQUIRE(bytes);
        wire::Snapshot record;
        record.run = s.run(), record.step = s.tick(), record.time = s.time(), record.cause = cause, record.data = bytes.take();
        log.places.push_back({s.run(), s.tick(), s.time(), "", cause, log.records.size()});
        log.records.push_back(std::move(record));
    }
    void ask(std::vector<wire::Operation> operations)
    {
        wire::Request text;
        text.operations = operations;
        auto wanted = control::wanted_of(text, library());
        REQUIRE(wanted);
        REQUIRE(scene.simulation().carry_out_now(wanted->request).done);
        wire::Journal entry;
        entry.run = scene.simulation().run(), entry.step = scene.simulation().tick(), entry.operations = std::move(operations);
        entry.sequence_number = log.entries.size() + 1;
        log.entries.push_back(std::move(entry));
    }
    void step(int n)
    {
        simulation::Simulation& s = scene.simulation();
        for (int i = 0; i < n; ++i)
        {
            scene.step();
            wire::Hashes record;
            record.run = s.run(), record.step = s.tick(), record.values = {s.state_hash()};
            log.hashes.push_back(record);
            wire::Frame frame;
            const std::uint32_t ball = s.world().find("ball");
            frame.run = s.run(), frame.step = s.tick();
            if (ball != kNoIndex) frame.bodies = {publish::state_of(s.world().host().bodies, s.world().component(ball).host_index, 1)};
            log.frames[{s.run(), s.tick()}] = std::move(frame);
        }
    }
    Scene scene;
    MemoryLog log;
};

replay::ReplayReport made_again(MemoryLog& log, replay::ReplayOptions options = {}, int threads = 1)
{
    simulation::Simulation simulation(library(), threads);
    options.verify = true;
    auto report = replay::replay(log, simulation, library(), options);
    REQUIRE_MESSAGE(report, first_error(report.errors()));
    return *report;
}

}  // namespace

TEST_CASE("a run with a swap, a set, an added and a removed component gives the same hashes, for one and two threads")
{
    RecordedScene recorded(kBall);
    recorded.step(20);
    recorded.ask({{"set", "ball", "", "", {{"mass", "2 kg"}}}});
    recorded.step(20);
    recorded.keep_snapshot("periodic");
    recorded.step(20);
    recorded.ask({{"add", "", "", R"(<component id="more" type="Field/Gravity" between="ball" acceleration="0 0 -1"/>)", {}},
                  {"remove", "wind", "", "", {}}});
    recorded.ask({{"rate", "", "max", "", {}}});
    recorded.step(40);
    for (const int threads : {1, 2})
    {
        const replay::ReplayReport report = made_again(recorded.log, {}, threads);
        CHECK(!report.mismatch);
        CHECK(report.verified == 100);
        CHECK(report.requests == 2);
        CHECK(report.last_hash == recorded.scene.hash());
    }
    // From the snapshot in the middle on, and only as far as requested.
    replay::ReplayOptions from;
    from.from = 55;
    CHECK(made_again(recorded.log, from).verified == 60);
    replay::ReplayOptions until;
    until.until = 0.3;
    CHECK(made_again(recorded.log, until).verified == 30);
}

TEST_CASE("runs follow one another, each from its own first snapshot")
{
    RecordedScene recorded(kBall);
    recorded.step(30);
    recorded.ask({{"reset", "", "", "", {}}});
    recorded.keep_snapshot("begin");
    recorded.step(10);
    const replay::ReplayReport report = made_again(recorded.log);
    CHECK(!report.mismatch);
    CHECK(report.runs == 2);
    CHECK(report.verified == 40);
    replay::ReplayOptions second;
    second.run = recorded.scene.simulation().run();
    CHECK(made_again(recorded.log, second).verified == 10);
}

TEST_CASE("a request that is not in the recording shows as a difference at its step, with object, column and both values")
{
    RecordedScene recorded(kBall);
    recorded.step(25);
    REQUIRE(recorded.scene.ask(simulation::PushOperation{"ball", {0.5, 0, 0}, {}}).done);  // without the recorder
    recorded.step(25);
    recorded.keep_snapshot("periodic");
    recorded.step(5);
    const replay::ReplayReport report = made_again(recorded.log);
    REQUIRE(report.mismatch);
    CHECK(report.verified == 25);
    CHECK(report.mismatch->step == 26);
    CHECK(report.mismatch->snapshot_step == 50);
    REQUIRE(!report.mismatch->in_frame.empty());
    CHECK(report.mismatch->in_frame.front().component == "ball");
    CHECK(report.mismatch->in_frame.front().field == "position");
    REQUIRE(!report.mismatch->in_snapshot.empty());
    CHECK(report.mismatch->in_snapshot.front().component == "ball");
    const std::string text = report.mismatch->text();
    CHECK(text.find("step 26") != std::string::npos);
    CHECK(text.find("ball.position: recorded ") != std::string::npos);
}

TEST_CASE("without a frame at the step the next one identifies the column, whether it or the snapshot comes first")
{
    for (const int snapshot_at : {27, 40})
    {
        RecordedScene recorded(kBall);
        recorded.step(25);
        REQUIRE(recorded.scene.ask(simulation::PushOperation{"ball", {0.5, 0, 0}, {}}).done);
        recorded.step(snapshot_at - 25);
        recorded.keep_snapshot("periodic");
        recorded.step(45 - snapshot_at);
        for (Tick step = 26; step < 30; ++step) recorded.log.frames.erase({recorded.scene.simulation().run(), step});
        const replay::ReplayReport report = made_again(recorded.log);
        REQUIRE(report.mismatch);
        CHECK(report.mismatch->step == 26);
        CHECK(report.mismatch->snapshot_step == snapshot_at);
        CHECK(!report.mismatch->in_snapshot.empty());
        CHECK(report.mismatch->frame_step == (snapshot_at == 40 ? 30 : -1));
        CHECK(report.mismatch->in_frame.empty() == (snapshot_at == 27));
        if (snapshot_at == 40)
            CHECK(report.mismatch->text().find("in the recorded frame of step 30:\n  ball.position") != std::string::npos);
    }
}

TEST_CASE("a gap in the numbers of the journal is reported, also between two runs")
{
    RecordedScene recorded(kBall);
    recorded.step(5);
    recorded.ask({{"set", "ball", "", "", {{"mass", "2 kg"}}}});
    recorded.step(5);
    recorded.ask({{"reset", "", "", "", {}}});
    recorded.keep_snapshot("begin");
    recorded.step(5);
    CHECK(made_again(recorded.log).doubts.empty());
    recorded.log.entries[1].sequence_number = 4;
    const replay::ReplayReport between = made_again(recorded.log);
    REQUIRE(between.doubts.size() == 1);
    CHECK(between.doubts[0].find("entries 2 to 3 are missing, after step 5 of run") != std::string::npos);
    // Only for plabd's own recordings it is known that there was nothing before the first entry.
    recorded.log.entries[0].sequence_number = 3;
    CHECK(made_again(recorded.log).doubts.empty());
    recorded.log.about["recorder"] = "plabd";
    CHECK(made_again(recorded.log).doubts.size() == 1);
    recorded.log.about["topics"] = "plab/states plab/hashes";
    const replay::ReplayReport without = made_again(recorded.log);
    REQUIRE(without.doubts.size() == 1);
    CHECK(without.doubts[0].find("made without plab/journal") != std::string::npos);
}

TEST_CASE("one wrong bit in a recorded hash is found")
{
    RecordedScene recorded(kBall);
    recorded.step(10);
    recorded.log.hashes[6].values[0] ^= 1;
    const replay::ReplayReport report = made_again(recorded.log);
    REQUIRE(report.mismatch);
    CHECK(report.mismatch->step == 7);
    CHECK(report.mismatch->in_frame.empty());
}

TEST_CASE("a recording without a snapshot is refused, and so is a request that cannot be carried out again")
{
    RecordedScene recorded(kBall);
    recorded.step(3);
    simulation::Simulation simulation(library());
    recorded.log.entries.push_back({});
    recorded.log.entries.back().run = recorded.scene.simulation().run(), recorded.log.entries.back().step = 1;
    recorded.log.entries.back().operations = {{"remove", "nobody", "", "", {}}};
    const auto impossible = replay::replay(recorded.log, simulation, library(), {});
    REQUIRE(!impossible);
    CHECK(impossible.error().reason.find("the request of step 1 cannot be replayed") != std::string::npos);
    MemoryLog empty;
    const auto nothing = replay::replay(empty, simulation, library(), {});
    REQUIRE(!nothing);
    CHECK(nothing.error().reason.find("no snapshot to start from") != std::string::npos);
}

}  // namespace plab::test
