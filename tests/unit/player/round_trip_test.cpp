// A recording that is played on the bus and recorded again is unchanged.
#include "both.h"

using namespace plab;
using namespace plab::test;

namespace
{

recorder::RecorderOptions record_options(const std::string& name)
{
    recorder::RecorderOptions options;
    options.writer.file = fresh_path(name);
    return options;
}

struct Again
{
    std::string file;
    recorder::Progress progress;
};

/// Plays `file` twenty times as fast, records it, and ends the playback.
Again play_and_record(const std::string& file, const std::string& name, recorder::RecorderOptions options)
{
    player::PlaybackOptions play = play_options(file, name);
    play.rate = 20, play.readers = 1;
    auto player = open_player(play);
    const link::Session session = watch(name);
    link::ServerInfo server;
    REQUIRE(play_until(*player,
                       [&]
                       {
                           const auto found = session.servers(Seconds(0.02), 1);
                           if (!found.empty()) server = found.front();
                           return !found.empty();
                       }));
    CHECK(server.playback == file);
    auto recorder = recorder::Recorder::open(session, server, options);
    REQUIRE_MESSAGE(recorder.ok(), recorder.error().text());
    REQUIRE(play_until(*player, [&] { return (*recorder)->step(Seconds(0)) != recorder::State::Running || player->is_over(); }));
    CHECK(player->broken() == 0);
    player.reset();  // announces its end
    const auto end = Clock::now() + std::chrono::seconds(5);
    auto state = recorder::State::Running;
    while (state == recorder::State::Running && Clock::now() < end) state = (*recorder)->step(Seconds(0.05));
    CHECK((state == recorder::State::Gone || state == recorder::State::Done));
    const auto closed = (*recorder)->close();
    REQUIRE_MESSAGE(closed.ok(), closed.error().text());
    CHECK((*recorder)->broken() == 0);
    return {options.writer.file, (*recorder)->progress()};
}

void check_same(const recording::McapReader& a, const recording::McapReader& b, const std::string& topic)
{
    CAPTURE(topic);
    const auto first = messages_of(a, topic), second = messages_of(b, topic);
    CHECK(first.size() > 0);
    CHECK(first.size() == second.size());
    CHECK(first == second);
}

}  // namespace

TEST_CASE("states, events and all numbered topics are the same byte for byte; the catalogue at any time is the same")
{
    MadeOptions made;
    made.steps_after = 60;
    const std::string file = make_recording("playback_first.mcap", made);
    const Again again = play_and_record(file, "lab", record_options("playback_second.mcap"));
    CHECK(again.progress.missing == 0);
    CHECK(again.progress.dropped == 0);
    const recording::McapReader a = open_file(file), b = open_file(again.file);
    for (const char* topic : {"plab/states", "plab/events", "plab/collisions", "plab/journal", "plab/hashes"}) check_same(a, b, topic);
    CHECK(messages_of(b, "plab/gone").empty());  // the end of the server does not change the scene
    for (const double seconds : {0.5, 1.5, 2.5})
    {
        const auto time = static_cast<std::uint64_t>(seconds * 1e9);
        CHECK(player::retained_at(a, time).entries() == player::retained_at(b, time).entries());
    }
    const auto about = b.metadata("plab");
    REQUIRE(about.ok());
    CHECK(about->values.at("server") == "lab");
    const auto blueprint = b.attachment("blueprint.xml");
    REQUIRE_MESSAGE(blueprint.ok(), blueprint.error().text());
    CHECK(std::string(blueprint->attachment.data.begin(), blueprint->attachment.data.end()) == "<plab/>");
    // The time line is that of the first recording: it began at zero, and continued after a reset.
    CHECK(std::abs(static_cast<double>(a.index().statistics.end_time) - static_cast<double>(b.index().statistics.end_time)) <= 2e7);
}

TEST_CASE("frames that name only moved objects are sent in full")
{
    MadeOptions thin;
    thin.only_moved = true;
    const std::string file = make_recording("playback_thin.mcap", thin);
    CHECK(messages_of(open_file(file), "plab/states")[5].size() < 200);
    const Again again = play_and_record(file, "thin", record_options("playback_thin_again.mcap"));
    recording::Decoder decoder;
    recording::Sample<plab_v2_Frame> frame;
    const auto frames = messages_of(open_file(again.file), "plab/states");
    CHECK(frames.size() == 201);
    for (const recording::Bytes& bytes : frames)
    {
        REQUIRE(decoder.decode(bytes, frame).ok());
        REQUIRE(frame->bodies._length == 2);
        REQUIRE(frame->shafts._length == 1);
        // Blue was recorded at each tenth step, the axle at the first.
        const double reported = static_cast<double>(frame->step / 10) * 0.1;
        CHECK(frame->bodies._buffer[0].position.x == frame->time);
        CHECK(frame->bodies._buffer[1].position.z == doctest::Approx(reported * reported));
        CHECK(frame->shafts._buffer[0].angle == 0);
    }
}

TEST_CASE("only the requested topics are recorded, frames at a lower rate, up to a time")
{
    const std::string file = make_recording("playback_source.mcap");
    recorder::RecorderOptions options = record_options("playback_thinned.mcap");
    options.topics = {"plab/states", "plab/events"}, options.state_rate = 10, options.until = 1.2;
    const Again again = play_and_record(file, "thinned", options);
    CHECK(again.progress.missing == 0);  // messages that are left out do not count as missing
    const recording::McapReader reader = open_file(again.file);
    recording::Decoder decoder;
    recording::Sample<plab_v2_Frame> frame;
    std::vector<double> times;
    for (const recording::Bytes& bytes : messages_of(reader, "plab/states"))
    {
        REQUIRE(decoder.decode(bytes, frame).ok());
        times.push_back(frame->time);
    }
    REQUIRE(times.size() == 13);
    for (std::size_t i = 0; i < times.size(); ++i) CHECK(times[i] == doctest::Approx(0.1 * static_cast<double>(i)));
    CHECK(messages_of(reader, "plab/events").size() == 2);  // of 0.3 and 0.8 s
    CHECK(reader.channels().size() == 2);
    REQUIRE_FALSE(recorder::choose_topics({"plab/statse"}).ok());
    CHECK_FALSE(recorder::choose_topics({"plab/gone"}).ok());
    const auto chosen = recorder::choose_topics({});
    REQUIRE(chosen.ok());
    CHECK(std::string((*chosen).back()->name) == "plab/states");
}

TEST_CASE("frames that were never received are noted in the file")
{
    MadeOptions made;
    made.missing_frame = 50;
    const std::string file = make_recording("playback_gap.mcap", made);
    const Again again = play_and_record(file, "gap", record_options("playback_gap_again.mcap"));
    CHECK(again.progress.missing == 1);
    const auto gap = open_file(again.file).metadata("gap");
    REQUIRE(gap.ok());
    std::string all;
    for (const auto& [key, value] : gap->values) all += key + "=" + value + "\n";
    CAPTURE(all);
    CHECK(all.find("plab/states") != std::string::npos);
}
