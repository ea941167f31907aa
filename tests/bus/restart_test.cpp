// The step loop outlives plab-bus, which is ended in the middle of a run.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "idl/domain.h"
#include "server.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

using Clock = std::chrono::steady_clock;
const std::string kScene = scene_file("fan_and_balloons.xml");
constexpr double kStepsPerSecond = 240;
constexpr auto kSwapped = "Constraint/AngularVelocity/Impulse";

/// The plab-bus of a plabd; 0: none at present.
int bus_of(int server)
{
    for (const auto& entry : std::filesystem::directory_iterator("/proc"))
    {
        std::ifstream in(entry.path() / "stat");
        int pid = 0, parent = 0;
        std::string name, state;
        if (in >> pid >> name >> state >> parent && parent == server && name == "(plab-bus)" && state != "Z") return pid;
    }
    return 0;
}

/// Whether a process exists and is not a zombie.
bool runs(int pid)
{
    std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
    std::string id, name, state;
    return in >> id >> name >> state && state != "Z";
}

int another_bus(Server& server, int than)
{
    for (int i = 0; i < 400; ++i, std::this_thread::sleep_for(Milliseconds(5)))
        if (const int pid = bus_of(server.process().pid()); pid != 0 && pid != than) return pid;
    return 0;
}

/// "step hash" lines.
std::map<std::int64_t, std::string> hashes_in(const std::string& text)
{
    std::map<std::int64_t, std::string> out;
    std::istringstream in(text);
    std::int64_t step = 0;
    for (std::string hash; in >> step >> hash;) out[step] = hash;
    return out;
}

/// Seconds until a frame of a later step than any before has arrived.
double seconds_to_frame(const link::Session& session, wire::DataReader<plab_v2_Frame>& frames)
{
    std::int64_t last = -1;
    const auto note = [&](const plab_v2_Frame& f, const dds_sample_info_t& info)
    { last = info.valid_data ? std::max(last, f.step) : last; };
    (void)frames.take(note);
    const auto begin = Clock::now();
    for (const std::int64_t before = last; last <= before && Clock::now() - begin < Seconds(10);)
        if (session.wait(frames, Seconds(0.1))) (void)frames.take(note);
    return Seconds(Clock::now() - begin).count();
}

/// Kinds of events received; each says how severe it is.
std::vector<std::string> kinds(wire::DataReader<plab_v2_Events>& events)
{
    std::vector<std::string> out;
    (void)events.take(
        [&](const plab_v2_Events& batch, const dds_sample_info_t& info)
        {
            for (std::uint32_t i = 0; info.valid_data && i < batch.entries._length; ++i)
            {
                const plab_v2_EventInfo& event = batch.entries._buffer[i];
                out.emplace_back(event.kind);
                const std::string severity = event.severity;
                CHECK_MESSAGE((severity == "info" || severity == "warning" || severity == "failure"), event.kind, " is '", severity, "'");
            }
        });
    return out;
}

/// Counts events of one kind, and those missing between the received ones: a new plab-bus may write before a reader has discovered
/// it. Numbers are without gaps, so every loss is noticed.
class EventCount
{
public:
    explicit EventCount(std::string kind) : kind_(std::move(kind)) {}
    void take(wire::DataReader<plab_v2_Events>& events)
    {
        (void)events.take(
            [&](const plab_v2_Events& batch, const dds_sample_info_t& info)
            {
                if (!info.valid_data) return;
                if (next_ != 0 && batch.sequence_number > next_) missing_ += static_cast<std::int64_t>(batch.sequence_number - next_);
                next_ = batch.sequence_number + batch.entries._length;
                for (std::uint32_t i = 0; i < batch.entries._length; ++i) seen_ += batch.entries._buffer[i].kind == kind_ ? 1 : 0;
            });
    }
    std::int64_t seen() const { return seen_; }
    std::int64_t missing() const { return missing_; }

private:
    std::string kind_;
    std::uint64_t next_ = 0;
    std::int64_t seen_ = 0, missing_ = 0;
};

