// The catalogue that all clients share, and the names that were probably meant.
#include "link/catalogue.h"

#include <limits>

#include "link/names.h"
#include "plabctl.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("a catalogue knows when it is complete, and follows the server")
{
    auto server = std::make_unique<FakeServer>(test_domain(), "lab");
    link::SessionOptions options;
    options.server = "lab", options.domain.id = test_domain();
    auto session = link::Session::find(options, link::Seconds(5));
    REQUIRE(session);
    auto catalogue = link::Catalogue::open(*session);
    REQUIRE(catalogue);
    REQUIRE(catalogue->fetch(link::Seconds(5)));
    const link::CatalogueContents& now = catalogue->now();
    CHECK(now.objects.size() == 2);
    CHECK(now.interactions.size() == 2);
    CHECK(now.types.size() == 6);
    CHECK(now.shapes.at("balloon").size.x == 0.15);
    CHECK(now.objects.at("red").color == Vec3{0.9, 0.1, 0.1});
    CHECK_FALSE(link::color_of(now.objects.at("a_fan_with_a_very_long_name")));
    REQUIRE(catalogue->find_object(7) != nullptr);
    CHECK(catalogue->find_object(7)->component_id == "red");
    CHECK(catalogue->find_object(8) == nullptr);
    const std::uint64_t version = catalogue->version();
    const std::int64_t step = now.server->step;
    // It may be woken by another topic: the server's own record comes ten times a second.
    for (int i = 0; i < 50 && now.server->step == step; ++i) CHECK(catalogue->wait(link::Seconds(2)));
    CHECK(now.server->step > step);
    CHECK(catalogue->version() == version);
    CHECK_FALSE(catalogue->server_is_gone());
    server.reset();
    for (int i = 0; i < 50 && !catalogue->server_is_gone(); ++i) (void)catalogue->wait(link::Seconds(0.1));
    CHECK(catalogue->server_is_gone());
    CHECK(now.objects.empty());
    CHECK(catalogue->version() > version);
}

TEST_CASE("a catalogue without a server gives up and says what is missing")
{
    link::SessionOptions options;
    options.server = "nobody", options.domain.id = test_domain();
    auto session = link::Session::join(options);
    REQUIRE(session);
    auto catalogue = link::Catalogue::open(*session);
    REQUIRE(catalogue);
    const auto fetched = catalogue->fetch(link::Seconds(0.3));
    REQUIRE_FALSE(fetched);
    CHECK(has(fetched.error().text(), "server 'nobody' did not send its complete catalogue; missing: the server's state"));
    CHECK_FALSE(catalogue->server_is_gone());
}

TEST_CASE("no wait overflows, whatever duration is given")
{
    const double nan = std::numeric_limits<double>::quiet_NaN(), endless = std::numeric_limits<double>::infinity();
    CHECK(link::duration_of(link::Seconds(0.25)) == 250'000'000);
    CHECK(link::duration_of(link::Seconds(1e10)) == 100'000'000'000'000'000);
    CHECK(link::duration_of(link::Seconds(endless)) == link::duration_of(link::kLongestWait));
    CHECK(link::duration_of(link::Seconds(-1)) == 0);
    CHECK(link::duration_of(link::Seconds(nan)) == 0);
    const auto now = std::chrono::steady_clock::now();
    CHECK(link::moment_after(link::Seconds(endless), now) - now == std::chrono::seconds(100'000'000));
}

TEST_CASE("nearest names: typing errors, capitals, last parts")
{
    const std::vector<std::string> known{"Resolution/Bisection", "Resolution/None", "Response/Impulse", "Response/None", "red", "green"};
    CHECK(link::nearest_names("rde", known) == std::vector<std::string>{"red"});
    CHECK(link::nearest_names("GREEN", known) == std::vector<std::string>{"green"});
    CHECK(link::nearest_names("Bisectoin", known) == std::vector<std::string>{"Resolution/Bisection"});
    CHECK(link::nearest_names("response/impulse", known) == std::vector<std::string>{"Response/Impulse"});
    CHECK(link::nearest_names("balloon", known).empty());
    CHECK(link::nearest_names("", known).empty());
    CHECK(link::nearest_names(std::string(5000, 'x'), known).empty());
    CHECK(link::did_you_mean("rad", {"rod", "red"}) == ", did you mean 'red' or 'rod'?");
    CHECK(link::did_you_mean("xyz", known).empty());
}
