// Requests and replies over DDS.
#include <map>

#include "support.h"

using namespace plab;
using namespace plab::test;

namespace
{

link::Caller caller_of(const link::Session& session)
{
    auto caller = link::Caller::make(session, 5s);
    REQUIRE(caller.ok());
    return caller.take();
}

link::Request a_pause() { return {{{"pause"}}, std::nullopt, std::nullopt}; }

/// Waits for the next request.
publish::ReceivedRequest next(TestBus& bus)
{
    publish::ReceivedRequest request;
    REQUIRE(eventually([&] { return bus->take(request); }));
    return request;
}

void answer(TestBus& bus, const publish::ReceivedRequest& request, Tick step)
{
    wire::Reply a;
    a.client = request.client, a.number = request.number, a.outcome = "done", a.step = step, a.revision = 4;
    wire::SwapReport swap{"gear", "G/A", "G/B", {{"x", "kept"}, {"y", "lost"}}, 0, {}, {}};
    swap.with_new.momentum = {1, 2, 3};
    a.swaps = {swap};
    bus->answer(std::move(a));
}

/// Waits for one reply.
std::pair<std::uint64_t, link::Reply> reply(link::Caller& caller, std::chrono::milliseconds longest = 5s)
{
    std::pair<std::uint64_t, link::Reply> out{0, {}};
    (void)eventually(
        [&]
        {
            caller.take([&](std::uint64_t number, link::Reply r) { out = {number, std::move(r)}; });
            return out.first != 0;
        },
        longest);
    return out;
}

/// Writes requests that no client of pLab would send, and reads the replies to all clients.
class Rogue
{
public:
    explicit Rogue(const link::Session& session) : replies_(reader_of<plab_v2_Reply>(session))
    {
        auto writer = session.writer<plab_v2_Request>();
        REQUIRE(writer.ok());
        writer_ = writer.take();
        REQUIRE(eventually([&] { return writer_.readers() > 0 && replies_.writers() > 0; }));
    }
    /// The reason of the refusal that came; empty if none did.
    std::string refused(const plab_v2_Request& request)
    {
        REQUIRE(writer_.write(request) == DDS_RETCODE_OK);
        std::string why;
        (void)eventually(
            [&]
            {
                (void)replies_.take(
                    [&](const plab_v2_Reply& r, const dds_sample_info_t& info)
                    {
                        if (info.valid_data && std::string(r.outcome) == "refused") why = r.reasons._buffer[0];
                    });
                return !why.empty();
            },
            3s);
        return why;
    }

private:
    wire::DataReader<plab_v2_Reply> replies_;
    wire::DataWriter<plab_v2_Request> writer_;
};

}  // namespace

TEST_CASE("a request arrives as it was sent, and so does its reply")
{
    TestBus bus;
    const link::Session session = bus.session();
    link::Caller caller = caller_of(session);
    link::Request request{{{"set", "ball", "", "", {{"mass", "2 kg"}, {"x", "1"}}}, {"add", "", "", "<plab/>"}}, 90, 7};
    const int before = bus.wakes();
    REQUIRE(caller.send(request).ok());
    const publish::ReceivedRequest got = next(bus);
    CHECK(eventually([&] { return bus.wakes() > before; }));  // it is handed over first
    CHECK(got.number == 1);
    CHECK(got.at == 90);
    CHECK(got.revision == 7);
    CHECK(got.arrived_ns > 0);
    REQUIRE(got.operations.size() == 2);
    CHECK(got.operations[0].verb == "set");
    CHECK(got.operations[0].target == "ball");
    CHECK(got.operations[0].values == std::vector<wire::NamedText>{{"mass", "2 kg"}, {"x", "1"}});
    CHECK(got.operations[1].blueprint == "<plab/>");
    answer(bus, got, 90);
    const auto [number, r] = reply(caller);
    CHECK(number == 1);
    CHECK(r.done());
    CHECK_FALSE(r.repeated);
    CHECK(r.step == 90);
    CHECK(r.revision == 4);
    REQUIRE(r.swaps.size() == 1);
    CHECK(r.swaps[0].to_type == "G/B");
    REQUIRE(r.swaps[0].fields.size() == 2);
    CHECK(r.swaps[0].fields[1].fate == "lost");
    CHECK(r.swaps[0].with_new.momentum[2] == 3);
}

TEST_CASE("a repeated request is handed out once; its answer is repeated")
{
    TestBus bus;
    const link::Session session = bus.session();
    link::Caller caller = caller_of(session);
    const auto number = caller.send(a_pause());
    REQUIRE(number.ok());
    for (int i = 0; i < 3; ++i) REQUIRE(caller.send_again(a_pause(), *number).ok());
    const publish::ReceivedRequest got = next(bus);
    publish::ReceivedRequest other;
    std::this_thread::sleep_for(100ms);
    CHECK_FALSE(bus->take(other));
    answer(bus, got, 5);
    CHECK_FALSE(reply(caller).second.repeated);
    CHECK(reply(caller, 100ms).first == 0);  // one answer, however often it was sent while it waited
    REQUIRE(caller.send_again(a_pause(), *number).ok());
    const auto again = reply(caller);
    CHECK(again.first == *number);
    CHECK(again.second.repeated);
    CHECK(again.second.done());
    CHECK(again.second.step == 5);
    CHECK_FALSE(bus->take(other));
}

