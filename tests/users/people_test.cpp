// The samples of clients as plabd turns them into inputs: how old they are, and how many did not count.
#include "daemon/people.h"

#include <cmath>

#include "users/hands.h"

using namespace plab;
using namespace plab::test;
using plab::daemon::ClientClock;
using plab::daemon::People;

namespace
{

constexpr std::int64_t kMillisecond = 1'000'000;

/// One client for "hand", and what its samples have set.
class Device
{
public:
    explicit Device(Scene& scene) : scene_(scene), people_(scene.simulation())
    {
        client_[0] = 7;
        REQUIRE(scene.ask(simulation::RateOperation{1}).done);  // simulated time is real time
    }
    /// Times in ms; `stamp` by a clock of its own.
    void send(std::uint64_t number, double stamp, double arrived, double now)
    {
        publish::ReceivedPeople people;
        publish::ReceivedSample<wire::UserSample>& r = people.users.emplace_back();
        r.sample.client = client_, r.sample.user = "hand", r.sample.number = number, r.sample.orientation = {1, 0, 0, 0};
        r.sample.stamp_ns = ns(stamp) + kOtherClock, r.arrived_ns = ns(arrived);
        people_.move(
            people, ns(now),
            [&](const People::Ask& ask)
            {
                const auto reply = scene_.simulation().carry_out_now(ask.request);
                CHECK_MESSAGE(reply.done, first_error(reply.errors));
                return reply;
            },
            [&](const char* kind, const std::string&, const std::string& message) { FAIL(kind, message); });
    }
    double age() const { return scene_.real("hand", "sample_age"); }
    std::uint64_t skipped() { return people_.forces().at(0).skipped; }

private:
    static constexpr std::int64_t kOtherClock = 1'700'000'000'000'000'000;
    static std::int64_t ns(double ms) { return static_cast<std::int64_t>(ms * kMillisecond) + 1'000'000'000; }
    Scene& scene_;
    People people_;
    wire::ClientId client_{};
};

}  // namespace

TEST_CASE("what a sample took longer than the fastest one counts as its age, whatever the client's clock shows")
{
    Scene scene(hand());
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    Device device(scene);
    device.send(1, 0, 5, 6);  // it took 5 ms, of which nothing is known yet
    CHECK(device.age() == doctest::Approx(1e-3).epsilon(1e-6));
    device.send(2, 10, 12, 12);  // 2 ms: the fastest one
    CHECK(device.age() == doctest::Approx(0).epsilon(1e-6));
    device.send(3, 20, 29, 30);  // 9 ms, so it is 7 ms and 1 ms old
    CHECK(device.age() == doctest::Approx(8e-3).epsilon(1e-3));
    device.send(4, 30, 32, 32);
    CHECK(device.age() == doctest::Approx(0).epsilon(1e-5));
}

TEST_CASE("samples that were lost on the way are counted, as those that newer ones replaced")
{
    Scene scene(hand());
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    Device device(scene);
    device.send(100, 0, 1, 1);
    CHECK(device.skipped() == 0);
    device.send(101, 1, 2, 2);
    CHECK(device.skipped() == 0);
    device.send(105, 5, 6, 6);
    CHECK(device.skipped() == 3);
    device.send(3, 6, 7, 7);  // it has begun anew
    CHECK(device.skipped() == 3);
    device.send(4, 7, 8, 8);
    CHECK(device.skipped() == 3);
}

TEST_CASE("the clock of a client: drift is followed, and a clock that is set begins anew")
{
    ClientClock clock;
    CHECK(clock.sent(0, 77) == 77);  // no stamp
    std::int64_t worst = 0;
    // Its clock is slow by 50 in a million for an hour, one sample each ms that takes 2 ms.
    for (std::int64_t n = 0; n < 3'600'000; n += 100)
    {
        const std::int64_t sent = n * kMillisecond, stamp = 1 + sent - sent / 20'000;
        const std::int64_t told = clock.sent(stamp, sent + 2 * kMillisecond);
        worst = std::max(worst, std::abs(sent + 2 * kMillisecond - told));
    }
    CHECK(worst < kMillisecond / 10);
    const std::int64_t now = 3'700'000 * kMillisecond;
    CHECK(clock.sent(5, now) == now);                                                                // set back
    CHECK(clock.sent(5 + 10 * kMillisecond, now + 500 * kMillisecond) == now + 500 * kMillisecond);  // nothing came for half a second
}
