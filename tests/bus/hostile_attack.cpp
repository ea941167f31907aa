#include "hostile_attack.h"

#include <cstdlib>

#include "hostile_packets.h"
#include "idl/domain.h"
#include "server.h"

namespace plab::test
{
namespace
{

const std::string kScene = scene_file("fan_and_balloons.xml");

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
    return n;
}

link::Session session_in(std::uint32_t domain, const std::string& server)
{
    link::SessionOptions options;
    options.server = server, options.domain.id = domain;
    auto session = link::Session::find(options, Seconds(10));
    REQUIRE_MESSAGE(session.ok(), session.error().text());
    return session.take();
}

/// For a failure: whether the run continues, and the last messages.
std::string state_of(Server& server)
{
    const std::size_t before = server.process().output().size();
    std::this_thread::sleep_for(Milliseconds(300));
    const std::string said = server.process().errors();
    return "no answer; hashes in 0.3 s: " + std::to_string(server.process().output().size() - before) + " bytes; plab-bus ended " +
           std::to_string(count(said, "it will be restarted in")) +
           " times; last words: " + said.substr(said.size() - std::min<std::size_t>(said.size(), 3000));
}

/// What a client announces when it joins: all topics, with their types.
std::vector<Packet> captured(const link::Session& session)
{
    link::Catalogue all = catalogue(session);
    const auto frames = session.reader<plab_v2_Frame>();
    const auto events = session.reader<plab_v2_Events>();
    const auto caller = link::Caller::make(session, Seconds(5));
    REQUIRE((frames.ok() && events.ok() && caller.ok()));
    std::this_thread::sleep_for(Milliseconds(300));
    return sent_for_discovery();
}

}  // namespace

void attack(std::uint64_t packets, std::uint64_t seed, unsigned pause_us)
{
    // As users have it: pLab's own configuration.
    REQUIRE(unsetenv("CYCLONEDDS_URI") == 0);
    // A domain of its own, so that other participants are not harmed. Its ports are below the system's range of ephemeral ports.
    const auto domain = static_cast<std::uint32_t>(60 + getpid() % 40);
    REQUIRE(setenv("PLAB_DOMAIN", std::to_string(domain).c_str(), 1) == 0);
    Server server(kScene, {"--hashes", "--rate", "real"});
    const std::vector<Packet> good = captured(session_in(domain, server.name()));
    PacketMutator mutator(good, seed);
    REQUIRE(mutator.types() > 0);
    REQUIRE(mutator.announcements() > 0);
    const PacketSender sender(domain);
    for (std::uint64_t i = 0; i < packets; ++i)
    {
        const Packet packet = mutator.next();
        for (unsigned index = 0; index < 2; ++index) sender.send(packet, index);
        if (i % 32 == 31) std::this_thread::sleep_for(std::chrono::microseconds(32 * pause_us));
        if (i % 1000 == 0) REQUIRE(server.process().running());
    }
    // A well-behaved client is served by the present plab-bus.
    std::optional<link::Reply> reply;
    for (int i = 0; i < 20 && !reply; ++i)
    {
        const link::Session session = session_in(domain, server.name());
        auto caller = link::Caller::make(session, Seconds(5));
        if (!caller) continue;
        if (auto answer = caller->call({{{"pause"}}, {}, {}}, Seconds(5))) reply = answer.take();
    }
    if (!reply) FAIL(state_of(server));
    CHECK(reply->done());
    CHECK(server.end() == 0);
    const std::size_t deaths = count(server.process().errors(), "it will be restarted in");
    MESSAGE(packets << " packets, plab-bus ended " << deaths << " times");

    const std::string until = std::to_string(reply->time);
    const Outcome alone = run({program("plabd"), kScene, "--no-bus", "--hashes", "--until", until}, Milliseconds(120000));
    REQUIRE(alone.code == 0);
    const std::string disturbed = server.process().output();
    const std::size_t same = std::min(alone.output.rfind('\n'), disturbed.size());
    REQUIRE(same > 1000);
    CHECK(disturbed.compare(0, same, alone.output, 0, same) == 0);
}

}  // namespace plab::test
