// Going back: snapshots by name, and rewinding a run, with the requests made in between.
#include "simulation/snapshot/history.h"

#include "support/ball.h"
#include "support/scene.h"

namespace plab::test
{
namespace
{

simulation::HistoryOptions every(double interval, std::size_t bytes = 64u << 20)
{
    simulation::HistoryOptions options;
    options.interval = interval, options.most_bytes = bytes;
    return options;
}

/// A scene whose run keeps its history from the beginning on.
struct Kept
{
    explicit Kept(const simulation::HistoryOptions& options) : scene(kBall, "dt=\"1/100\"")
    {
        REQUIRE_MESSAGE(scene.loaded(), scene.error());
        scene.simulation().history().configure(options);
        REQUIRE(scene.ask(simulation::ResetOperation{}).done);
    }
    simulation::Simulation& s() { return scene.simulation(); }
    Scene scene;
};

std::string refusal(const simulation::Reply& reply)
{
    CHECK(!reply.done);
    return reply.errors.empty() ? "" : reply.errors.front().text();
}

/// Types of this build, except for one that can be removed, as if the file of its plugin were deleted.
class Fickle final : public model::TypeSource
{
public:
    Result<const model::ComponentType*> require(const std::string& name) override
    {
        if (name == taken_away) return reason("the file of '" + name + "' has gone");
        return library().require(name);
    }
    std::vector<std::string> names() const override { return library().names(); }

    std::string taken_away;
};

simulation::Request mass_at(std::uint64_t id, Tick step, const std::string& mass)
{
    simulation::Request request;
    request.id = id, request.at = step;
    request.operations.push_back(simulation::SetOperation{"ball", "mass", mass});
    return request;
}

/// 60 steps, with a type that is added before step 45, a request before step 42 and one that waits for step 90.
struct Sixty
{
    Sixty() : s(types)
    {
        s.history().configure(every(0.1));
        const auto scene = compile_text(whole_scene(kBall, "dt=\"1/100\""));
        REQUIRE(scene);
        REQUIRE(s.load(*scene));
        s.post(mass_at(7, 90, "3")), s.post(mass_at(8, 42, "2"));
        step(45);
        simulation::Request add;
        add.operations.push_back(simulation::AddBlueprintOperation{
            blueprint::read_blueprint("<component id=\"crate\" type=\"Shape/Box\" half_extents=\"1 1 1\"/>", "add").take()});
        const simulation::Reply added = s.carry_out_now(add);
        REQUIRE_MESSAGE(added.done, first_error(added.errors));
        step(15);
    }
    void step(int n)
    {
        for (; n > 0; --n) REQUIRE(s.step());
    }
    simulation::Reply rewind(double time)
    {
        simulation::Request request;
        request.operations.push_back(simulation::RewindOperation{time, false});
        return s.carry_out_now(request);
    }

