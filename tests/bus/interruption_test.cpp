// A server in the middle of a step that takes minutes: it reports that, answers what can be answered, and ends on request.
#include <fstream>

#include "server.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string long_scene()
{
    const std::string file = scratch_file("long_step_bus.xml");
    std::ofstream(file) << R"(<plab version="1"><scene dt="2000" solver="s"/><component id="r" type="Shape/Sphere" radius="0.1"/>
      <component id="a" type="State/RigidBody" mass="1" shape="r" position="1 0 0"/><component id="b" type="State/RigidBody" mass="1" shape="r"/>
      <component id="spring" type="Constraint/SpringDamper" a="a" b="b" length="0.5" stiffness="1e8"/>
      <component id="s" type="Solver/DormandPrince54" max_substeps="10000000"/></plab>)";
    return file;
}

Outcome plabctl(const Server& server, std::vector<std::string> arguments)
{
    std::vector<std::string> command{program("plabctl"), "--server", server.name()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run(std::move(command));
}

}  // namespace

TEST_CASE(
    "during a long step, its progress is reported, reading requests are answered, a request can be cancelled, and shutdown ends the step")
{
    Server server(long_scene(), {"--rate", "max"});
    Outcome seen;
    for (int i = 0; i < 50 && !has(seen.output, "step 0: advance"); ++i) seen = plabctl(server, {"servers"});
    CHECK_MESSAGE(has(seen.output, "step 0: advance"), seen.output);
    CHECK(has(seen.output, "for "));
    for (const auto& reading : {std::vector<std::string>{"show", "spring"}, {"types", "Response/"}, {"interactions"}, {"objects"}})
    {
        const Outcome read = plabctl(server, reading);
        CHECK_MESSAGE(read.code == 0, reading.front(), ": ", read.errors);
    }
    // A time-out says that the request may still take effect, and how it is cancelled.
    const Outcome late = plabctl(server, {"set", "spring.damping=1", "--timeout", "0.5"});
    CHECK(late.code == 3);
    CHECK_MESSAGE(has(late.errors, "can take effect before its next step"), late.errors);
    const std::size_t at = late.errors.find(" cancel ");
    REQUIRE_MESSAGE(at != std::string::npos, late.errors);
    const std::string name = late.errors.substr(at + 8, late.errors.find('\'', at) - at - 8);
    CHECK(name.size() == 34);
    const auto begin = std::chrono::steady_clock::now();
    const Outcome end = plabctl(server, {"shutdown"});
    CHECK_MESSAGE(end.code == 0, end.errors);
    CHECK(server.process().wait(Milliseconds(2000)) == 3);
    CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < 2);
    CHECK(has(server.process().errors(), "abandoned"));
}

TEST_CASE("shutdown ends a server at once, also a paused one")
{
    for (const char* option : {"--paused", "--rate=real"})
    {
        Server server(scene_file("fan_and_balloons.xml"), {option});
        const auto begin = std::chrono::steady_clock::now();
        CHECK(plabctl(server, {"shutdown"}).code == 0);
        CHECK(server.process().wait(Milliseconds(5000)) == 0);
        CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < 0.8);
    }
}

TEST_CASE("a waiting request is withdrawn by cancel, and its client gets a reply")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    const link::Session session = server.session();
    auto waiting = link::Caller::make(session, Seconds(5));
    REQUIRE(waiting.ok());
    const link::Request swap{{{"swap", "contact.response", "Response/None"}}, 100, {}};
    const auto number = waiting->send(swap);
    REQUIRE(number.ok());
    std::this_thread::sleep_for(Milliseconds(200));
    const Outcome cancelled = plabctl(server, {"cancel", waiting->last_request()});
    CHECK_MESSAGE(cancelled.code == 0, cancelled.errors);
    std::string why;
    for (int i = 0; i < 50 && why.empty(); ++i)
    {
        std::this_thread::sleep_for(Milliseconds(20));
        waiting->take(
            [&](std::uint64_t of, const link::Reply& reply)
            {
                CHECK(of == *number);
                CHECK(reply.outcome == "refused");
                why = reply.reasons.empty() ? "nothing" : reply.reasons.front();
            });
    }
    CHECK(has(why, "cancelled"));
    const Outcome again = plabctl(server, {"cancel", waiting->last_request()});
    CHECK(again.code == 4);
    CHECK(has(again.errors, "no such request is waiting"));
}

TEST_CASE("one swap of plabctl exchanges all components that a pattern and a list name, and reports how it was checked")
{
    Server server(scene_file("fan_and_balloons.xml"), {"--paused"});
    const Outcome all = plabctl(server, {"swap", "axle_to_*", "gears", "--to", "Constraint/AngularVelocity/Impulse"});
    CHECK_MESSAGE(all.code == 0, all.errors);
    for (const char* id : {"axle_to_gear:", "axle_to_fan:", "gears:"}) CHECK_MESSAGE(has(all.output, id), all.output);
    CHECK(has(all.output, "trial made"));
    const Outcome none = plabctl(server, {"swap", "gears", "--to", "Constraint/AngularVelocity/Graph", "--trial", "none"});
    CHECK(none.code == 0);
    CHECK(has(none.output, "not tried"));
}
