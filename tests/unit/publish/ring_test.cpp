// The ring: order, dropped entries, memory that is kept, and two threads.
#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "publish/ring.h"

using plab::publish::Ring;

namespace
{

void push(Ring<int>& ring, int value)
{
    ring.begin_push() = value;
    ring.end_push();
}

int pop(Ring<int>& ring)
{
    const int* value = ring.begin_pop();
    if (!value) return -1;
    const int out = *value;
    ring.end_pop();
    return out;
}

}  // namespace

TEST_CASE("pushed entries come out in order, once")
{
    Ring<int> ring(4);
    CHECK(ring.empty());
    CHECK(ring.begin_pop() == nullptr);
    for (int round = 0; round < 10; ++round)
    {
        for (int i = 0; i < 4; ++i) push(ring, 10 * round + i);
        CHECK(!ring.empty());
        for (int i = 0; i < 4; ++i) CHECK(pop(ring) == 10 * round + i);
        CHECK(pop(ring) == -1);
        CHECK(ring.empty());
    }
    CHECK(ring.dropped() == 0);
}

TEST_CASE("a full ring drops the oldest entry and counts it")
{
    Ring<int> ring(3);  // four slots: one more than requested, while none is held
    for (int i = 0; i < 10; ++i) push(ring, i);
    CHECK(ring.dropped() == 6);
    for (int i = 6; i < 10; ++i) CHECK(pop(ring) == i);
    CHECK(pop(ring) == -1);
}

TEST_CASE("an entry that is being written is hidden")
{
    Ring<int> ring(2);
    ring.begin_push() = 1;
    CHECK(ring.begin_pop() == nullptr);
    ring.end_push();
    CHECK(pop(ring) == 1);
}

TEST_CASE("a held slot is skipped")
{
    Ring<int> ring(2);
    push(ring, 0);
    const int* held = ring.begin_pop();
    REQUIRE(held);
    for (int i = 1; i <= 20; ++i) push(ring, i);
    CHECK(*held == 0);
    CHECK(ring.dropped() == 18);
    ring.end_pop();
    CHECK(pop(ring) == 19);
    CHECK(pop(ring) == 20);
    CHECK(pop(ring) == -1);
    // The freed slot is in use again.
    for (int i = 21; i <= 23; ++i) push(ring, i);
    for (int i = 21; i <= 23; ++i) CHECK(pop(ring) == i);
}

TEST_CASE("slots keep their memory")
{
    Ring<std::vector<double>> ring(1);
    std::array<const double*, 2> first{};
    for (const double*& p : first)
    {
        std::vector<double>& v = ring.begin_push();
        v.assign(1000, 1.0);
        p = v.data();
        ring.end_push();
    }
    for (std::size_t i = 0; i < 10; ++i)
    {
        std::vector<double>& v = ring.begin_push();
        v.assign(1000, 2.0);
        CHECK(v.data() == first[i % 2]);
        ring.end_push();
    }
}

namespace
{

/// Every word has the number of the entry: a torn entry would be inconsistent.
using Entry = std::array<std::uint64_t, 32>;

struct Seen
{
    std::uint64_t entries = 0, torn = 0, disordered = 0, last = 0;
};

Seen read_until(Ring<Entry>& ring, const std::atomic<bool>& done, int rest)
{
    Seen seen;
    for (bool more = true; more;)
    {
        more = !done.load(std::memory_order_acquire);
        while (const Entry* e = ring.begin_pop())
        {
            for (int i = 0; i < rest; ++i) std::atomic_signal_fence(std::memory_order_seq_cst);
            for (const std::uint64_t word : *e) seen.torn += word != (*e)[0] ? 1 : 0;
            seen.disordered += (*e)[0] <= seen.last ? 1 : 0;
            seen.last = (*e)[0];
            ++seen.entries;
            ring.end_pop();
        }
    }
    return seen;
}

}  // namespace

TEST_CASE("two threads: no entry is torn, duplicated, out of order, or lost without being counted")
{
    constexpr std::uint64_t kEntries = 50'000;
    for (const std::size_t capacity : {1, 2, 7, 64})
        for (const int rest : {0, 300})  // a consumer that keeps up, and one that does not
        {
            Ring<Entry> ring(capacity);
            std::atomic<bool> done{false};
            Seen seen;
            std::thread consumer([&] { seen = read_until(ring, done, rest); });
            for (std::uint64_t n = 1; n <= kEntries; ++n)
            {
                ring.begin_push().fill(n);
                ring.end_push();
                if (n % 64 == 0 && rest == 0) std::this_thread::yield();
            }
            done.store(true, std::memory_order_release);
            consumer.join();
            CAPTURE(capacity);
            CAPTURE(rest);
            CHECK(seen.torn == 0);
            CHECK(seen.disordered == 0);
            CHECK(seen.last == kEntries);
            CHECK(seen.entries + ring.dropped() == kEntries);
            CHECK(seen.entries > 0);
        }
}
