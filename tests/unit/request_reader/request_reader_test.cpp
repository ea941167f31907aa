// The thread that reads requests: their order, that plugins are loaded when a request can be taken, and that it ends.
#include "daemon/request_reader.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "plugins/library.h"

using namespace plab;
using namespace std::chrono_literals;
using daemon::RequestReader;
using wire::Operation;

namespace
{

wire::Operation operation(std::string verb, std::string target = "", std::string argument = "", std::string blueprint = "")
{
    return {std::move(verb), std::move(target), std::move(argument), std::move(blueprint), {}};
}

/// Requests as the bus would give them, one after the other.
class FakeBus
{
public:
    void send(wire::Operation operation)
    {
        publish::ReceivedRequest text;
        text.operations = {std::move(operation)};
        const std::lock_guard lock(mutex_);
        text.number = ++last_;
        waiting_.push_back(std::move(text));
    }
    bool take(publish::ReceivedRequest& out)
    {
        std::this_thread::sleep_for(delay);
        const std::lock_guard lock(mutex_);
        if (waiting_.empty()) return false;
        out = std::move(waiting_.front());
        waiting_.pop_front();
        return true;
    }

    std::chrono::milliseconds delay = 0ms;

private:
    std::mutex mutex_;
    std::deque<publish::ReceivedRequest> waiting_;
    std::uint64_t last_ = 0;
};

/// Waits for the next request, 5 s at most.
bool await(RequestReader& reader, RequestReader::ReadRequest& out)
{
    for (int i = 0; i < 5000; ++i)
    {
        if (reader.take(out)) return true;
        std::this_thread::sleep_for(1ms);
    }
    return false;
}

bool has_loaded(const plugins::PluginLibrary& library, const std::string& type)
{
    return std::ranges::any_of(
        library.loaded(), [&](const plugins::PluginInfo& plugin) { return std::ranges::find(plugin.types, type) != plugin.types.end(); });
}

}  // namespace

TEST_CASE("requests are read in the order in which they arrived, and refused ones keep their reason")
{
    FakeBus bus;
    plugins::PluginLibrary library;
    std::atomic<int> ready = 0;
    RequestReader reader([&](publish::ReceivedRequest& text) { return bus.take(text); }, library, {}, [&] { ++ready; });
    RequestReader::ReadRequest next;
    CHECK_FALSE(reader.take(next));
    bus.send(operation("pause")), bus.send(operation("dance")), bus.send(operation("shutdown"));
    reader.notify();
    REQUIRE(await(reader, next));
    CHECK(next.text.number == 1);
    REQUIRE(next.wanted.ok());
    CHECK(next.wanted->request.operations.size() == 1);
    REQUIRE(await(reader, next));
    CHECK(next.text.number == 2);
    CHECK_FALSE(next.wanted.ok());
    REQUIRE(await(reader, next));
    CHECK(next.text.number == 3);
    REQUIRE(next.wanted.ok());
    CHECK(next.wanted->shutdown);
    reader.finish(1s);
    CHECK_FALSE(reader.take(next));
    CHECK(ready == 3);
}

TEST_CASE("when a request can be taken, the plugins of the types that it names are loaded")
{
    FakeBus bus;
    plugins::PluginLibrary library;
    RequestReader reader([&](publish::ReceivedRequest& text) { return bus.take(text); }, library, {}, [] {});
    CHECK(library.loaded().empty());
    bus.send(operation("swap", "contact.response", "Penalty"));
    reader.notify();
    RequestReader::ReadRequest next;
    REQUIRE(await(reader, next));
    REQUIRE_MESSAGE(next.wanted.ok(), next.wanted.error().text());
    CHECK(has_loaded(library, "Response/Penalty"));
    CHECK_FALSE(has_loaded(library, "Field/Gravity"));
    bus.send(operation("add", "", "",
                       "<plab version=\"1\"><component id=\"o\"><component id=\"down\" type=\"Field/Gravity\"/></component></plab>"));
    reader.notify();
    REQUIRE(await(reader, next));
    REQUIRE_MESSAGE(next.wanted.ok(), next.wanted.error().text());
    CHECK(has_loaded(library, "Field/Gravity"));
}

TEST_CASE("an addition is compiled for the scene that the requests before it leave")
{
    FakeBus bus;
    plugins::PluginLibrary library;
    RequestReader reader([&](publish::ReceivedRequest& text) { return bus.take(text); }, library, {}, [] {});
    const auto first = std::make_shared<const model::SceneSpec>(), second = std::make_shared<const model::SceneSpec>();
    reader.show(first);
    bus.send(operation("remove", "old")), bus.send(operation("add", "", "", "<component id=\"a\" type=\"Shape/Sphere\" radius=\"1\"/>"));
    reader.notify();
    RequestReader::ReadRequest next;
    REQUIRE(await(reader, next));
    std::this_thread::sleep_for(10ms);  // the reader could go on if it did not wait
    reader.show(second);                // now the first request has been carried out
    REQUIRE(await(reader, next));
    REQUIRE_MESSAGE(next.wanted.ok(), next.wanted.error().text());
    const auto& add = std::get<simulation::AddBlueprintOperation>(next.wanted->request.operations.front());
    REQUIRE(add.prepared);
    CHECK(add.prepared->fits(*second));
    CHECK_FALSE(add.prepared->fits(*first));
    REQUIRE_MESSAGE(add.prepared->whole.ok(), add.prepared->whole.error().text());
    CHECK((*add.prepared->whole)->components.size() == 1);
}

TEST_CASE("an addition does not wait forever for the requests before it, and not at all at the end")
{
    FakeBus bus;
    plugins::PluginLibrary library;
    RequestReader reader([&](publish::ReceivedRequest& text) { return bus.take(text); }, library, {}, [] {});
    const auto scene = std::make_shared<const model::SceneSpec>();
    reader.show(scene);
    for (int i = 0; i < 3; ++i) bus.send(operation("add", "", "", "<component id=\"a\" type=\"Shape/Sphere\" radius=\"1\"/>"));
    reader.notify();
    // The step thread is busy: it neither takes requests nor shows a scene.
    RequestReader::ReadRequest next;
    std::this_thread::sleep_for(20ms);
    const auto begin = std::chrono::steady_clock::now();
    reader.finish(5s);
    CHECK(std::chrono::steady_clock::now() - begin < 4s);
    int read = 0;
    for (; reader.take(next); ++read)
        CHECK(std::get<simulation::AddBlueprintOperation>(next.wanted->request.operations.front()).prepared->fits(*scene));
    CHECK(read == 3);
}

TEST_CASE("finish waits until all requests that have arrived are read, but not longer than allowed")
{
    FakeBus bus;
    plugins::PluginLibrary library;
    bus.delay = 50ms;
    RequestReader reader([&](publish::ReceivedRequest& text) { return bus.take(text); }, library, {}, [] {});
    bus.send(operation("pause")), bus.send(operation("resume"));
    reader.finish(5s);
    RequestReader::ReadRequest next;
    CHECK(reader.take(next));
    CHECK(reader.take(next));
    CHECK(next.text.number == 2);
    for (int i = 0; i < 100; ++i) bus.send(operation("pause"));
    const auto begin = std::chrono::steady_clock::now();
    reader.finish(120ms);
    CHECK(std::chrono::steady_clock::now() - begin < 2s);
    // 100 requests would take 5 s: it ends without them.
    reader.stop();
    CHECK(std::chrono::steady_clock::now() - begin < 3s);
    int read = 0;
    while (reader.take(next)) ++read;
    CHECK(read < 100);
}