TEST_CASE("call() repeats the request until there is an answer, and it is carried out once")
{
    TestBus bus;
    const link::Session session = bus.session();
    link::Caller caller = caller_of(session);
    std::atomic<int> carried_out{0};
    std::atomic<bool> stop{false};
    std::thread loop(
        [&]
        {
            publish::ReceivedRequest request;
            const auto slow = std::chrono::steady_clock::now() + 2500ms;
            while (!stop)
            {
                std::this_thread::sleep_for(1ms);
                if (std::chrono::steady_clock::now() < slow || !bus->take(request)) continue;
                ++carried_out;
                answer(bus, request, 1);
            }
        });
    const auto r = caller.call(a_pause(), 8s);
    const auto second = caller.call(a_pause(), 8s);
    stop = true;
    loop.join();
    REQUIRE(r.ok());
    CHECK(r->done());
    REQUIRE(second.ok());
    CHECK(second->done());
    CHECK(carried_out == 2);
}

TEST_CASE("clients do not see each other's replies")
{
    TestBus bus;
    const link::Session session = bus.session(), elsewhere = bus.session();
    link::Caller a = caller_of(session), b = caller_of(elsewhere);
    REQUIRE(a.send(a_pause()).ok());
    const publish::ReceivedRequest of_a = next(bus);
    REQUIRE(b.send(a_pause()).ok());
    REQUIRE(b.send(a_pause()).ok());
    const publish::ReceivedRequest first = next(bus), second = next(bus);
    answer(bus, second, 22), answer(bus, of_a, 10), answer(bus, first, 21);
    std::map<std::uint64_t, Tick> to_a, to_b;
    CHECK(eventually(
        [&]
        {
            a.take([&](std::uint64_t n, const link::Reply& r) { to_a[n] = r.step; });
            b.take([&](std::uint64_t n, const link::Reply& r) { to_b[n] = r.step; });
            return to_a.size() + to_b.size() == 3;
        }));
    CHECK(to_a == std::map<std::uint64_t, Tick>{{1, 10}});
    CHECK(to_b == std::map<std::uint64_t, Tick>{{1, 21}, {2, 22}});
}

TEST_CASE("malformed requests are refused with a reason and never reach the step loop")
{
    TestBus bus;
    const link::Session session = bus.session();
    Rogue rogue(session);
    const std::string big(wire::kMostRequestBytes + 10, 'x'), latin = "b\xe4ll";
    plab_v2_Operation operation{wire::text("pause"), nullptr, nullptr, nullptr, {}};
    plab_v2_Request request{{9}, 1, -1, -1, {1, 1, &operation, false}};
    const auto with = [&](auto&& change)
    {
        plab_v2_Request changed = request;
        change(changed);
        ++request.number;
        return rogue.refused(changed);
    };
    CHECK(with([](auto& r) { r.client[0] = 0; }).find("no client id") != std::string::npos);
    CHECK(with([](auto& r) { r.number = 0; }).find("number 0") != std::string::npos);
    CHECK(with([](auto& r) { r.at = -3; }).find("step -3") != std::string::npos);
    CHECK(with([](auto& r) { r.operations._length = 0; }).find("no operation") != std::string::npos);
    CHECK(with([](auto& r) { r.number = 2; }).find("numbers must increase") != std::string::npos);
    operation.target = wire::text(latin);
    CHECK(rogue.refused(request).find("not UTF-8") != std::string::npos);
    operation.target = wire::text(big), ++request.number;
    CHECK(rogue.refused(request).find("more than 4194304 bytes") != std::string::npos);
    publish::ReceivedRequest none;
    CHECK_FALSE(bus->take(none));
    // A well-behaved client is still served.
    link::Caller caller = caller_of(session);
    REQUIRE(caller.send(a_pause()).ok());
    CHECK(next(bus).operations[0].verb == "pause");
}

TEST_CASE("requests beyond the number that may wait are refused; none that was accepted is lost")
{
    TestBus bus;
    const link::Session session = bus.session();
    link::Caller caller = caller_of(session);
    constexpr std::size_t kMost = wire::kMostRequestsWaitingPerClient, kSent = kMost + 200;
    std::map<std::uint64_t, std::string> outcomes;
    const auto listen = [&] { caller.take([&](std::uint64_t n, const link::Reply& r) { outcomes[n] = r.outcome; }); };
    for (std::size_t i = 0; i < kSent; ++i)
    {
        REQUIRE(caller.send(a_pause()).ok());
        if (i % 16 == 0) listen();
    }
    CHECK(eventually(
        [&]
        {
            listen();
            return outcomes.size() == kSent - kMost;
        }));
    for (const auto& [n, outcome] : outcomes) CHECK(outcome == "refused");
    std::uint64_t expected = 0;
    publish::ReceivedRequest request;
    while (bus->take(request))
    {
        CHECK(request.number == ++expected);
        answer(bus, request, 1);
        if (expected % 16 == 0) std::this_thread::sleep_for(1ms), listen();
    }
    CHECK(expected == kMost);
    CHECK(eventually(
        [&]
        {
            listen();
            return outcomes.size() == kSent;
        }));
}

