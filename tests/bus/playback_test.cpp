// A run of plabd, recorded from the bus, played on it and recorded again: real programs, each in its own process.
#include "server.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "idl/recording/cdr.h"
#include "idl/recording/reader.h"

using namespace plab;
using namespace plab::test;

namespace
{

const std::string kScene = scene_file("fan_and_balloons.xml");

std::string fresh(const std::string& name)
{
    const std::string file = scratch_file(name);
    std::filesystem::remove(file);
    return file;
}

recording::McapReader open_file(const std::string& file)
{
    auto reader = recording::McapReader::open(file);
    REQUIRE_MESSAGE(reader.ok(), reader.error().text());
    return reader.take();
}

/// All messages of a topic, in their order.
std::vector<recording::Bytes> messages_of(const std::string& file, const std::string& topic)
{
    const recording::McapReader reader = open_file(file);
    std::vector<recording::Bytes> out;
    recording::Cursor cursor = reader.messages({{topic}});
    for (auto next = cursor.next(); next && *next; next = cursor.next())
        out.emplace_back((*next)->message.data.begin(), (*next)->message.data.end());
    return out;
}

std::string bytes_of(const std::string& file)
{
    std::ifstream in(file, std::ios::binary);
    std::stringstream out;
    out << in.rdbuf();
    return out.str();
}

/// Four seconds of the scene with a swap in the first, recorded once for all tests.
const std::string& recorded()
{
    static const std::string file = []
    {
        const std::string out = fresh("play_first.mcap");
        const Server server(kScene, {"--paused", "--rate", "4", "--swap", "240:gears=Constraint/AngularVelocity/Impulse"});
        Process record({program("plabctl"), "--server", server.name(), "record", "-o", out, "--until", "4"});
        std::this_thread::sleep_for(Milliseconds(700));
        REQUIRE(control(server, {"resume"}).code == 0);
        REQUIRE_MESSAGE(record.wait(Milliseconds(15000)) == 0, record.errors());
        return out;
    }();
    return file;
}

Process play(const std::string& file, const std::string& name, std::vector<std::string> options)
{
    std::vector<std::string> command{program("plabctl"), "play", file, "--name", name};
    command.insert(command.end(), options.begin(), options.end());
    return Process(command);
}

Outcome ask(const std::string& name, std::vector<std::string> arguments)
{
    std::vector<std::string> command{program("plabctl"), "--server", name, "--timeout", "10"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run(command);
}

}  // namespace

TEST_CASE("played and recorded again, the states, events and collisions of a server are byte for byte the same")
{
    const std::string again = fresh("play_again.mcap"), name = unique_name("again");
    Process player = play(recorded(), name, {"--rate", "8", "--readers", "1"});
    const Outcome record = ask(name, {"record", "-o", again, "--json"});
    REQUIRE_MESSAGE(record.code == 0, record.errors);
    CHECK_MESSAGE(player.wait(Milliseconds(10000)) == 0, player.errors());
    const auto counts = nlohmann::json::parse(record.output);
    CHECK(counts["missing"] == 0);
    CHECK(counts["dropped"] == 0);
    CHECK(counts["broken"] == 0);
    for (const std::string topic : {"plab/states", "plab/events", "plab/collisions", "plab/hashes"})
    {
        CAPTURE(topic);
        const auto first = messages_of(recorded(), topic), second = messages_of(again, topic);
        CHECK(first.size() > 0);
        CHECK(first.size() == second.size());
        CHECK(first == second);
    }
    CHECK(messages_of(recorded(), "plab/states").size() > 20);
    CHECK(messages_of(again, "plab/gone").empty());  // the end of the server does not change the scene
    for (const char* topic : {"plab/objects", "plab/shapes", "plab/types"}) CHECK(messages_of(again, topic).size() > 2);
}

TEST_CASE("a removed component is absent from the file, and from its playback, from then on")
{
    const std::string file = fresh("play_removed.mcap"), name = unique_name("removed");
    {
        const Server server(kScene, {"--paused"});
        Process record({program("plabctl"), "--server", server.name(), "record", "-o", file});
        std::this_thread::sleep_for(Milliseconds(1000));
        CHECK(control(server, {"step", "10"}).code == 0);
        REQUIRE(control(server, {"remove", "wind"}).code == 0);
        std::this_thread::sleep_for(Milliseconds(800));  // until the disposal is accepted
        CHECK(control(server, {"step", "10"}).code == 0);
        std::this_thread::sleep_for(Milliseconds(500));
        record.signal(15);
        CHECK_MESSAGE(record.wait(Milliseconds(5000)) == 143, record.errors());  // the file is complete, and the exit code shows the signal
    }
    REQUIRE(messages_of(file, "plab/gone").size() == 1);
    const Process player = play(file, name, {"--loop", "--rate", "0.01"});
    link::SessionOptions options;
    options.server = name;
    const auto session = link::Session::find(options, Seconds(5));
    REQUIRE_MESSAGE(session.ok(), session.error().text());
    auto seen = link::Catalogue::open(*session, static_cast<link::Parts>(link::Part::Interactions));
    REQUIRE(seen.ok());
    const auto has_wind = [](const link::CatalogueContents& s) { return s.interactions.contains("wind"); };
    const auto has_none = [&](const link::CatalogueContents& s) { return s.interactions.size() > 3 && !has_wind(s); };
    CHECK(shows(*seen, has_wind));
    CHECK(shows(*seen, has_none));
    CHECK(shows(*seen, has_wind));  // the next repetition of the loop
}

TEST_CASE("a logger receives all events, and a playback server says that it is one and refuses requests")
{
    const std::string name = unique_name("logged"), copy = fresh("play_logged.mcap");
    Process player = play(recorded(), name, {"--rate", "8", "--readers", "1"});
    Process log({program("plab-log"), "--server", name, "--json"});
    const Outcome servers = run({program("plabctl"), "servers", "--json", "--timeout", "3"});
    CHECK_MESSAGE(has(servers.output, name), servers.errors);
    CHECK_MESSAGE(has(servers.output, "\"playback\":\"" + recorded() + "\""), servers.output);
    const Outcome pause = ask(name, {"pause"});
    CHECK(pause.code == 4);
    CHECK_MESSAGE(has(pause.errors, "this is a playback of "), pause.errors);
    std::this_thread::sleep_for(Milliseconds(500));  // until the logger has subscribed
    REQUIRE(ask(name, {"record", "-o", copy}).code == 0);
    CHECK(player.wait(Milliseconds(10000)) == 0);
    CHECK(log.wait_for("gone", Milliseconds(5000)));
    std::size_t reported = 0, happened = 0;
    std::istringstream lines(log.output());
    for (std::string line; std::getline(lines, line);) reported += has(line, "\"kind\"") ? 1u : 0u;
    recording::Decoder decoder;
    recording::Sample<plab_v2_Events> events;
    recording::Sample<plab_v2_Collisions> collisions;
    for (const auto& bytes : messages_of(recorded(), "plab/events"))
        if (decoder.decode(bytes, events)) happened += events->entries._length;
    for (const auto& bytes : messages_of(recorded(), "plab/collisions"))
        if (decoder.decode(bytes, collisions)) happened += collisions->entries._length;
    CHECK(happened > 3);
    CHECK(reported == happened);
}

TEST_CASE("a picture from the file and one of its playback are the same")
{
    const std::string name = unique_name("seen"), of_file = fresh("play_file.png"), of_bus = fresh("play_bus.png");
    const std::vector<std::string> look{"--at", "0.5", "--width", "320", "--height", "240"};
    const auto view = [&](std::vector<std::string> command)
    {
        command.insert(command.begin(), program("plab-view"));
        command.insert(command.end(), look.begin(), look.end());
        return run(command);
    };
    const Outcome from_file = view({recorded(), "--png", of_file});
    REQUIRE_MESSAGE(from_file.code == 0, from_file.errors);
    const Process player = play(recorded(), name, {"--readers", "1"});
    const Outcome from_bus = view({"--server", name, "--png", of_bus});
    REQUIRE_MESSAGE(from_bus.code == 0, from_bus.errors);
    CHECK(bytes_of(of_file).size() > 1000);
    CHECK(bytes_of(of_file) == bytes_of(of_bus));
}

TEST_CASE("a second player is refused; Ctrl-C ends a player and a recorder in an orderly way")
{
    const std::string name = unique_name("held"), file = fresh("play_held.mcap");
    Process player = play(recorded(), name, {"--loop", "--rate", "2"});
    Process record({program("plabctl"), "--server", name, "record", "-o", file});
    std::this_thread::sleep_for(Milliseconds(1500));
    Process second = play(recorded(), name, {});
    CHECK(second.wait(Milliseconds(5000)) == 1);
    CHECK_MESSAGE(has(second.errors(), "a server '" + name + "' is already running on this host"), second.errors());
    record.signal(2);
    CHECK(record.wait(Milliseconds(5000)) == 130);
    CHECK(open_file(file).index().is_closed);
    player.signal(2);
    CHECK(player.wait(Milliseconds(5000)) == 130);
    CHECK(run({program("plabctl"), "record", "-o", file, "--server", name, "--timeout", "0.3"}).code == 3);
    CHECK(run({program("plabctl"), "record", "--topics", "plab/statse"}).code == 2);
    CHECK(run({program("plabctl"), "play", file, "--rate", "0"}).code == 2);
    CHECK(run({program("plabctl"), "play", fresh("play_none.mcap")}).code == 1);
}
