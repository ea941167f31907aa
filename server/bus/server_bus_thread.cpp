/// What the bus thread does.
#include <algorithm>

#include "bus/server_bus.h"

namespace plab::bus
{
namespace
{

constexpr std::size_t kBurst = 64;  ///< records of one stream before the others have their turn
constexpr std::chrono::seconds kSecond(1);
constexpr std::chrono::milliseconds kRetry(10), kGoodbye(200);

}  // namespace

void ServerBus::run()
{
    while (!stop_.load(std::memory_order_acquire))
        if (!pass()) wake_up_.sleep(idle_time(Clock::now()));
    // What was handed over before the end still goes out.
    constexpr int kMostPasses = 1000;
    for (int i = 0; i < kMostPasses && pass(); ++i) continue;
    say_goodbye();
}

bool ServerBus::pass()
{
    const Clock::time_point now = Clock::now();
    bool more = receive(now);
    if (now - reported_ >= kSecond)
    {
        reported_ = now;
        matched_.store(true, std::memory_order_relaxed);
        trouble_.report();
    }
    if (matched_.exchange(false, std::memory_order_acquire)) look_at_readers();
    send_catalogue();
    const std::vector<wire::Dropped> given_up = dropped();
    presence_.send(now, given_up, options_.busy != nullptr ? options_.busy(options_.busy_argument) : std::string(), trouble_);
    desk_.retry(now);
    // The catalogue was handed over before the answer: whoever has the reply finds in it what the request did.
    while (desk_.next_answer()) send_catalogue(), desk_.send_answer(now);
    more = events_.send(kBurst, trouble_) || more;
    more = collisions_.send(kBurst, trouble_) || more;
    more = states_.send(kBurst, trouble_) || more;
    more = metrics_.send(kBurst, trouble_) || more;
    more = journal_.send(kBurst, trouble_) || more;
    more = hashes_.send(kBurst, trouble_) || more;
    more = snapshots_.send(1, trouble_) || more;
    return images_.send(1, trouble_) || more;
}

bool ServerBus::receive(Clock::time_point now)
{
    if (!arrived_.exchange(false, std::memory_order_acquire)) return false;
    const RequestDesk::Received received = desk_.receive(now);
    if (received.shutdown && options_.end != nullptr) options_.end(options_.end_argument);
    if (received.any_new && options_.wake != nullptr) options_.wake(options_.wake_argument);
    if (received.more) arrived_.store(true, std::memory_order_relaxed);
    if (auto rival = presence_.look_for_rival(); rival && !is_lost_.load(std::memory_order_relaxed))
    {
        why_lost_ = *std::move(rival);
        is_lost_.store(true, std::memory_order_release);
        if (options_.wake != nullptr) options_.wake(options_.wake_argument);
    }
    return received.more;
}

void ServerBus::look_at_readers()
{
    bool first = states_.look();
    first = collisions_.look() || first;
    first = events_.look() || first;
    first = metrics_.look() || first;
    first = images_.look() || first;
    first = journal_.look() || first;
    first = hashes_.look() || first;
    first = snapshots_.look() || first;
    if (first && options_.wake != nullptr) options_.wake(options_.wake_argument);
}

void ServerBus::send_catalogue()
{
    bool any = false;
    while (publish::CatalogueChange* change = changes_.begin_pop())
    {
        catalogue_.apply(*change, trouble_);
        *change = {};
        changes_.end_pop();
        changes_waiting_.fetch_sub(1, std::memory_order_release);
        any = true;
    }
    if (any) follow_scene();
}

void ServerBus::follow_scene()
{
    const auto follow = [&](auto& stream, const char* prefix)
    {
        if (auto done = stream.be(catalogue_.has_type_below(prefix), participant_, publisher_); !done) trouble_.say(done.error().text());
    };
    follow(collisions_, "CDetection/");
    follow(images_, "Camera/");
}

std::vector<wire::Dropped> ServerBus::dropped() const
{
    std::vector<wire::Dropped> out;
    const auto add = [&](const auto& stream)
    {
        const std::uint64_t samples = stream.dropped() + trouble_.lost(stream.topic());
        if (samples > 0) out.push_back({stream.topic(), samples});
    };
    add(states_), add(collisions_), add(events_), add(metrics_), add(images_), add(journal_), add(hashes_), add(snapshots_);
    return out;
}

ServerBus::Clock::duration ServerBus::idle_time(Clock::time_point now) const
{
    if (desk_.retrying()) return kRetry;
    return std::min<Clock::duration>(presence_.due_in(now), kSecond);
}

void ServerBus::say_goodbye()
{
    catalogue_.dispose_all(trouble_);
    presence_.dispose(trouble_);
    const Clock::time_point end = Clock::now() + kGoodbye;
    const auto flush = [&](dds_entity_t writer)
    {
        const std::chrono::nanoseconds left = end - Clock::now();
        // A reader that does not answer must not hold the end up: what has not arrived by then is lost to it.
        if (writer > 0 && left.count() > 0) (void)dds_wait_for_acks(writer, left.count());
    };
    flush(desk_.writer()), flush(events_.writer().get()), flush(collisions_.writer().get());
    flush(journal_.writer().get()), flush(hashes_.writer().get());
    for (const dds_entity_t writer : catalogue_.writers()) flush(writer);
    flush(presence_.writer());
    trouble_.report();
}

}  // namespace plab::bus