std::string names_in(const link::CatalogueContents& snapshot)
{
    std::string out;
    for (const auto& [id, o] : snapshot.objects) out += id + " ";
    for (const auto& [id, s] : snapshot.shapes) out += id + " ";
    for (const auto& [id, i] : snapshot.interactions) out += id + "=" + i.type_name + " ";
    return out + std::to_string(snapshot.types.size());
}

/// The lease after which readers drop the instances of a dead participant, shortened. On loopback, like everything here.
std::vector<std::string> with_lease(int seconds)
{
    const char* uri = std::getenv("CYCLONEDDS_URI");
    const std::string own = uri != nullptr && *uri != 0 ? uri : wire::configuration_of({});
    return {"CYCLONEDDS_URI=" + own + ",<CycloneDDS><Domain><Discovery><LeaseDuration>" + std::to_string(seconds) +
            "s</LeaseDuration></Discovery></Domain></CycloneDDS>"};
}

}  // namespace

TEST_CASE("plabd maps no DDS library with the bus on: plab-bus does")
{
    Server server(kScene, {"--paused"});
    const int bus = bus_of(server.process().pid());
    REQUIRE(bus != 0);
    CHECK_FALSE(maps(server.process().pid(), "libddsc"));
    CHECK(maps(server.process().pid(), "bus.so"));
    CHECK(maps(bus, "libddsc"));
    CHECK_FALSE(maps(bus, "/bin/plabd"));
    CHECK(server.end() == 0);
    CHECK_FALSE(runs(bus));
}

TEST_CASE("plab-bus is killed: the run continues bit for bit, and a request in progress takes effect once")
{
    const std::int64_t at = 400;
    const Outcome alone =
        run({program("plabd"), kScene, "--no-bus", "--hashes", "--until", "3", "--swap", std::to_string(at) + ":gears=" + kSwapped});
    REQUIRE(alone.code == 0);
    const auto expected = hashes_in(alone.output);
    REQUIRE(expected.size() > 500);

    Server server(kScene, {"--hashes", "--until", "3", "--rate", "real"});
    const link::Session session = server.session();
    auto frames = session.reader<plab_v2_Frame>();
    auto events = session.reader<plab_v2_Events>();
    REQUIRE((frames.ok() && events.ok()));
    auto caller = link::Caller::make(session, Seconds(5));
    REQUIRE(caller.ok());
    CHECK(seconds_to_frame(session, *frames) < 5);
    const int bus = bus_of(server.process().pid());
    REQUIRE(bus != 0);
    REQUIRE(kill(bus, SIGKILL) == 0);
    const auto killed = Clock::now();
    // It is sent while there is no plab-bus, and again until there is a reply.
    const link::Reply reply = ask(*caller, link::Request{{{"swap", "gears", kSwapped}}, at, {}});
    CHECK_MESSAGE(reply.done(), reasons(reply));
    CHECK(reply.step == at);
    // When the run is at that step, and not later: the connection in both directions exists long before.
    CHECK(Seconds(Clock::now() - killed).count() < static_cast<double>(at) / kStepsPerSecond);
    CHECK(another_bus(server, bus) != 0);
    std::vector<std::string> seen = kinds(*events);
    CHECK(server.process().wait(Milliseconds(10000)) == 0);
    for (const std::string& kind : kinds(*events)) seen.push_back(kind);
    CHECK(std::count(seen.begin(), seen.end(), "bus.restarted") == 1);
    CHECK(std::count(seen.begin(), seen.end(), "request.swap") == 1);
    CHECK(has(server.process().errors(), "was ended by signal 9"));
    CHECK(hashes_in(server.process().output()) == expected);
}

