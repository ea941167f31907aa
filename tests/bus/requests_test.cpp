// Requests over the bus against a real server: exactly once, at their step, for their client only.
#include "server.h"

using namespace plab;
using namespace plab::test;

namespace
{

struct Client
{
    explicit Client(const Server& server) : session(server.session()), caller(make(session)) {}
    static link::Caller make(const link::Session& session)
    {
        auto caller = link::Caller::make(session, Seconds(5));
        REQUIRE_MESSAGE(caller.ok(), caller.error().text());
        return caller.take();
    }
    link::Session session;
    link::Caller caller;
};

}  // namespace

TEST_CASE("a swap takes effect at the step that it names, and the reply reports its effect")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--rate", "max", "--paused"});
    Client client(server);
    link::Request swap{{{"swap", "gears", "Constraint/AngularVelocity/Impulse"}}, 100, {}};
    const std::uint64_t number = send_waiting(client.caller, swap);
    Client other(server);
    CHECK(ask(other.caller, {"step", "", "200"}).done());
    bool answered = false;
    for (int i = 0; i < 200 && !answered; ++i)
    {
        std::this_thread::sleep_for(Milliseconds(20));
        client.caller.take(
            [&](std::uint64_t of, link::Reply reply)
            {
                answered = true;
                CHECK(of == number);
                CHECK_MESSAGE(reply.done(), reasons(reply));
                CHECK(reply.step == 100);
                CHECK(reply.revision == 1);
                REQUIRE(reply.swaps.size() == 1);
                CHECK(reply.swaps[0].from_type == "Constraint/AngularVelocity/Graph");
                CHECK(reply.swaps[0].to_type == "Constraint/AngularVelocity/Impulse");
                CHECK(reply.swaps[0].fields.size() > 3);
                CHECK(reply.pause_ns > 0);
                CHECK(reply.swaps[0].with_new.energy == doctest::Approx(reply.swaps[0].with_old.energy).epsilon(1e-3));
            });
    }
    CHECK(answered);
    // A step that has passed is refused as late, and so is another revision.
    const link::Reply late = ask(client.caller, link::Request{{{"pause"}}, 5, {}});
    CHECK(late.outcome == "late");
    const link::Reply stale = ask(client.caller, link::Request{{{"remove", "gears"}}, {}, 0});
    CHECK(stale.outcome == "refused");
    CHECK(has(reasons(stale), "revision 1"));
}

TEST_CASE("a call in pieces looks up while its reply is to come, and a new one takes its place")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--rate", "max", "--paused"});
    Client client(server), other(server);
    REQUIRE(client.caller.begin(link::Request{{{"pause"}}, 1000000, {}}).ok());
    REQUIRE(client.caller.begin(link::Request{{{"pause"}}, 100, {}}).ok());
    const auto early = client.caller.wait(Seconds(0.2));
    REQUIRE(early.ok());
    CHECK(!early->has_value());
    CHECK(ask(other.caller, {"step", "", "200"}).done());
    std::optional<link::Reply> reply;
    for (int i = 0; i < 100 && !reply; ++i)
    {
        auto piece = client.caller.wait(Seconds(0.05));
        REQUIRE_MESSAGE(piece.ok(), piece.error().text());
        reply = piece.take();
    }
    REQUIRE(reply.has_value());
    CHECK(reply->done());
    CHECK(reply->step == 100);
    CHECK(!reply->repeated);
}

TEST_CASE("a request that is sent again is carried out once, and its answer is repeated")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    Client client(server);
    const link::Request step{{{"step", "", "3"}}, {}, {}};
    auto number = client.caller.send(step);
    REQUIRE(number.ok());
    std::this_thread::sleep_for(Milliseconds(200));
    for (int i = 0; i < 4; ++i) REQUIRE(client.caller.send_again(step, *number).ok());
    std::this_thread::sleep_for(Milliseconds(500));
    int first = 0, repeated = 0;
    client.caller.take(
        [&](std::uint64_t of, link::Reply reply)
        {
            CHECK(of == *number);
            CHECK(reply.done());
            ++(reply.repeated ? repeated : first);
        });
    CHECK(first == 1);
    CHECK(repeated == 4);
    CHECK(ask(client.caller, {"pause"}).step == 3);
}

TEST_CASE("replies go to the client that asked")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    Client a(server), b(server);
    for (int i = 0; i < 10; ++i) CHECK(ask(a.caller, {"step", "", "1"}).done());
    int seen = 0;
    b.caller.take([&](std::uint64_t, link::Reply) { ++seen; });
    CHECK(seen == 0);
    CHECK(ask(b.caller, {"pause"}).done());
}

TEST_CASE("several operations are one transaction: all or none")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    Client client(server);
    const link::Reply refused =
        ask(client.caller, link::Request{{{"set", "red", "", "", {{"mass", "0.05"}}}, {"remove", "no_such"}}, {}, {}});
    CHECK(refused.outcome == "refused");
    CHECK(has(reasons(refused), "no_such"));
    link::Catalogue known = catalogue(client.session);
    CHECK(known.now().objects.at("red").mass == doctest::Approx(0.02));
    CHECK(ask(client.caller, {"set", "red", "", "", {{"mass", "50 g"}}}).done());
    CHECK(shows(known, [](const link::CatalogueContents& now) { return now.objects.at("red").mass == doctest::Approx(0.05); }));
}

