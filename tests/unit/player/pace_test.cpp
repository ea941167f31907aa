// The position of a playback, with a clock that the test advances.
#include "control/recording/player/pace.h"

#include <doctest/doctest.h>

using namespace plab::player;

namespace
{

using Clock = Pace::Clock;
using std::chrono::milliseconds;

constexpr std::uint64_t kSecond = 1'000'000'000;
const Clock::time_point kStart{std::chrono::hours(1)};

Clock::time_point after(int ms) { return kStart + milliseconds(ms); }

}  // namespace

TEST_CASE("a second of real time is as many seconds as the rate says, and the position stays within the span")
{
    const Pace plain({2 * kSecond, 5 * kSecond}, 1, false, kStart);
    CHECK(plain.position(kStart) == 2 * kSecond);
    CHECK(plain.position(after(1500)) == 3'500'000'000);
    CHECK_FALSE(plain.at_end(after(2999)));
    CHECK(plain.position(after(3000)) == 5 * kSecond);
    CHECK(plain.position(after(1'000'000)) == 5 * kSecond);
    CHECK(plain.at_end(after(3000)));
    const Pace slow({0, kSecond}, 0.25, false, kStart);
    CHECK(slow.position(after(1000)) == kSecond / 4);
    CHECK(Pace({0, kSecond}, 0, false, kStart).rate() == Pace::kSlowest);
    CHECK(Pace({0, kSecond}, 1e9, false, kStart).rate() == Pace::kFastest);
}

TEST_CASE("at the time at which a message is due the position is reached, and not long before")
{
    for (const double rate : {0.3, 1.0, 7.0, 333.0})
    {
        const Pace pace({0, 100 * kSecond}, rate, false, kStart);
        for (const std::uint64_t time : {std::uint64_t{1}, std::uint64_t{333'333'333}, 7 * kSecond + 1})
        {
            const auto due = pace.when(time);
            REQUIRE(due);
            CHECK(pace.position(*due) >= time);
            CHECK(pace.position(*due - std::chrono::microseconds(1)) < time);
        }
    }
}

TEST_CASE("during a pause the position does not change, and a change of rate or a jump has only its own effect")
{
    Pace pace({0, 100 * kSecond}, 1, true, kStart);
    CHECK(pace.position(after(5000)) == 0);
    CHECK_FALSE(pace.when(1));
    CHECK(pace.when(0) == kStart);  // messages at the present position are due
    pace.pause(false, after(5000));
    CHECK(pace.position(after(6000)) == kSecond);
    pace.set_rate(10, after(6000));
    CHECK(pace.position(after(6000)) == kSecond);
    CHECK(pace.position(after(6100)) == 2 * kSecond);
    pace.seek(50 * kSecond, after(6100));
    CHECK(pace.position(after(6100)) == 50 * kSecond);
    CHECK(pace.position(after(6200)) == 51 * kSecond);
    pace.pause(true, after(6200));
    pace.seek(200 * kSecond, after(9000));
    CHECK(pace.position(after(9999)) == 100 * kSecond);
    pace.seek(0, after(9999));
    CHECK(pace.position(after(20000)) == 0);
}