TEST_CASE("clients whose requests never become due do not lock out the others")
{
    TestBus bus;
    const link::Session session = bus.session();
    constexpr std::size_t kEach = wire::kMostRequestsWaitingPerClient;
    constexpr std::size_t kFar = wire::kMostRequestsWaiting - wire::kRequestsKeptForNextStep;
    const link::Request far{{{"pause"}}, std::int64_t{1} << 60, std::nullopt};
    std::vector<link::Caller> greedy;
    std::size_t taken = 0;
    publish::ReceivedRequest request;
    const auto fill = [&](const link::Request& what, std::size_t count)
    {
        for (std::size_t i = 0; i < count; ++i)
        {
            if (i % kEach == 0) greedy.push_back(caller_of(session));
            REQUIRE(greedy.back().send(what).ok());
        }
        const std::size_t all = taken + count;
        CHECK(eventually(
            [&]
            {
                while (bus->take(request)) ++taken;  // like the loop, which keeps them until they are due
                return taken == all;
            }));
    };
    fill(far, kFar);
    link::Caller caller = caller_of(session);
    REQUIRE(caller.send(far).ok());
    CHECK(reply(caller).second.reasons.at(0).find("896 requests that name a step, the maximum of these,") == 0);
    REQUIRE(caller.send(a_pause()).ok());
    answer(bus, next(bus), 1);
    CHECK(reply(caller).second.done());
    fill(a_pause(), wire::kRequestsKeptForNextStep);
    REQUIRE(caller.send(a_pause()).ok());
    CHECK(reply(caller).second.reasons.at(0).find("1024 requests, the maximum for all clients together,") == 0);
    for (link::Caller* asking : {&caller, &greedy.front()})
    {
        REQUIRE(asking->send({{{"shutdown"}}, std::nullopt, std::nullopt}).ok());
        const publish::ReceivedRequest got = next(bus);
        CHECK(got.operations[0].verb == "shutdown");
        answer(bus, got, 2);
        CHECK(reply(*asking).second.done());
    }
}

TEST_CASE("large requests that never become due do not lock out the others")
{
    TestBus bus;
    const link::Session session = bus.session();
    link::Caller greedy = caller_of(session), caller = caller_of(session);
    const link::Request large{{{"add", "", "", std::string(wire::kMostRequestBytes - 1000, 'x')}}, 1 << 30, std::nullopt};
    constexpr std::size_t kFit = (wire::kMostWaitingBytes - wire::kBytesKeptForNextStep) / wire::kMostRequestBytes;
    publish::ReceivedRequest request;
    for (std::size_t i = 0; i < kFit; ++i)
    {
        REQUIRE(greedy.send(large).ok());
        request = next(bus);
    }
    REQUIRE(greedy.send(large).ok());
    CHECK(reply(greedy).second.reasons.at(0).find("bytes of requests that name a step are already waiting") != std::string::npos);
    REQUIRE(caller.send(a_pause()).ok());
    CHECK(next(bus).operations[0].verb == "pause");
}

TEST_CASE("a client that has received the reply finds the effect of the request in the catalogue")
{
    TestBus bus;
    const link::Session session = bus.session();
    link::Caller caller = caller_of(session);
    auto objects = reader_of<plab_v2_SceneObject>(session);
    const auto events = reader_of<plab_v2_Events>(session);
    REQUIRE(eventually([&] { return bus->wants(publish::Stream::Events); }));
    for (int i = 0; i < 20; ++i)
    {
        REQUIRE(caller.send(a_pause()).ok());
        const publish::ReceivedRequest request = next(bus);
        wire::Events work;  // keeps the bus thread busy, so that it finds the next two together
        work.entries.resize(20000);
        bus->events(std::move(work));
        publish::CatalogueChange change;
        for (int k = 0; k < 200; ++k) change.objects.emplace_back().component_id = "o" + std::to_string(i) + "-" + std::to_string(k);
        REQUIRE(bus->catalogue(std::move(change)));
        answer(bus, request, i);
        // Without a pause: the reply must not come even a moment earlier.
        bool answered = false;
        const auto end = std::chrono::steady_clock::now() + 5s;
        while (!answered && std::chrono::steady_clock::now() < end)
            caller.take([&](std::uint64_t, const link::Reply&) { answered = true; });
        REQUIRE(answered);
        const std::string last = "o" + std::to_string(i) + "-199";
        bool found = false;
        (void)objects.take([&](const plab_v2_SceneObject& o, const dds_sample_info_t&) { found = found || o.component_id == last; });
        REQUIRE(found);
    }
}
