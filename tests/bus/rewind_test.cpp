// A request that waits for its step, and a run that is rewound to before it: real programs, with a recording of both runs.
#include "server.h"

#include <filesystem>

#include "idl/recording/cdr.h"
#include "idl/recording/reader.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// Requests that the file says were carried out, but for those of the clock: "RUN STEP VERB ORIGIN", a line each.
std::string journal_of(const std::string& file)
{
    auto reader = recording::McapReader::open(file);
    REQUIRE_MESSAGE(reader.ok(), reader.error().text());
    std::string out;
    recording::Decoder decoder;
    recording::Sample<plab_v2_Journal> entry;
    recording::Cursor cursor = reader->messages({{wire::topic_of<plab_v2_Journal>().name}});
    for (auto next = cursor.next(); next && *next; next = cursor.next())
    {
        REQUIRE(decoder.decode((*next)->message.data, entry));
        REQUIRE(entry->operations._length == 1);
        const std::string verb = entry->operations._buffer[0].verb;
        if (verb == "step") continue;
        out += std::to_string(entry->run) + " " + std::to_string(entry->step) + " " + verb + " " + entry->origin + "\n";
    }
    return out;
}

/// A server with the scene's own 240 steps per second, which keeps a snapshot each second and is paused except when it is
/// stepped.
class Stepped
{
public:
    explicit Stepped(const std::string& file)
        : server_(scene_file("fan_and_balloons.xml"), {"--paused", "--rate", "max", "--history", "1", "--record", file})
    {
    }
    void step_to(std::int64_t step)
    {
        REQUIRE(control(server_, {"step", std::to_string(step - at_)}).code == 0);
        // The reply to a step request confirms the request; this waits until the step has been made.
        const Outcome there = control(server_, {"wait", "--step", std::to_string(step)});
        REQUIRE_MESSAGE(there.code == 0, there.errors);
        at_ = step;
    }
    void rewind_to(std::int64_t step)
    {
        const Outcome done = control(server_, {"rewind", "--to", std::to_string(static_cast<double>(step) / 240)});
        REQUIRE_MESSAGE(done.code == 0, done.errors);
        at_ = step;
    }
    Server& server() { return server_; }

private:
    Server server_;
    std::int64_t at_ = 0;
};

/// plabctl, which waits for the reply to a request for step 300; the server has the request: it was sent several times, and the
/// server is matched with its writer after the first if not before.
Process ask_for(const Server& server, const std::vector<std::string>& words)
{
    const link::Session session = server.session();
    auto requests = session.reader<plab_v2_Request>();
    REQUIRE(requests.ok());
    std::vector<std::string> command{program("plabctl"), "--server", server.name(), "--timeout", "30"};
    command.insert(command.end(), words.begin(), words.end());
    Process asks(command);
    int asked = 0;
    for (int i = 0; i < 100 && asked < 4; ++i)
    {
        (void)session.wait(*requests, Seconds(0.05));
        (void)requests->take([&](const plab_v2_Request& r, const dds_sample_info_t& info)
                             { asked += info.valid_data && r.at == 300 ? 1 : 0; });
    }
    REQUIRE_MESSAGE(asked >= 4, asks.errors());
    return asks;
}

}  // namespace

TEST_CASE("a waiting request waits again in a run that was rewound to before it, and both runs are reproduced")
{
    const std::string file = scratch_file("rewound.mcap");
    std::filesystem::remove(file);
    {
        Stepped run(file);
        const link::Session session = run.server().session();
        link::Catalogue known = catalogue(session);
        const auto mass_is = [&](double mass)
        { return shows(known, [&](const link::CatalogueContents& now) { return now.objects.at("red").mass == doctest::Approx(mass); }); };
        run.step_to(120);
        Process asks = ask_for(run.server(), {"set", "red.mass=0.03", "--at", "300"});
        run.step_to(240);  // the snapshot of that second contains the waiting request
        CHECK(asks.running());
        CHECK(mass_is(0.02));
        run.step_to(360);
        CHECK_MESSAGE(asks.wait(Milliseconds(5000)) == 0, asks.errors());
        CHECK(mass_is(0.03));

        run.rewind_to(264);
        CHECK(mass_is(0.02));
        run.step_to(299);
        CHECK(mass_is(0.02));
        run.step_to(360);
        CHECK(mass_is(0.03));
        // Before the request was made nothing waits: that future is dropped.
        run.rewind_to(72);
        run.step_to(360);
        CHECK(mass_is(0.02));
        CHECK(run.server().end() == 0);
    }
    CHECK(journal_of(file) == "1 300 set client\n2 264 rewind client\n2 300 set client\n3 72 rewind client\n");
    const Outcome again = run({program("plabd"), "--replay", file, "--verify"});
    CHECK_MESSAGE(again.code == 0, again.output, again.errors);
    // 360 steps, then from 264 to 360, then from 72 to 360.
    CHECK_MESSAGE(has(again.output, "verified: 744 state hashes are identical"), again.output);
    CHECK_MESSAGE(has(again.output, "3 runs"), again.output);
    std::filesystem::remove(file);
}

TEST_CASE("a client's request that cannot be carried out a second time concerns only that run, and is not a failure of the server")
{
    const std::string file = scratch_file("rewound_refused.mcap");
    std::filesystem::remove(file);
    {
        Stepped run(file);
        run.step_to(120);
        Process asks = ask_for(run.server(), {"remove", "wind", "--at", "300"});
        run.step_to(301);
        CHECK_MESSAGE(asks.wait(Milliseconds(5000)) == 0, asks.errors());
        run.rewind_to(250);
        CHECK(control(run.server(), {"remove", "wind"}).code == 0);
        run.step_to(310);
        CHECK(run.server().end() == 0);
    }
    CHECK(journal_of(file) == "1 300 remove client\n2 250 rewind client\n2 250 remove client\n");
    const Outcome again = run({program("plabd"), "--replay", file, "--verify"});
    CHECK_MESSAGE(again.code == 0, again.output, again.errors);
    CHECK_MESSAGE(has(again.output, "verified: 361 state hashes are identical"), again.output);
    std::filesystem::remove(file);
}
