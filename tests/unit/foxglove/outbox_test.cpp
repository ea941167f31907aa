#include "foxglove/outbox.h"

#include <doctest/doctest.h>

#include <cstring>
#include <string>

#include "foxglove/clients.h"

using namespace plab::foxglove;

namespace
{

const Channel kStates{1, "states", "", "", Keep::Newest, nullptr};
const Channel kEvents{2, "events", "", "", Keep::Log, nullptr};
const Channel kScene{3, "scene", "", "", Keep::Whole, nullptr};

Stamped stamped(const std::string& content, std::uint64_t time = 0)
{
    return {std::make_shared<Message>(Message::binary(std::string_view(content))), time};
}
std::string content_of(const std::optional<Outgoing>& out)
{
    return out && out->message ? std::string(reinterpret_cast<const char*>(out->message->content()), out->message->size()) : "-";
}
SubscriptionId subscription_of(const std::optional<Outgoing>& out)
{
    SubscriptionId id = 0;
    std::memcpy(&id, out->head.data() + 1, sizeof id);
    return id;
}

}  // namespace

TEST_CASE("of states only the newest of each instance waits")
{
    Outbox box;
    box.subscribe(7, kStates);
    box.put(1, 10, stamped("a1"));
    box.put(1, 20, stamped("b1"));
    for (int i = 2; i < 1000; ++i) box.put(1, 10, stamped("a" + std::to_string(i)));
    CHECK(content_of(box.take()) == "a999");
    const auto second = box.take();
    CHECK(content_of(second) == "b1");
    CHECK(subscription_of(second) == 7);
    CHECK(second->head[0] == 1);
    CHECK(!box.take());
    CHECK(!box.has_any());
}

TEST_CASE("a log keeps its newest messages and counts the others")
{
    Outbox box;
    box.subscribe(0, kEvents);
    const std::size_t all = Outbox::kMostLogged + 100;
    for (std::size_t i = 0; i < all; ++i) box.put(2, 0, stamped(std::to_string(i)));
    CHECK(box.dropped() == 100);
    CHECK(content_of(box.take()) == "100");
    Outbox small;
    small.subscribe(0, kEvents);
    const std::string half(Outbox::kMostLoggedBytes / 2 + 1, 'x');
    for (int i = 0; i < 5; ++i) small.put(2, 0, stamped(half));
    CHECK(small.dropped() == 4);
}

TEST_CASE("who misses a change of the scene gets all of it, once it has taken what waits")
{
    Outbox box;
    box.subscribe(0, kScene);
    CHECK(box.wants_whole(0));
    box.put(3, 0, stamped("lost"));
    box.begin(0, {stamped("whole 1"), stamped("whole 2")});
    CHECK(!box.wants_whole(0));
    box.put(3, 0, stamped("change"));
    for (const char* expected : {"whole 1", "whole 2", "change"}) CHECK(content_of(box.take()) == expected);
    for (std::size_t i = 0; i < 2 * Outbox::kMostLogged; ++i) box.put(3, 0, stamped("x"));
    CHECK(!box.has_any());
    CHECK(box.wants_whole(0));
    CHECK(box.dropped() == 0);
}

TEST_CASE("subscriptions take turns, and what is said comes first")
{
    Outbox box;
    box.subscribe(1, kEvents), box.subscribe(2, kEvents);
    for (int i = 0; i < 3; ++i) box.put_to(1, 0, stamped("one")), box.put_to(2, 0, stamped("two"));
    box.tell_time(5), box.tell_time(6);
    box.say(std::make_shared<Message>("said"));
    CHECK(content_of(box.take()) == "said");
    CHECK(content_of(box.take()) == std::string("\2\6\0\0\0\0\0\0\0", 9));
    for (const char* expected : {"one", "two", "one", "two"}) CHECK(content_of(box.take()) == expected);
    box.unsubscribe(1);
    CHECK(content_of(box.take()) == "two");
    CHECK(!box.take());
}

TEST_CASE("a client that takes no replies is dropped")
{
    Outbox box;
    for (std::size_t i = 0; i <= Outbox::kMostSaid; ++i) box.say(std::make_shared<Message>("reply"));
    CHECK(!box.worth_keeping());
    REQUIRE(box.has_any());
    CHECK(box.take()->message == nullptr);
}

TEST_CASE("there are so many clients, and so many messages of them wait")
{
    Clients clients;
    clients.set_greeting({std::make_shared<Message>("hello")});
    std::vector<ClientId> all;
    for (std::size_t i = 0; i < Clients::kMostClients; ++i) all.push_back(*clients.join());
    CHECK(!clients.join());
    CHECK(content_of(clients.take(all[0])) == "hello");
    clients.set_trouble(std::make_shared<Message>("no server"));
    CHECK(content_of(clients.take(all[0])) == "no server");
    clients.leave(all[0]);
    const auto late = clients.join();
    REQUIRE(late);
    for (const char* expected : {"hello", "no server"}) CHECK(content_of(clients.take(*late)) == expected);
    (void)clients.arrived();
    for (std::size_t i = 0; i < Clients::kMostWaiting; ++i) CHECK(!clients.receive(all[1], "{}", false));
    CHECK(clients.receive(all[1], "{}", false));
    CHECK(clients.arrived().size() == Clients::kMostWaiting);
}