    Fickle types;
    simulation::Simulation s;
};

}  // namespace

TEST_CASE("a rewound run has the earlier state, to the last bit, and continues as before")
{
    Kept kept(every(0.1));
    std::vector<std::uint64_t> hashes{kept.scene.hash()};
    for (int i = 0; i < 100; ++i)
    {
        if (i == 37) CHECK(kept.scene.ask(simulation::SetOperation{"ball", "mass", std::string("2")}).done);
        if (i == 61) CHECK(kept.scene.ask(simulation::PushOperation{"ball", {0.2, 0, 0}, {}}).done);
        kept.scene.step();
        hashes.push_back(kept.scene.hash());
    }
    const std::uint64_t run = kept.s().run();
    // Before both requests, between them, on a snapshot of its own, after both.
    for (const int step : {93, 70, 62, 60, 50, 38, 36, 20, 3, 0})
    {
        REQUIRE(kept.scene.ask(simulation::RewindOperation{step / 100.0, false}).done);
        CHECK(kept.s().tick() == step);
        CHECK(kept.scene.hash() == hashes[static_cast<std::size_t>(step)]);
    }
    CHECK(kept.s().run() > run);
    // Everything later is forgotten: without the requests the run differs from step 37 on, and is the same until then.
    for (int i = 1; i <= 37; ++i)
    {
        kept.scene.step();
        CHECK(kept.scene.hash() == hashes[static_cast<std::size_t>(i)]);
    }
    kept.scene.step(30);
    CHECK(kept.scene.hash() != hashes[67]);
}

TEST_CASE("recorded requests take bounded memory: after many requests the beginning is dropped, and the rest is reproduced")
{
    simulation::HistoryOptions options = every(0.1);
    options.most_asked_bytes = 20000;
    Kept kept(options);
    std::vector<std::uint64_t> hashes{kept.scene.hash()};
    std::size_t most = 0;
    for (int i = 0; i < 400; ++i)
    {
        CHECK(kept.scene.ask(simulation::PushOperation{"ball", {1e-3 * (i % 3), 0, 0}, {}}).done);
        kept.scene.step();
        hashes.push_back(kept.scene.hash());
        most = std::max(most, kept.s().history().asked_bytes());
    }
    CHECK(most > 10000);
    CHECK(most < 2 * options.most_asked_bytes);
    const double earliest = kept.s().history().earliest();
    CHECK(earliest > 1);
    CHECK(earliest < 3.9);
    CHECK(refusal(kept.scene.ask(simulation::RewindOperation{earliest - 0.02, false})).find("of this run, t =") != std::string::npos);
    for (const double time : {3.95, earliest})
    {
        REQUIRE(kept.scene.ask(simulation::RewindOperation{time, false}).done);
        CHECK(kept.scene.hash() == hashes[static_cast<std::size_t>(kept.s().tick())]);
    }
}

TEST_CASE("after rewinding to a step, other requests can be made at it")
{
    Kept kept(every(0.1));
    kept.scene.step(50);
    const std::uint64_t before = kept.scene.hash();
    REQUIRE(kept.scene.ask(simulation::SetOperation{"ball", "mass", std::string("3")}).done);
    kept.scene.step(25);
    REQUIRE(kept.scene.ask(simulation::RewindOperation{0.25, true}).done);
    CHECK(kept.s().tick() == 50);
    CHECK(kept.scene.hash() == before);
    CHECK(kept.scene.real("ball", "mass") == 1.0);
}

TEST_CASE("pause and rate keep their present values, and no request is answered twice")
{
    Kept kept(every(0.1));
    simulation::Request later;
    later.id = 7, later.at = 30;
    later.operations.push_back(simulation::SetOperation{"ball", "mass", std::string("2")});
    kept.s().post(later);
    kept.scene.step(60);
    CHECK(kept.s().take_replies().size() == 1);
    const std::uint64_t at_40 = [&]
    {
        Kept again(every(0.1));
        again.s().post(later);
        again.scene.step(40);
        return again.scene.hash();
    }();
    REQUIRE(kept.scene.ask_all({simulation::PauseOperation{}, simulation::RateOperation{3}}).done);
    REQUIRE(kept.scene.ask(simulation::RewindOperation{0.4, false}).done);
    CHECK(kept.s().paused());
    CHECK(kept.s().rate() == 3);
    CHECK(kept.scene.hash() == at_40);
    CHECK(kept.s().pending_requests() == 0);
    // Before the request took effect it waits again, as it did then.
    REQUIRE(kept.scene.ask(simulation::RewindOperation{0.2, false}).done);
    CHECK(kept.s().pending_requests() == 1);
}

TEST_CASE("times that cannot be reached are refused, and nothing changes")
{
    Kept kept(every(0.1));
    kept.scene.step(20);
    const std::uint64_t hash = kept.scene.hash(), run = kept.s().run();
    CHECK(refusal(kept.scene.ask(simulation::RewindOperation{0.3, false})).find("is in the future") != std::string::npos);
    CHECK(refusal(kept.scene.ask(simulation::RewindOperation{-0.1, false})).find("before the earliest kept state") != std::string::npos);
    CHECK(refusal(kept.scene.ask(simulation::RestoreOperation{"nobody"})).find("no snapshot has the name 'nobody'") != std::string::npos);
    CHECK(refusal(kept.scene.ask(simulation::ForgetOperation{"nobody"})).find("no snapshot has the name") != std::string::npos);
    CHECK(kept.scene.hash() == hash);
    CHECK(kept.s().run() == run);

    Scene plain(kBall);
    REQUIRE(plain.loaded());
    plain.step(5);
    CHECK(refusal(plain.ask(simulation::RewindOperation{0, false})).find("no history is kept") != std::string::npos);
}

TEST_CASE("a failed rewind leaves the present unchanged: the run number, the waiting requests and the future")
{
    Sixty plain, tried;
    REQUIRE(plain.s.take_replies().size() == 1);
    REQUIRE(tried.s.take_replies().size() == 1);
    const std::uint64_t run = tried.s.run(), revision = tried.s.revision();
    tried.types.taken_away = "Shape/Box";
    // Between the snapshot at 0.4 s and there, after the request of step 42; and at the snapshot of 0.5 s itself.
    CHECK(refusal(tried.rewind(0.48)).find("a request of step 45 cannot be carried out again") != std::string::npos);
    CHECK(refusal(tried.rewind(0.5)).find("the file of 'Shape/Box' has gone") != std::string::npos);
    CHECK(tried.s.run() == run);
    CHECK(tried.s.revision() == revision);
    CHECK(tried.s.tick() == 60);
    CHECK(tried.s.pending_requests() == 1);
    CHECK(tried.s.state_hash() == plain.s.state_hash());
    for (int i = 0; i < 40; ++i)
    {
        plain.step(1), tried.step(1);
        REQUIRE(tried.s.state_hash() == plain.s.state_hash());
    }
    const auto replies = tried.s.take_replies();
    REQUIRE(replies.size() == 1);
    CHECK(replies.front().request == 7);
    CHECK(replies.front().done);
    // Times that could be reached before can still be reached.
    tried.types.taken_away.clear();
    CHECK(tried.rewind(0.48).done);
    CHECK(tried.s.tick() == 48);
    CHECK(tried.s.run() == run + 1);
}

TEST_CASE("named snapshots outlive runs and swaps, and are released by name")
{
    Kept kept(every(0));
    kept.scene.step(30);
    const std::uint64_t hash = kept.scene.hash();
    REQUIRE(kept.scene.ask(simulation::SnapshotOperation{"s30"}).done);
    CHECK(kept.scene.hash() == hash);
    kept.scene.step(10);
    const std::uint64_t then = kept.scene.hash();
    REQUIRE(kept.scene.ask(simulation::RemoveOperation{"wind"}).done);
    kept.scene.step(10);
    REQUIRE(kept.scene.ask(simulation::ResetOperation{}).done);
    REQUIRE(kept.scene.ask(simulation::RestoreOperation{"s30"}).done);
    CHECK(kept.s().tick() == 30);
    CHECK(kept.scene.hash() == hash);
    kept.scene.step(10);
    CHECK(kept.scene.hash() == then);
    REQUIRE(kept.s().history().named().size() == 1);
    REQUIRE(kept.scene.ask(simulation::ForgetOperation{"s30"}).done);
    CHECK(kept.s().history().named().empty());
}

TEST_CASE("memory stays bounded, and the whole run can be reached")
{
    constexpr std::size_t kBytes = 200'000;
    Kept kept(every(0.01, kBytes));
    std::vector<std::uint64_t> hashes{kept.scene.hash()};
    for (int i = 0; i < 1500; ++i)
    {
        kept.scene.step();
        hashes.push_back(kept.scene.hash());
    }
    const std::size_t each = simulation::bytes_of(kept.s().capture());
    REQUIRE(each > 0);
    CHECK_MESSAGE(each * 1500 > 2 * kBytes, "the bound was never reached: ", each);
    CHECK(kept.s().history().earliest() == 0);
    CHECK(kept.s().history().bytes() <= kBytes);
    for (const int step : {1400, 777, 12})
    {
        REQUIRE(kept.scene.ask(simulation::RewindOperation{step / 100.0, false}).done);
        CHECK(kept.scene.hash() == hashes[static_cast<std::size_t>(step)]);
    }
}

}  // namespace plab::test
