// Tests that need another process: a reader that is stopped, and the module as the daemon loads it.
#include <dlfcn.h>

#include <algorithm>
#include <csignal>

#include "support.h"
#include "support/process.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// Hands over `count` frames of 1000 bodies and as many events at 500 Hz; how long each took, us, sorted.
std::vector<double> push_many(TestBus& bus, std::uint64_t& number, int count)
{
    std::vector<double> us;
    for (int i = 0; i < count; ++i)
    {
        const auto begin = std::chrono::steady_clock::now();
        push_frame(*bus.operator->(), ++number, 1000);
        wire::Events batch;
        batch.sequence_number = number;
        batch.entries.resize(1);
        bus->events(std::move(batch));
        us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
        std::this_thread::sleep_for(2ms);
    }
    std::sort(us.begin(), us.end());
    return us;
}

double at(const std::vector<double>& sorted, double quantile)
{
    return sorted[static_cast<std::size_t>(quantile * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

TEST_CASE("a reader that is stopped delays neither the step thread nor other readers nor the shutdown")
{
    TestBus bus;
    const link::Session session = bus.session();
    Process reader({PLAB_BUS_TRAFFIC, "read", bus.options().name, "20"}, {"PLAB_DOMAIN=" + std::to_string(bus.options().domain)});
    REQUIRE(eventually([&] { return bus->wants(publish::Stream::States); }, 10s));
    std::uint64_t number = 0;
    const auto awake = push_many(bus, number, 300);
    reader.signal(SIGSTOP);
    const auto stopped = push_many(bus, number, 1000);
    MESSAGE("handing over, reader awake: median " << at(awake, 0.5) << " us, 99 % " << at(awake, 0.99) << " us");
    MESSAGE("handing over, reader stopped: median " << at(stopped, 0.5) << " us, 99 % " << at(stopped, 0.99) << " us");
    CHECK(at(stopped, 0.99) < 20000);  // a thread that waited for the reader would wait for seconds

    auto other = reader_of<plab_v2_Frame>(session);
    REQUIRE(eventually([&] { return other.writers() > 0; }));
    std::this_thread::sleep_for(50ms);
    std::uint64_t last = 0;
    const bool arrived = eventually(
        [&]
        {
            push_frame(*bus.operator->(), ++number, 1);
            (void)other.take([&](const plab_v2_Frame& f, const dds_sample_info_t&) { last = f.sequence_number; });
            return last > 0;
        });
    CHECK(arrived);

    const auto begin = std::chrono::steady_clock::now();
    bus.close();
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    MESSAGE("the end with a stopped reader took " << took << " s");
    CHECK(took < 3);
}

TEST_CASE("the module opens a bus, or reports why it cannot")
{
    void* const module = dlopen(PLAB_BUS_MODULE, RTLD_NOW | RTLD_LOCAL);
    REQUIRE_MESSAGE(module != nullptr, dlerror());
    void* const entry = dlsym(module, bus::kEntryName);
    REQUIRE(entry != nullptr);
    const auto open = reinterpret_cast<bus::Open>(entry);
    bus::BusOptions options;
    options.name = TestBus::unused_name(), options.domain = TestBus::domain();
    Error error;
    {
        const auto first = open(options, error);
        REQUIRE(bool(first));
        CHECK(error.reason.empty());
        CHECK(first->lost().empty());
        CHECK_FALSE(bool(open(options, error)));
        CHECK(error.reason.find("is already running on this host") != std::string::npos);
    }
    CHECK(bool(open(options, error)));
    (void)dlclose(module);
}
