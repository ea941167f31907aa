// People on the bus: hands at 1 kHz, what they feel, who may move what, and the same run again from a recording.
#include "link/person.h"
#include "server.h"

#include <fstream>
#include <set>

using namespace plab;
using namespace plab::test;

namespace
{

using Clock = std::chrono::steady_clock;

std::string scene_of_hands(const std::string& name, int hands)
{
    std::string text = "<plab version='1'><scene dt='1/240'/><component id='solver' type='Solver/RungeKutta4'/>";
    for (int i = 0; i < hands; ++i)
    {
        const std::string k = std::to_string(i);
        text += "<component id='hand" + k + "' type='State/User' position='0 " + k + " 0'/><component id='cup" + k +
                "' type='State/RigidBody' mass='2' inertia='0.1 0.1 0.1' position='0 " + k + " 0'/><component id='grab" + k +
                "' type='Constraint/Grab' user='hand" + k + "' body='cup" + k + "' reach='0.1'/>";
    }
    text += "<component id='eye' type='Viewer/Free'/><component id='g' type='Field/Gravity' between='*'/></plab>";
    const std::string file = scratch_file(name);
    std::ofstream(file) << text;
    return file;
}

wire::UserSample at(const Vec3& position, double grip, const Vec3& velocity = {})
{
    wire::UserSample s;
    s.position = position, s.grip = grip, s.linear_velocity = velocity;
    return s;
}

/// Sends samples at a rate for a time; made by make(t).
template <class Writer, class Make>
void stream(Writer& writer, double rate, double seconds, Make make)
{
    const auto begin = Clock::now();
    const auto all = static_cast<int>(rate * seconds);
    for (int n = 0; n < all; ++n)
    {
        std::this_thread::sleep_until(begin + std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * n / rate)));
        REQUIRE(writer.send(make(n / rate)).ok());
    }
}

struct Felt
{
    std::uint64_t entries = 0, number = 0, skipped = 0;
    Vec3 force;
};

Felt newest(wire::DataReader<plab_v2_Forces>& forces, const std::string& user, Felt felt = {})
{
    (void)forces.take(
        [&](const plab_v2_Forces& f, const dds_sample_info_t& info)
        {
            for (const plab_v2_UserForce& u : wire::items(f.entries))
                if (info.valid_data && user == u.user)
                    ++felt.entries, felt.number = u.number, felt.skipped = u.skipped, felt.force = {u.force.x, u.force.y, u.force.z};
        });
    return felt;
}

/// Waits for an event of this kind.
bool hears(const link::Session& session, wire::DataReader<plab_v2_Events>& events, const std::string& kind)
{
    bool found = false;
    for (int i = 0; i < 100 && !found; ++i)
    {
        (void)session.wait(events, Seconds(0.05));
        (void)events.take(
            [&](const plab_v2_Events& e, const dds_sample_info_t& info)
            {
                for (const plab_v2_EventInfo& entry : wire::items(e.entries)) found = found || (info.valid_data && kind == entry.kind);
            });
    }
    return found;
}

}  // namespace

TEST_CASE("a hand at 1 kHz holds a cup, feels its weight, and the recording is the same run again")
{
    const std::string file = scratch_file("hands.mcap");
    Server server(scene_of_hands("hands.xml", 1), {"--record", file, "--overwrite", "--paused"});
    const auto session = server.session();
    auto events = session.reader<plab_v2_Events>();
    auto forces = session.reader<plab_v2_Forces>();
    REQUIRE((events.ok() && forces.ok()));
    {
        auto hand = link::UserWriter::open(session, "hand0", Seconds(5));
        REQUIRE_MESSAGE(hand.ok(), hand.error().text());
        REQUIRE(hand->send(at({}, 1)).ok());
        CHECK(control(server, {"resume"}).code == 0);
        stream(*hand, 1000, 1, [](double t) { return at({0, 0, 0.1 * t}, 1, {0, 0, 0.1}); });
        stream(*hand, 1000, 1, [](double) { return at({0, 0, 0.1}, 1); });
        const Felt felt = newest(*forces, "hand0");
        CHECK(felt.entries > 0);
        CHECK(felt.number > 1900);
        // Four samples come between two steps, of which one counts.
        CHECK(felt.skipped > 1000);
        CHECK(distance(felt.force, {0, 0, -2 * 9.81}) < 0.1);
    }
    // Gone: it lets go, and the cup falls.
    CHECK(hears(session, *events, "grab.released"));
    CHECK(server.end() == 0);
    const Outcome verified = run({program("plabd"), "--replay", file, "--verify"});
    CHECK_MESSAGE(verified.code == 0, verified.errors);
    // Its inputs are in the journal, in the name of the user.
    const Outcome journal = run({program("plabctl"), "log", file});
    CHECK(journal.output.find("grab.released") != std::string::npos);
}

