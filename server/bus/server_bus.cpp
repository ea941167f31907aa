#include "bus/server_bus.h"

#include <pthread.h>

#include <csignal>

#include "idl/domain.h"

namespace plab::bus
{
namespace
{

constexpr std::size_t kChanges = 1024;  ///< of the catalogue, that may wait

struct ListenerDeleter
{
    void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};

/// What a listener of DDS does, on a thread of DDS: leave a mark and ring.
struct Bell
{
    std::atomic<bool>* mark;
    publish::WakeUp* wake_up;
    void ring() const
    {
        mark->store(true, std::memory_order_release);
        wake_up->ring();
    }
};

}  // namespace

Result<std::unique_ptr<ServerBus>> ServerBus::open(const BusOptions& options)
{
    if (!wire::is_server_name(options.name))
        return reason("'" + options.name + "' is no name of a server: 1 to 64 letters, digits, '.', '_' or '-'");
    auto lock = wire::NameLock::take(options.domain, options.name);
    if (!lock) return lock.errors();
    std::unique_ptr<ServerBus> bus(new ServerBus(options, lock.take()));
    if (auto joined = bus->join(); !joined) return joined.errors();
    bus->start();
    return bus;
}

ServerBus::ServerBus(const BusOptions& options, wire::NameLock lock)
    : options_(options),
      lock_(std::move(lock)),
      trouble_(options.log, options.log_argument),
      changes_(kChanges),
      catalogue_(options.name),
      presence_(wire::identify(options.name, options.version)),
      desk_(trouble_)
{
}

Result<void> ServerBus::join()
{
    auto participant = wire::join({options_.domain, options_.network_interface});
    if (!participant) return participant.errors();
    participant_ = participant.take();
    // What is created from the participant inherits its listener: no match and no sample comes before it.
    const std::unique_ptr<dds_listener_t, ListenerDeleter> listener(dds_create_listener(this));
    (void)dds_lset_publication_matched_arg(
        listener.get(),
        [](dds_entity_t, const dds_publication_matched_status_t, void* self) {
            Bell{&static_cast<ServerBus*>(self)->matched_, &static_cast<ServerBus*>(self)->wake_up_}.ring();
        },
        this, false);
    (void)dds_lset_data_available_arg(
        listener.get(),
        [](dds_entity_t, void* self) {
            Bell{&static_cast<ServerBus*>(self)->arrived_, &static_cast<ServerBus*>(self)->wake_up_}.ring();
        },
        this, false);
    if (const auto code = dds_set_listener(participant_.get(), listener.get()); code < 0)
        return wire::failed("cannot listen to the bus", code);

    auto publisher = wire::make_publisher(participant_, options_.name);
    if (!publisher) return publisher.errors();
    auto subscriber = wire::make_subscriber(participant_, options_.name);
    if (!subscriber) return subscriber.errors();
    publisher_ = publisher.take(), subscriber_ = subscriber.take();
    if (auto opened = catalogue_.open(participant_, publisher_); !opened) return opened;
    if (auto opened = states_.be(true, participant_, publisher_); !opened) return opened;
    if (auto opened = events_.be(true, participant_, publisher_); !opened) return opened;
    if (auto opened = metrics_.be(true, participant_, publisher_); !opened) return opened;
    if (auto opened = journal_.be(true, participant_, publisher_); !opened) return opened;
    if (auto opened = hashes_.be(true, participant_, publisher_); !opened) return opened;
    if (auto opened = snapshots_.be(true, participant_, publisher_); !opened) return opened;
    if (auto opened = desk_.open(participant_, publisher_, subscriber_); !opened) return opened;
    return presence_.open(participant_, publisher_, subscriber_);
}

void ServerBus::start()
{
    // Signals are the daemon's: none is delivered on this thread.
    sigset_t all, before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] { run(); });
    (void)pthread_sigmask(SIG_SETMASK, &before, nullptr);
    (void)pthread_setname_np(thread_.native_handle(), "plab-bus");
    // Batch: it does not push the step thread aside when it is woken on the same core.
    const sched_param priority{};
    (void)pthread_setschedparam(thread_.native_handle(), SCHED_BATCH, &priority);
}

ServerBus::~ServerBus()
{
    stop_.store(true, std::memory_order_release);
    wake_up_.ring();
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
    wake_up_.ring();
}

void ServerBus::collisions(publish::Batch<publish::CollisionRecord>&& batch)
{
    collisions_.begin_push() = std::move(batch);
    collisions_.end_push();
    wake_up_.ring();
}

void ServerBus::events(publish::Batch<publish::EventRecord>&& batch)
{
    events_.begin_push() = std::move(batch);
    events_.end_push();
    wake_up_.ring();
}

void ServerBus::metrics(publish::Metrics&& metrics)
{
    metrics_.begin_push() = std::move(metrics);
    metrics_.end_push();
    wake_up_.ring();
}

void ServerBus::image(publish::Image&& image)
{
    images_.begin_push() = std::move(image);
    images_.end_push();
    wake_up_.ring();
}

void ServerBus::journal(publish::JournalRecord&& entry)
{
    journal_.begin_push() = std::move(entry);
    journal_.end_push();
    wake_up_.ring();
}

void ServerBus::hash(std::uint64_t run, Tick step, std::uint64_t hash) { push(hash_batch_.add(run, step, hash, publish::monotonic_now())); }

void ServerBus::push(std::optional<publish::HashRecord> record)
{
    if (!record) return;
    hashes_.begin_push() = *std::move(record);
    hashes_.end_push();
    wake_up_.ring();
}

void ServerBus::snapshot(publish::SnapshotRecord&& snapshot)
{
    snapshots_.begin_push() = std::move(snapshot);
    snapshots_.end_push();
    wake_up_.ring();
}

void ServerBus::status(const publish::Status& status)
{
    // A run that stands still completes no batch; a status comes ten times a second at most.
    push(status.paused ? hash_batch_.flush() : hash_batch_.flush_old(publish::monotonic_now()));
    presence_.push(status);
    wake_up_.ring();
}

bool ServerBus::catalogue(publish::CatalogueChange&& change)
{
    // A change that is left out would never be made good: this ring refuses instead of giving up the oldest.
    if (changes_waiting_.load(std::memory_order_acquire) >= kChanges) return false;
    changes_waiting_.fetch_add(1, std::memory_order_relaxed);
    changes_.begin_push() = std::move(change);
    changes_.end_push();
    wake_up_.ring();
    return true;
}

void ServerBus::answer(publish::Answer&& answer)
{
    desk_.answer(std::move(answer));
    wake_up_.ring();
}

std::string ServerBus::lost() const { return is_lost_.load(std::memory_order_acquire) ? why_lost_ : std::string(); }

}  // namespace plab::bus
