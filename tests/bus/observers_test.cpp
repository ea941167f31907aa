// Observers change nothing: state hash and step time with observers, one of them stopped.
#include "server.h"

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

using namespace plab;
using namespace plab::test;

namespace
{

const std::string kScene = scene_file("fan_and_balloons.xml");

nlohmann::json end_of(const std::string& file)
{
    std::ifstream in(file);
    return nlohmann::json::parse(in);
}

}  // namespace

TEST_CASE("the state hash without observers equals that with five, one of them stopped")
{
    const std::string alone = scratch_file("alone.json"), watched = scratch_file("watched.json");
    REQUIRE(run({program("plabd"), kScene, "--no-bus", "--until", "8", "--out", alone}).code == 0);
    Server server(kScene, {"--paused", "--rate", "8", "--until", "8", "--out", watched, "--states", "all"});
    std::vector<Process> observers;
    for (int i = 0; i < 4; ++i)
        observers.emplace_back(std::vector<std::string>{program("plabctl"), "--server", server.name(), "watch", "states", "--json"});
    observers.emplace_back(std::vector<std::string>{program("plab-log"), "--server", server.name()});
    link::Session session = server.session();
    auto frames = session.reader<plab_v2_Frame>();
    REQUIRE(frames.ok());
    auto caller = link::Caller::make(session, Seconds(5));
    REQUIRE(caller.ok());
    std::this_thread::sleep_for(Milliseconds(500));
    observers[1].signal(19);  // SIGSTOP
    CHECK(ask(*caller, {"resume"}).done());
    std::int64_t last_step = 0;
    std::size_t count = 0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (server.process().running() && std::chrono::steady_clock::now() < end)
    {
        (void)session.wait(*frames, Seconds(0.1));
        (void)frames->take(
            [&](const plab_v2_Frame& f, const dds_sample_info_t& info)
            {
                if (!info.valid_data) return;
                CHECK(f.step >= last_step);
                CHECK(f.time == doctest::Approx(static_cast<double>(f.step) / 240).epsilon(1e-12));
                last_step = f.step, ++count;
            });
    }
    CHECK(server.process().wait(Milliseconds(5000)) == 0);
    CHECK(count > 500);
    CHECK(last_step > 1800);
    CHECK(observers[0].output().size() > 1000);
    CHECK(end_of(alone)["hash"] == end_of(watched)["hash"]);
    CHECK(end_of(alone)["step"] == end_of(watched)["step"]);
}

TEST_CASE("collisions and events arrive numbered, without gaps, with the data of the impact")
{
    Server server(kScene, {"--paused", "--rate", "max", "--until", "8"});
    link::Session session = server.session();
    auto collisions = session.reader<plab_v2_Collisions>();
    auto events = session.reader<plab_v2_Events>();
    auto caller = link::Caller::make(session, Seconds(5));
    REQUIRE(caller.ok());
    for (int i = 0; i < 100 && (collisions->writers() == 0 || events->writers() == 0); ++i) std::this_thread::sleep_for(Milliseconds(10));
    REQUIRE(collisions->writers() == 1);
    CHECK(ask(*caller, {"set", "red", "", "", {{"mass", "0.021"}}}).done());
    CHECK(ask(*caller, {"resume"}).done());
    (void)server.process().wait(Milliseconds(20000));
    std::map<std::string, int> kinds;
    std::uint64_t next = 1;
    (void)collisions->take(
        [&](const plab_v2_Collisions& batch, const dds_sample_info_t& info)
        {
            if (!info.valid_data) return;
            CHECK(batch.sequence_number == next);
            next += batch.entries._length;
            for (std::uint32_t i = 0; i < batch.entries._length; ++i)
            {
                const plab_v2_CollisionInfo& c = batch.entries._buffer[i];
                ++kinds[c.kind];
                CHECK(std::string(c.detector) == "contact");
                if (std::string(c.kind) != "impact") continue;
                CHECK(std::sqrt(c.normal.x * c.normal.x + c.normal.y * c.normal.y + c.normal.z * c.normal.z) == doctest::Approx(1.0));
                CHECK(std::abs(c.impulse.x) > 1e-6);
                CHECK(c.position.x > 1.4);
                CHECK(c.position.x < 2.6);
            }
        });
    CHECK(kinds["begin"] == 1);
    CHECK(kinds["impact"] == 1);
    CHECK(kinds["end"] == 1);
    std::vector<std::string> seen;
    (void)events->take(
        [&](const plab_v2_Events& batch, const dds_sample_info_t& info)
        {
            for (std::uint32_t i = 0; info.valid_data && i < batch.entries._length; ++i) seen.emplace_back(batch.entries._buffer[i].kind);
        });
    REQUIRE(seen.size() >= 2);
    CHECK(seen[0] == "request.set");
    CHECK(seen[1] == "request.resume");
}

TEST_CASE("a late observer of a paused server sees the scene and one frame")
{
    Server server(kScene, {"--paused"});
    link::Session session = server.session();
    auto frames = session.reader<plab_v2_Frame>();
    REQUIRE(frames.ok());
    REQUIRE(session.wait(*frames, Seconds(5)));
    std::uint32_t bodies = 0, shafts = 0;
    (void)frames->take([&](const plab_v2_Frame& f, const dds_sample_info_t&) { bodies = f.bodies._length, shafts = f.shafts._length; });
    CHECK(bodies == 2);
    CHECK(shafts == 6);
    // So does a second one, although the first is still there and nothing has moved.
    auto second = session.reader<plab_v2_Frame>();
    REQUIRE(second.ok());
    CHECK(session.wait(*second, Seconds(5)));
    const link::Catalogue known = catalogue(session);
    CHECK(known.now().types.size() > 20);
    // Known from the manifest, without loading its plugin.
    const link::Type& gravity = known.now().types.at("Field/Gravity");
    CHECK_FALSE(gravity.is_loaded);
    CHECK(gravity.fields.size() == 1);
    CHECK(gravity.roles.size() == 1);
    CHECK(known.now().types.at("Script/Lua").is_loaded);
}