TEST_CASE("many users at once; a component is moved by one client, and by another when that is gone")
{
    Server server(scene_of_hands("many.xml", 8), {"--paused"});
    const auto session = server.session();
    auto forces = session.reader<plab_v2_Forces>();
    auto events = session.reader<plab_v2_Events>();
    REQUIRE((forces.ok() && events.ok()));
    std::vector<link::UserWriter> hands;
    for (int i = 0; i < 8; ++i)
    {
        auto hand = link::UserWriter::open(session, "hand" + std::to_string(i), Seconds(5));
        REQUIRE(hand.ok());
        REQUIRE(hand->send(at({0, 1.0 * i, 0}, 1)).ok());
        hands.push_back(hand.take());
    }
    CHECK(control(server, {"resume"}).code == 0);
    const auto begin = Clock::now();
    for (int n = 0; n < 500; ++n)
    {
        std::this_thread::sleep_until(begin + std::chrono::milliseconds(2 * n));
        for (int i = 0; i < 8; ++i) REQUIRE(hands[static_cast<std::size_t>(i)].send(at({0, 1.0 * i, 0}, 1)).ok());
    }
    std::map<std::string, Vec3> felt;
    std::set<wire::ClientId> clients;
    (void)forces->take(
        [&](const plab_v2_Forces& f, const dds_sample_info_t& info)
        {
            for (const plab_v2_UserForce& u : wire::items(f.entries))
                if (info.valid_data)
                {
                    felt[u.user] = {u.force.x, u.force.y, u.force.z};
                    wire::ClientId id;
                    std::copy(std::begin(u.client), std::end(u.client), id.begin());
                    clients.insert(id);
                }
        });
    REQUIRE(felt.size() == 8);
    CHECK(clients.size() == 8);
    for (const auto& [user, force] : felt) CHECK_MESSAGE(distance(force, {0, 0, -2 * 9.81}) < 0.1, user);

    // Another client for hand3 is told that it is taken; when its owner goes, hand3 lets go, and can be moved again.
    auto second = link::UserWriter::open(session, "hand3", Seconds(5));
    REQUIRE(second.ok());
    stream(*second, 100, 0.1, [](double) { return at({5, 3, 0}, 0); });
    CHECK(hears(session, *events, "user.refused"));
    hands.erase(hands.begin() + 3);
    CHECK(hears(session, *events, "grab.released"));
    stream(*second, 100, 0.3, [](double) { return at({5, 3, 0}, 0); });
    const Outcome moved = control(server, {"show", "hand3"});
    CHECK_MESSAGE(moved.output.find("5 3 0 m") != std::string::npos, moved.output);
    CHECK(server.end() == 0);
}

TEST_CASE("a viewer's samples move the first viewer; what is no number is dropped")
{
    Server server(scene_of_hands("eyes.xml", 1));
    const auto session = server.session();
    auto journal = session.reader<plab_v2_Journal>();
    auto eye = link::ViewerWriter::open(session, "", Seconds(5));
    REQUIRE((eye.ok() && journal.ok()));
    wire::ViewerSample s;
    s.position = {1, 2, 3}, s.direction = {0, 1, 0};
    stream(*eye, 100, 0.2, [&](double) { return s; });
    int in_journal = 0;
    (void)journal->take(
        [&](const plab_v2_Journal& j, const dds_sample_info_t& info)
        {
            if (info.valid_data && j.origin == std::string("viewer") && j.operations._buffer[0].target == std::string("eye")) ++in_journal;
        });
    CHECK(in_journal > 10);
    wire::ViewerSample broken = s;
    broken.position.x = std::nan("");
    stream(*eye, 100, 0.1, [&](double) { return broken; });
    std::this_thread::sleep_for(std::chrono::milliseconds(600));  // the catalogue follows four times a second
    const Outcome shown = control(server, {"show", "eye"});
    CHECK_MESSAGE(shown.output.find("1 2 3") != std::string::npos, shown.output);
    CHECK(server.end() == 0);
}

TEST_CASE("plabctl grab carries a body and lets go; plabctl view flies along a way")
{
    Server server(scene_of_hands("carry.xml", 1));
    const Outcome grab = control(server, {"grab", "cup0", "--by", "0 0 0.5", "--over", "0.5", "--for", "1", "--force", "200"});
    CHECK_MESSAGE(grab.code == 0, grab.errors);
    CHECK(grab.output.find("released cup0") != std::string::npos);
    const Outcome view = control(server, {"view", "0 0 2", "1 0 2", "--speed", "5", "--json"});
    CHECK_MESSAGE(view.code == 0, view.errors);
    CHECK(view.output.find("\"way\":1.0") != std::string::npos);
    CHECK(control(server, {"grab", "hand0"}).code != 0);
    CHECK(server.end() == 0);
}