TEST_CASE("however plab-bus ends, the loop loses no time, and within a second frames and replies arrive again")
{
    Server server(kScene, {"--rate", "real"});
    const link::Session session = server.session();
    auto frames = session.reader<plab_v2_Frame>();
    auto events = session.reader<plab_v2_Events>();
    auto caller = link::Caller::make(session, Seconds(5));
    REQUIRE((frames.ok() && events.ok() && caller.ok()));
    const auto slipped = [&]
    {
        const auto servers = session.servers(Seconds(2), 1);
        REQUIRE(servers.size() == 1);
        return servers[0].slipped;
    };
    const double before = slipped();
    const auto began = Clock::now();
    const double time_began = ask(*caller, {"rate", "", "real"}).time;
    for (const int signal : {SIGKILL, SIGSEGV, SIGSTOP})
    {
        (void)seconds_to_frame(session, *frames);
        const int bus = bus_of(server.process().pid());
        REQUIRE(kill(bus, signal) == 0);
        std::this_thread::sleep_for(Milliseconds(20));  // what was under way has arrived
        const double gap = 0.02 + seconds_to_frame(session, *frames);
        const auto asked = Clock::now();
        CHECK(ask(*caller, {"rate", "", "real"}).done());
        const double reply = Seconds(Clock::now() - asked).count();
        MESSAGE("signal " << signal << ": frames again after " << gap << " s, and then a reply within " << 1e3 * reply << " ms");
        CHECK(gap + reply < 1);
        CHECK(bus_of(server.process().pid()) != bus);
        CHECK_FALSE(runs(bus));
    }
    const double ran = ask(*caller, {"rate", "", "real"}).time - time_began;
    CHECK(ran == doctest::Approx(Seconds(Clock::now() - began).count()).epsilon(0.02));
    CHECK(slipped() - before < 0.02);
    EventCount restarts("bus.restarted");
    const auto all_reported = [&]
    {
        restarts.take(*events);
        return restarts.seen() >= 3;
    };
    for (int i = 0; i < 100 && !all_reported(); ++i) std::this_thread::sleep_for(Milliseconds(20));
    CHECK(restarts.seen() >= 1);
    CHECK(restarts.seen() <= 3);
    CHECK(restarts.seen() + restarts.missing() >= 3);
    for (const char* how : {"signal 9 (Killed)", "signal 11 (Segmentation fault)", "was stopped"})
        CHECK_MESSAGE(has(server.process().errors(), how), server.process().errors());
    CHECK(server.end() == 0);
}

TEST_CASE("after a kill: the catalogue for new and for existing readers, and replies")
{
    Server server(kScene, {"--rate", "real"}, with_lease(2));
    const link::Session session = server.session();
    link::Catalogue early = catalogue(session);
    auto frames = session.reader<plab_v2_Frame>();
    REQUIRE(frames.ok());
    auto caller = link::Caller::make(session, Seconds(5));
    REQUIRE(caller.ok());
    REQUIRE(ask(*caller, {"swap", "gears", kSwapped}).done());
    REQUIRE(shows(early, [](const link::CatalogueContents& s) { return s.interactions.at("gears").type_name == kSwapped; }));
    const std::string before = names_in(early.now());
    (void)seconds_to_frame(session, *frames);

    const int bus = bus_of(server.process().pid());
    REQUIRE(kill(bus, SIGKILL) == 0);
    std::this_thread::sleep_for(Milliseconds(20));  // what was under way has arrived
    CHECK(seconds_to_frame(session, *frames) < 1);
    CHECK(ask(*caller, {"push", "fan", "0 0 0"}).outcome != "");
    const link::Session late = server.session();
    CHECK(names_in(catalogue(late).now()) == before);
    // The lease of the killed process ends: this does not affect what its successor published.
    std::this_thread::sleep_for(Milliseconds(3500));
    (void)early.update();
    CHECK(early.now().server.has_value());
    CHECK(names_in(early.now()) == before);
    CHECK(names_in(catalogue(late).now()) == before);
    CHECK(server.end() == 0);
}

