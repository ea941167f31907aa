// Hashes that are passed to a recording: complete, in order, and without long delay.
#include "publish/hash_batch.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <deque>

using plab::Tick;
using plab::publish::HashBatch;
using plab::publish::Nanoseconds;
using plab::wire::Hashes;

namespace
{

constexpr Nanoseconds kMillisecond = 1'000'000;

struct Trajectory
{
    Nanoseconds oldest = 0;  ///< longest time between a step and the record that has its hash
    std::size_t records = 0, largest = 0;
};

/// Steps at this interval.
Trajectory trajectory_of(Nanoseconds interval, int steps)
{
    Trajectory out;
    HashBatch batch;
    Tick due = 1;
    for (Tick step = 1; step <= steps; ++step)
    {
        const Nanoseconds now = 1000 * kMillisecond + step * interval;
        const auto record = batch.add(1, step, static_cast<std::uint64_t>(step), now);
        if (!record) continue;
        CHECK(record->step == due);
        CHECK(record->sequence_number == static_cast<std::uint64_t>(due));
        CHECK(record->values.front() == static_cast<std::uint64_t>(due));
        out.oldest = std::max(out.oldest, (step - due) * interval);
        out.largest = std::max(out.largest, record->values.size());
        ++out.records, due = record->step + static_cast<Tick>(record->values.size());
        // The next hash to be handed over is that of the next step.
        CHECK(due == step + 1);
    }
    return out;
}

}  // namespace

TEST_CASE("no hash waits for longer than 3 ms, however long steps are, and those of fast steps are batched")
{
    for (const Nanoseconds interval :
         {kMillisecond / 50, kMillisecond / 4, kMillisecond, 2 * kMillisecond, 4 * kMillisecond, 50 * kMillisecond})
    {
        CAPTURE(interval);
        CHECK(trajectory_of(interval, 1000).oldest <= 3 * kMillisecond);
    }
    CHECK(trajectory_of(kMillisecond, 1000).records == 250);
    CHECK(trajectory_of(4 * kMillisecond, 1000).records == 1000);
    CHECK(trajectory_of(kMillisecond / 50, 1000).largest == 64);
}

TEST_CASE("a hash that does not follow the last one begins a record")
{
    HashBatch batch;
    (void)batch.add(1, 1, 7, 0);
    CHECK(!batch.add(1, 2, 8, 1));
    const auto gap = batch.add(1, 5, 9, 2);
    REQUIRE(gap);
    CHECK(gap->step == 1);
    CHECK(gap->values.size() == 2);
    const auto run = batch.add(2, 6, 10, 3);
    REQUIRE(run);
    CHECK(run->step == 5);
    CHECK(batch.flush()->run == 2);
    CHECK(!batch.flush());
}
