// plabd as a service: start, one name, signals, pauses, and what it leaves out.
#include "server.h"

#include <nlohmann/json.hpp>

using namespace plab;
using namespace plab::test;

TEST_CASE("a server is ready, is found by name, and ends at SIGTERM and SIGINT with exit code 0")
{
    for (const int signal : {15, 2})
    {
        Server server(scene_file("fan_and_balloons.xml"));
        const link::Session session = server.session();
        const auto servers = session.servers(Seconds(2), 1);
        REQUIRE(servers.size() == 1);
        CHECK(servers[0].name == server.name());
        CHECK(servers[0].process == server.process().pid());
        link::Catalogue known = catalogue(session);
        CHECK(known.now().objects.size() == 8);
        server.process().signal(signal);
        CHECK(server.process().wait(Milliseconds(5000)) == 0);
        // Readers see that all instances are disposed of.
        CHECK(shows(known,
                    [](const link::CatalogueContents& now) { return now.objects.empty() && now.interactions.empty() && !now.server; }));
    }
}

TEST_CASE("a second server of one name is refused, one of another name is not")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    const Outcome second = run({program("plabd"), scene_file("fan_and_balloons.xml"), "--name", server.name(), "--until", "1"});
    CHECK(second.code == 1);
    CHECK(has(second.errors, server.name()));
    CHECK(has(second.errors, std::to_string(server.process().pid())));
    Server other(scene_file("fan_and_balloons.xml"), {"--paused"});
    CHECK(other.session().servers(Seconds(0.3)).size() == 1);
    CHECK(other.end() == 0);
    CHECK(server.end() == 0);
}

TEST_CASE("the name is free again as soon as its server has ended, also after SIGKILL")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    server.process().signal(9);
    CHECK(server.process().wait(Milliseconds(5000)) == 137);
    const Outcome next = run({program("plabd"), scene_file("fan_and_balloons.xml"), "--name", server.name(), "--until", "0.1"});
    CHECK_MESSAGE(next.code == 0, next.errors);
}

TEST_CASE("no DDS is mapped; without the bus there is one thread, with it there are more")
{
    Process alone({program("plabd"), scene_file("fan_and_balloons.xml"), "--no-bus"});
    std::this_thread::sleep_for(Milliseconds(700));
    REQUIRE(alone.running());
    CHECK_FALSE(maps(alone.pid(), "libddsc"));
    CHECK_FALSE(maps(alone.pid(), "bus.so"));
    CHECK(threads_of(alone.pid()) == 1);
    // With a table a second one shows what a long step is at.
    Process shown({program("plabd"), scene_file("fan_and_balloons.xml"), "--no-bus", "--table"});
    REQUIRE(shown.wait_for("step", Milliseconds(5000)));
    CHECK_FALSE(maps(shown.pid(), "libddsc"));
    CHECK(threads_of(shown.pid()) == 2);
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    CHECK_FALSE(maps(server.process().pid(), "libddsc"));  // plab-bus does: restart_test.cpp
    CHECK(maps(server.process().pid(), "bus.so"));
    CHECK(threads_of(server.process().pid()) > 1);
    // Libraries that only some scenes need: without a camera, no OSMesa.
    CHECK_FALSE(maps(server.process().pid(), "OSMesa"));
}

TEST_CASE("a paused server uses below one percent of a core, and still answers")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    const link::Session session = server.session();
    auto caller = link::Caller::make(session, Seconds(5));
    REQUIRE(caller.ok());
    std::this_thread::sleep_for(Milliseconds(500));
    const double before = cpu_seconds(server.process().pid());
    std::this_thread::sleep_for(Milliseconds(3000));
    const double used = cpu_seconds(server.process().pid()) - before;
    CHECK_MESSAGE(used <= 0.03, "CPU seconds in 3 s: ", used);
    const link::Reply reply = ask(*caller, {"step", "", "10"});
    CHECK(reply.done());
    std::this_thread::sleep_for(Milliseconds(300));
    CHECK(ask(*caller, {"pause"}).step == 10);
}

TEST_CASE("real time is kept without drift, and a rate can be changed while it runs")
{
    Server server(scene_file("fan_and_balloons.xml"));
    const link::Session session = server.session();
    auto caller = link::Caller::make(session, Seconds(5));
    REQUIRE(caller.ok());
    const auto measure = [&](double seconds)
    {
        const auto begin = std::chrono::steady_clock::now();
        const double from = ask(*caller, {"rate", "", seconds > 0 ? "real" : "4"}).time;
        std::this_thread::sleep_for(Milliseconds(1500));
        const double to = ask(*caller, {"rate", "", seconds > 0 ? "real" : "4"}).time;
        return (to - from) / std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    CHECK(measure(1) == doctest::Approx(1.0).epsilon(0.05));
    CHECK(measure(0) == doctest::Approx(4.0).epsilon(0.05));
}

TEST_CASE("a server too slow for its rate slips, reports it, and keeps no backlog")
{
    // 1/240 s per step at a million times real time is out of reach for any machine.
    Server server(scene_file("fan_and_balloons.xml"), {"--rate", "1000000"});
    REQUIRE(server.process().wait_for("too slow for the rate", Milliseconds(5000)));
    const link::Session session = server.session();
    auto caller = link::Caller::make(session, Seconds(5));
    REQUIRE(caller.ok());
    const auto servers = session.servers(Seconds(2), 1);
    REQUIRE(servers.size() == 1);
    CHECK(servers[0].slipped > 0);
    // Back in real time it does not make up for the lost time.
    const double from = ask(*caller, {"rate", "", "real"}).time;
    std::this_thread::sleep_for(Milliseconds(500));
    CHECK(ask(*caller, {"pause"}).time - from < 1.0);
    CHECK(server.end() == 0);
}
