// The samples of people on their way to the step thread: only the newest one of each, a bounded number, and none that cannot be right.
#include "bus/people_desk.h"

#include <doctest/doctest.h>

#include <limits>

using namespace plab;
using namespace plab::bus;

namespace
{

wire::ClientId guest(std::uint8_t number) { return {number}; }

ViewerMessage viewer(std::uint8_t of, std::uint64_t number, double x = 0)
{
    ViewerMessage out;
    out.sample.client = guest(of), out.sample.number = number, out.sample.position = {x, 0, 0};
    out.sample.direction = {1, 0, 0}, out.sample.up = {0, 0, 1};
    return out;
}

UserMessage user(std::uint64_t number, double x = 0)
{
    UserMessage out;
    out.sample.client = guest(1), out.sample.number = number, out.sample.position = {x, 0, 0}, out.sample.orientation = {1, 0, 0, 0};
    return out;
}

}  // namespace

TEST_CASE("however fast samples come, the step thread gets the newest one of each client and component, and knows how many it replaced")
{
    PeopleDesk desk;
    for (std::uint64_t n = 1; n <= 1000; ++n) desk.receive(viewer(1, n, 0.1 * static_cast<double>(n)), static_cast<std::int64_t>(n));
    for (std::uint64_t n = 1; n <= 10; ++n) desk.receive(viewer(2, n), static_cast<std::int64_t>(n));
    publish::ReceivedPeople people;
    desk.take(people);
    REQUIRE(people.viewers.size() == 2);
    CHECK(people.users.empty());
    CHECK(people.viewers[0].sample.number == 1000);
    CHECK(people.viewers[0].sample.position.x == doctest::Approx(100));
    CHECK(people.viewers[0].skipped == 999);
    CHECK(people.viewers[0].arrived_ns == 1000);
    CHECK(people.viewers[1].skipped == 9);
    desk.take(people);
    CHECK(people.viewers.empty());
}

TEST_CASE("no more than 64 viewers wait, however many send")
{
    PeopleDesk desk;
    for (int k = 0; k < 250; ++k) desk.receive(viewer(static_cast<std::uint8_t>(k), 1), k);
    publish::ReceivedPeople people;
    desk.take(people);
    CHECK(people.viewers.size() == PeopleDesk::kMost);
}

TEST_CASE("samples that cannot be right are dropped; who is gone is told, also by a client whose last sample was wrong")
{
    PeopleDesk desk;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    desk.receive(user(1, nan), 1);
    UserMessage flat = user(2);
    flat.sample.orientation = {0, 0, 0, 0};
    desk.receive(std::move(flat), 2);
    UserMessage long_name = user(3);
    long_name.sample.user = std::string(PeopleDesk::kLongest + 1, 'x');
    desk.receive(std::move(long_name), 3);
    publish::ReceivedPeople people;
    desk.take(people);
    CHECK(people.users.empty());
    UserMessage gone = user(4, nan);
    gone.gone = true;
    desk.receive(std::move(gone), 4);
    desk.take(people);
    REQUIRE(people.users.size() == 1);
    CHECK(people.users[0].gone);
}
