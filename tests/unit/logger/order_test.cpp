// Lines wait for earlier ones, and no longer than necessary.
#include <doctest/doctest.h>

#include "logger/order.h"

using namespace plab::logger;
using namespace std::chrono_literals;

namespace
{

const Order::Clock::time_point kStart{};

std::string texts(const std::vector<Line>& lines)
{
    std::string out;
    for (const Line& line : lines) out += line.text;
    return out;
}

}  // namespace

TEST_CASE("a line that arrives late is written before later ones")
{
    Order order;
    order.add({1, 3, true, "c"}, kStart);
    CHECK(order.take(kStart + 99ms).empty());
    order.add({1, 2, true, "b"}, kStart + 99ms);
    CHECK(texts(order.take(kStart + 100ms)) == "bc");  // b has not waited itself, but c must not overtake it
    CHECK(order.take_all().empty());
}

TEST_CASE("a line waits for its full time, whichever lines are written before it")
{
    Order order;
    order.add({1, 1, true, "a"}, kStart);
    order.add({1, 2, true, "b"}, kStart + 50ms);
    CHECK(order.due(kStart + 1s) == kStart + 100ms);
    CHECK(texts(order.take(kStart + 100ms)) == "a");
    CHECK(order.due(kStart + 1s) == kStart + 150ms);
    CHECK(order.due(kStart + 120ms) == kStart + 120ms);
    CHECK(texts(order.take(kStart + 150ms)) == "b");
    CHECK(order.due(kStart + 1s) == kStart + 1s);
}

TEST_CASE("lines of one step keep the order of arrival, and runs follow one another")
{
    Order order;
    order.add({2, 1, true, "d"}, kStart);
    order.add({1, 7, true, "b"}, kStart);
    order.add({1, 7, true, "c"}, kStart);
    order.add({1, 6, true, "a"}, kStart);
    CHECK(texts(order.take_all()) == "abcd");
}