TEST_CASE("a paused server publishes its last frame again after a kill")
{
    Server server(kScene, {"--paused"});
    const link::Session session = server.session();
    auto frames = session.reader<plab_v2_Frame>();
    REQUIRE(frames.ok());
    const auto comes = [&]
    {
        std::size_t bodies = 0;
        const auto note = [&](const plab_v2_Frame& f, const dds_sample_info_t& info) { bodies += info.valid_data ? f.bodies._length : 0; };
        for (int i = 0; i < 10 && bodies == 0; ++i)
            if (session.wait(*frames, Seconds(0.1))) (void)frames->take(note);
        return bodies > 0;
    };
    CHECK(comes());
    CHECK_FALSE(comes());  // nothing moves
    REQUIRE(kill(bus_of(server.process().pid()), SIGKILL) == 0);
    CHECK(comes());
    CHECK(server.end() == 0);
}

TEST_CASE("a plab-bus that dies repeatedly is restarted each time, with increasing delay, and plabd nevertheless ends")
{
    Server server(kScene, {"--rate", "real"});
    const auto begin = Clock::now();
    int bus = bus_of(server.process().pid());
    for (int i = 0; i < 4; ++i)
    {
        REQUIRE(bus != 0);
        REQUIRE(kill(bus, SIGKILL) == 0);
        bus = another_bus(server, bus);
    }
    CHECK(bus != 0);
    const double took = Seconds(Clock::now() - begin).count();
    CHECK(took > 0.05 + 0.1 + 0.2 + 0.4 - 0.05);
    CHECK(took < 5);
    CHECK(server.session().servers(Seconds(2), 1).size() == 1);
    CHECK(server.end() == 0);
}

TEST_CASE("a plab-bus that does not respond is ended and replaced, and plabd ends although plab-bus is stopped")
{
    // The second one to be started is not a plab-bus: it neither joins nor ends.
    const std::string script = scratch_file("silent_bus.sh"), mark = scratch_file("silent_bus.mark");
    (void)std::filesystem::remove(mark);
    std::ofstream(script) << "#!/bin/sh\nn=$(cat " << quoted(mark) << " 2>/dev/null)\necho x$n > " << quoted(mark)
                          << "\n[ \"$n\" = x ] && exec sleep 60\nexec " << quoted(program("plab-bus")) << "\n";
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    Server server(kScene, {"--rate", "real"}, {"PLAB_BUS_PROGRAM=" + script});
    const int bus = bus_of(server.process().pid());
    REQUIRE(bus != 0);
    REQUIRE(kill(bus, SIGKILL) == 0);
    REQUIRE(server.process().wait_for("sent nothing for 4 s", Milliseconds(10000)));
    const int next = another_bus(server, bus);
    REQUIRE(next != 0);
    CHECK(server.session().servers(Seconds(2), 1).size() == 1);
    REQUIRE(kill(next, SIGSTOP) == 0);
    const auto begin = Clock::now();
    CHECK(server.end() == 0);
    CHECK(Seconds(Clock::now() - begin).count() < 1);
    CHECK_FALSE(runs(next));
}

TEST_CASE("plab-bus ends with plabd, however that ends, and can be started by nothing else")
{
    Server server(kScene, {"--paused"});
    const int bus = bus_of(server.process().pid());
    REQUIRE(bus != 0);
    server.process().signal(SIGKILL);
    CHECK(server.process().wait(Milliseconds(5000)) == 137);
    bool gone = false;
    for (int i = 0; i < 200 && !gone; ++i, std::this_thread::sleep_for(Milliseconds(5))) gone = !runs(bus);
    CHECK(gone);
    const Outcome alone = run({program("plab-bus")});
    CHECK(alone.code == 2);
    CHECK(has(alone.errors, "plab-bus is started by plabd"));
}

TEST_CASE("a signal to the whole process group ends plab-bus only after clients have been informed of the end")
{
    Server server(kScene, {"--paused"});
    const link::Session session = server.session();
    link::Catalogue seen = catalogue(session);
    const int bus = bus_of(server.process().pid());
    REQUIRE(kill(bus, SIGTERM) == 0);
    CHECK(server.end() == 0);
    const auto begin = Clock::now();
    while (!seen.server_is_gone() && Clock::now() - begin < Seconds(2)) (void)seen.wait(Seconds(0.1));
    CHECK(seen.server_is_gone());
}