TEST_CASE("components are added and removed: the catalogue follows, and components in use are protected")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    Client client(server);
    link::Catalogue known = catalogue(client.session);
    const auto type_is = [&](const std::string& id, const std::string& type)
    {
        return shows(known,
                     [&](const link::CatalogueContents& now)
                     {
                         const auto found = now.interactions.find(id);
                         return type.empty() ? found == now.interactions.end()
                                             : found != now.interactions.end() && found->second.type_name == type;
                     });
    };
    CHECK(type_is("contact.response", "Response/Impulse"));
    const link::Reply added =
        ask(client.caller, {"add", "", "", "<component id=\"weight\" type=\"Field/Gravity\" between=\"*\" acceleration=\"0 0 -1\"/>"});
    CHECK_MESSAGE(added.done(), reasons(added));
    CHECK(type_is("weight", "Field/Gravity"));
    CHECK(ask(client.caller, {"swap", "contact.response", "Response/None"}).done());
    CHECK(type_is("contact.response", "Response/None"));
    const link::Reply used = ask(client.caller, {"remove", "red"});
    CHECK(used.outcome == "refused");
    CHECK(has(reasons(used), "still used"));
    CHECK(ask(client.caller, {"remove", "weight"}).done());
    CHECK(type_is("weight", ""));
    // A fragment with an error changes nothing and says where it is.
    const link::Reply bad = ask(client.caller, {"add", "", "more.xml", "<component id=\"w\" type=\"Field/Gravty\" between=\"*\"/>"});
    CHECK(bad.outcome == "refused");
    CHECK_MESSAGE(has(reasons(bad), "more.xml:1:"), reasons(bad));
    CHECK(has(reasons(bad), "Field/Gravity"));
}

TEST_CASE("load, reset, dt and shutdown")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    Client client(server);
    CHECK(ask(client.caller, {"step", "", "5"}).done());
    std::this_thread::sleep_for(Milliseconds(200));
    const link::Reply reset = ask(client.caller, {"reset"});
    CHECK(reset.done());
    CHECK(reset.run == 2);
    CHECK(ask(client.caller, {"dt", "", "1/480"}).done());
    const link::Reply load =
        ask(client.caller, {"load", "", "small.xml",
                            "<plab version=\"1\"><scene dt=\"1/100\"/><component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" "
                            "inertia=\"1 1 1\"/></plab>"});
    CHECK_MESSAGE(load.done(), reasons(load));
    CHECK(load.run == 3);
    const link::Reply bad =
        ask(client.caller, {"load", "", "bad.xml", "<plab version=\"1\"><component id=\"a\" type=\"Nothing\"/></plab>"});
    CHECK(bad.outcome == "refused");
    CHECK(bad.run == 3);
    CHECK(has(reasons(bad), "bad.xml:1:"));
    CHECK(ask(client.caller, {"push", "ball", "", "", {{"impulse", "0 0 2"}}}).done());
    CHECK(ask(client.caller, {"shutdown"}).done());
    CHECK(server.process().wait(Milliseconds(5000)) == 0);
}

TEST_CASE("clients with waiting requests get a reply when the server ends, and it ends with success")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    Client client(server);
    const std::uint64_t number = send_waiting(client.caller, link::Request{{{"pause"}}, 900'000'000, {}});
    Client other(server);
    CHECK(ask(other.caller, {"step", "", "1"}).done());
    server.process().signal(15);
    bool reported = false;
    for (int i = 0; i < 100 && !reported; ++i)
    {
        std::this_thread::sleep_for(Milliseconds(20));
        client.caller.take(
            [&](std::uint64_t of, const link::Reply& reply)
            {
                if (of != number) return;
                reported = true;
                CHECK(reply.outcome == "refused");
                CHECK(has(reasons(reply), "the server ended"));
            });
    }
    CHECK(reported);
    CHECK(server.process().wait(Milliseconds(5000)) == 0);
}

TEST_CASE("a request for a step of a run that is over is refused, not carried out in the next one")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    Client client(server);
    const std::uint64_t number = send_waiting(client.caller, link::Request{{{"remove", "gears"}}, 600, {}});
    Client other(server);  // call() of the first would throw the other reply away
    const link::Reply reset = ask(other.caller, {"reset"});
    CHECK(reset.done());
    CHECK(reset.step == 0);
    bool reported = false;
    for (int i = 0; i < 100 && !reported; ++i)
    {
        std::this_thread::sleep_for(Milliseconds(20));
        client.caller.take([&](std::uint64_t of, const link::Reply& reply)
                           { reported = reported || (of == number && has(reasons(reply), "new run")); });
    }
    CHECK(reported);
}

TEST_CASE("SIGHUP ends a server as SIGTERM does")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    server.process().signal(1);
    CHECK(server.process().wait(Milliseconds(5000)) == 0);
}
