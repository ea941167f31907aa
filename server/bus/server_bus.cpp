#include "bus/server_bus.h"

#include <pthread.h>
#include <unistd.h>

#include <csignal>

#include "idl/values/limits.h"

namespace plab::bus
{
namespace
{

constexpr std::size_t kChanges = 1024;
/// The first plab-bus must join within this time.
constexpr std::chrono::seconds kLongestStart(10);

std::int64_t since_1970_ns()
{
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

Result<std::unique_ptr<ServerBus>> ServerBus::open(const BusOptions& options)
{
    if (!wire::is_server_name(options.name))
        return reason("'" + options.name + "' is not a valid server name: use 1 to 64 letters, digits, '.', '_' or '-'");
    auto lock = wire::NameLock::take(options.domain, options.name);
    if (!lock) return lock.errors();
    std::unique_ptr<ServerBus> bus(new ServerBus(options, lock.take()));
    if (bus->wake_.descriptor() < 0) return reason("cannot open the bus: no eventfd is available");
    auto first = bus->first_.get_future();
    // Signals belong to the daemon: none is delivered on this thread.
    sigset_t all, before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    bus->thread_ = std::thread([b = bus.get()] { b->run(); });
    (void)pthread_sigmask(SIG_SETMASK, &before, nullptr);
    (void)pthread_setname_np(bus->thread_.native_handle(), "plab-bus-link");
    // Batch: waking this thread does not preempt the step thread on the same core.
    const sched_param priority{};
    (void)pthread_setschedparam(bus->thread_.native_handle(), SCHED_BATCH, &priority);
    if (first.wait_for(kLongestStart) != std::future_status::ready) return reason("plab-bus did not join the bus within 10 s");
    if (auto joined = first.get(); !joined) return joined.errors();
    return bus;
}

ServerBus::ServerBus(const BusOptions& options, wire::NameLock lock)
    : options_(options), lock_(std::move(lock)), wake_(WakeEvent::make()), changes_(kChanges)
{
    start_ = {options.name, options.version, options.network_interface, options.domain,
              getpid(),     since_1970_ns(), options.ros.space,         options.ros.rate};
}

ServerBus::~ServerBus()
{
    stop_.store(true, std::memory_order_release);
    wake_.notify_once();
    if (thread_.joinable()) thread_.join();
}

template <class Function>
auto ServerBus::of(publish::Stream stream, Function function) const
{
    switch (stream)
    {
        case publish::Stream::Collisions:
            return function(collisions_);
        case publish::Stream::Events:
            return function(events_);
        case publish::Stream::Metrics:
            return function(metrics_);
        case publish::Stream::Images:
            return function(images_);
        case publish::Stream::Journal:
            return function(journal_);
        case publish::Stream::Hashes:
            return function(hashes_);
        case publish::Stream::Snapshots:
            return function(snapshots_);
        case publish::Stream::Forces:
            return function(forces_);
        case publish::Stream::Contacts:
            return function(contacts_);
        case publish::Stream::States:
            break;
    }
    return function(states_);
}

bool ServerBus::wants(publish::Stream stream) const
{
    return of(stream, [](const auto& s) { return s.wanted(); });
}

std::uint64_t ServerBus::joins(publish::Stream stream) const
{
    return of(stream, [](const auto& s) { return s.joins(); });
}

void ServerBus::end_frame()
{
    states_.end_push();
    wake_.notify_once();
}

void ServerBus::end_contacts()
{
    contacts_.end_push();
    wake_.notify_once();
}

void ServerBus::hash(std::uint64_t run, Tick step, std::uint64_t hash)
{
    if (auto record = hash_batch_.add(run, step, hash, publish::monotonic_now())) push(hashes_, *std::move(record));
}

void ServerBus::status(const wire::Server& status)
{
    // A paused run completes no batch; a status is sent at most ten times per second.
    if (auto record = status.paused ? hash_batch_.flush() : hash_batch_.flush_old(publish::monotonic_now()))
        push(hashes_, *std::move(record));
    statuses_.begin_push() = status;
    statuses_.end_push();
    wake_.notify_once();
}

bool ServerBus::catalogue(publish::CatalogueChange&& change)
{
    // A dropped change could never be made up for: this ring refuses new entries instead of dropping the oldest.
    if (changes_waiting_.load(std::memory_order_acquire) >= kChanges) return false;
    changes_waiting_.fetch_add(1, std::memory_order_relaxed);
    changes_.begin_push() = std::move(change);
    changes_.end_push();
    wake_.notify_once();
    return true;
}

void ServerBus::answer(wire::Reply&& answer)
{
    desk_.answer(std::move(answer));
    wake_.notify_once();
}

std::string ServerBus::lost() const { return is_lost_.load(std::memory_order_acquire) ? why_lost_ : std::string(); }

std::string ServerBus::take_restart()
{
    if (!restarted_.load(std::memory_order_relaxed)) return {};
    // The step thread never waits: an entry that is being written becomes available at the next step.
    const std::unique_lock guard(restart_mutex_, std::try_to_lock);
    if (!guard.owns_lock()) return {};
    restarted_.store(false, std::memory_order_relaxed);
    return std::exchange(restart_, {});
}

}  // namespace plab::bus
