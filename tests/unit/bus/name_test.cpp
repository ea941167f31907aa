// One server for each name.
#include "idl/identity.h"
#include "support.h"

using namespace plab;
using namespace plab::test;

namespace
{

plab_v2_Server server_sample(const std::string& name, const std::string& host, std::int32_t process, std::int64_t started)
{
    plab_v2_Server s{};
    s.name = wire::text(name), s.host = wire::text(host), s.process = process, s.started_ns = started;
    return s;
}

}  // namespace

TEST_CASE("a second server of one name on a host is refused until the first has ended; the message names the first")
{
    TestBus first;
    const auto second = bus::ServerBus::open(first.options());
    REQUIRE_FALSE(second.ok());
    CHECK(second.error().text() == "a server '" + first.options().name + "' is already running on this host in domain " +
                                       std::to_string(first.options().domain) + " (process " + std::to_string(getpid()) +
                                       "): give this one another name");
    bus::BusOptions other = first.options();
    other.name = TestBus::unused_name();
    CHECK(bus::ServerBus::open(other).ok());
    first.close();
    CHECK(bus::ServerBus::open(first.options()).ok());
}

TEST_CASE("invalid names, domains and interfaces are refused")
{
    bus::BusOptions options;
    for (const char* name : {"", "a b", "*", "x/y"})
    {
        options.name = name;
        const auto opened = bus::ServerBus::open(options);
        REQUIRE_FALSE(opened.ok());
        CHECK(opened.error().text().find("is not a valid server name") != std::string::npos);
    }
    options.name = TestBus::unused_name(), options.domain = 233;
    CHECK_FALSE(bus::ServerBus::open(options).ok());
    options.domain = TestBus::domain(), options.network_interface = "\"><x>";
    CHECK_FALSE(bus::ServerBus::open(options).ok());
}

TEST_CASE("of two servers the one that started first keeps the name; at the same time, host and process decide")
{
    const wire::Identity self{"s", "", "host-b", 20, 1000};
    CHECK(wire::keeps_the_name(server_sample("s", "host-c", 30, 999), self));
    CHECK_FALSE(wire::keeps_the_name(server_sample("s", "host-a", 10, 1001), self));
    CHECK(wire::keeps_the_name(server_sample("s", "host-a", 30, 1000), self));
    CHECK_FALSE(wire::keeps_the_name(server_sample("s", "host-c", 10, 1000), self));
    CHECK(wire::keeps_the_name(server_sample("s", "host-b", 19, 1000), self));
    CHECK_FALSE(wire::keeps_the_name(server_sample("s", "host-b", 20, 1000), self));  // this is the server itself
    CHECK_FALSE(wire::keeps_the_name(server_sample("t", "host-a", 10, 1), self));
    CHECK_FALSE(wire::keeps_the_name(server_sample("s", "host-a", 10, 0), self));  // has no information
}

TEST_CASE("a server that finds an older one of its name on another host reports that it has lost the name")
{
    TestBus bus;
    const link::Session elsewhere = bus.session();
    auto writer = elsewhere.writer<plab_v2_Server>();
    REQUIRE(writer.ok());
    REQUIRE(eventually([&] { return writer->readers() > 0; }));
    bus->status({});
    const std::int64_t later = std::numeric_limits<std::int64_t>::max();
    CHECK(writer->write(server_sample(bus.options().name, "elsewhere", 7, later)) == DDS_RETCODE_OK);
    std::this_thread::sleep_for(100ms);
    CHECK(bus->lost().empty());
    const int before = bus.wakes();
    CHECK(writer->write(server_sample(bus.options().name, "elsewhere", 7, 1)) == DDS_RETCODE_OK);
    REQUIRE(eventually([&] { return !bus->lost().empty(); }));
    CHECK(bus->lost().find("is already running on host elsewhere (process 7)") != std::string::npos);
    CHECK(eventually([&] { return bus.wakes() > before; }));
}
