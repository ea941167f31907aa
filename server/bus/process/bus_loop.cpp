#include "bus/process/bus_loop.h"

#include <poll.h>

#include <algorithm>

#include "bus/process/request_read.h"
#include "idl/domain.h"

namespace plab::bus
{
namespace
{

constexpr std::chrono::seconds kSecond(1);
constexpr std::chrono::milliseconds kRetry(10), kGoodbye(200);
constexpr int kMostMessages = 256;  ///< messages of plabd before requests get their turn

/// A DDS listener, which sets a flag and the wake event.
struct Mark
{
    std::atomic<bool>* mark;
    WakeEvent* wake;
    void set() const { mark->store(true, std::memory_order_release), wake->notify_once(); }
};

struct ListenerDeleter
{
    void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};

wire::Identity identity_of(const StartMessage& start)
{
    wire::Identity self = wire::identify(start.name, start.version);
    self.process = start.process, self.started_ns = start.started_ns;
    return self;
}

}  // namespace

BusLoop::BusLoop(MessageReader reader, MessageWriter writer, WakeEvent& wake, const WakeEvent& server, int lifeline,
                 const StartMessage& start)
    : start_(start),
      wake_(&wake),
      server_(&server),
      lifeline_(lifeline),
      reader_(std::move(reader)),
      writer_(std::move(writer)),
      trouble_([](void* self, const char* line) { static_cast<BusLoop*>(self)->report(Up::Log, std::string(line)); }, this),
      catalogue_(start.name),
      presence_(identity_of(start)),
      outbox_([this](const wire::Reply& answer) { return replies_.write(reply_sample_.of(answer)); }, trouble_)
{
}

/// A message that finds no room is dropped: each is only a notice, except requests, which wait in the DDS reader until there is
/// room.
template <class... Record>
void BusLoop::report(Up kind, const Record&... record)
{
    if (writer_.ready()) (void)writer_.send(kind, record...);
}

template <class Function>
void BusLoop::each(Function function)
{
    function(publish::Stream::States, states_), function(publish::Stream::Collisions, collisions_);
    function(publish::Stream::Events, events_), function(publish::Stream::Metrics, metrics_);
    function(publish::Stream::Images, images_), function(publish::Stream::Journal, journal_);
    function(publish::Stream::Hashes, hashes_), function(publish::Stream::Snapshots, snapshots_);
    function(publish::Stream::Forces, forces_), function(publish::Stream::Contacts, contacts_);
}

bool BusLoop::join()
{
    const auto entered = enter();
    if (entered)
        dds_log_.gather(), report(Up::Joined);
    else
        report(Up::Failed, entered.error().text());
    server_->notify();
    return entered.ok();
}

Result<void> BusLoop::enter()
{
    auto participant = wire::join({start_.domain, start_.network_interface});
    if (!participant) return participant.errors();
    participant_ = participant.take();
    // Entities created from the participant inherit its listener, so no match and no sample can arrive before the listener is
    // set.
    const std::unique_ptr<dds_listener_t, ListenerDeleter> listener(dds_create_listener(this));
    (void)dds_lset_publication_matched_arg(
        listener.get(),
        [](dds_entity_t, const dds_publication_matched_status_t, void* self) {
            Mark{&static_cast<BusLoop*>(self)->matched_, static_cast<BusLoop*>(self)->wake_}.set();
        },
        this, false);
    (void)dds_lset_data_available_arg(
        listener.get(),
        [](dds_entity_t, void* self)
        {
            auto& loop = *static_cast<BusLoop*>(self);
            loop.people_arrived_.store(true, std::memory_order_release);
            Mark{&loop.arrived_, loop.wake_}.set();
        },
        this, false);
    if (const auto code = dds_set_listener(participant_.get(), listener.get()); code < 0)
        return wire::failed("cannot listen to the bus", code);

    auto publisher = wire::make_publisher(participant_, start_.name);
    if (!publisher) return publisher.errors();
    auto subscriber = wire::make_subscriber(participant_, start_.name);
    if (!subscriber) return subscriber.errors();
    publisher_ = publisher.take(), subscriber_ = subscriber.take();
    if (auto opened = catalogue_.open(participant_, publisher_); !opened) return opened;
    Result<void> all;
    const auto be = [&](publish::Stream stream, auto& out)
    {
        const bool by_scene = stream == publish::Stream::Collisions || stream == publish::Stream::Images;
        if (auto there = out.be(!by_scene, participant_, publisher_); !there) all = there;
    };
    each(be);
    if (!all) return all;
    // Create the writer first: a client that finds the reader and sends a request at once then has a writer to get its reply
    // from.
    auto replies = wire::DataWriter<plab_v2_Reply>::make(participant_, publisher_);
    if (!replies) return replies.errors();
    auto requests = wire::DataReader<plab_v2_Request>::make(participant_, subscriber_);
    if (!requests) return requests.errors();
    replies_ = replies.take(), requests_ = requests.take();
    if (auto opened = users_.open(participant_, subscriber_); !opened) return opened;
    if (auto opened = viewers_.open(participant_, subscriber_); !opened) return opened;
    return presence_.open(participant_, publisher_, subscriber_);
}

bool BusLoop::run()
{
    while (!is_over_)
    {
        const Clock::time_point now = Clock::now();
        const bool more = pass(now);
        if (writer_.committed()) server_->notify();
        if (!more && !is_over_ && !sleep(now)) return false;
    }
    say_goodbye();
    return true;
}

/// False if plabd has ended.
bool BusLoop::sleep(Clock::time_point now)
{
    auto longest = outbox_.empty() ? std::min<Clock::duration>(presence_.due_in(now), kSecond) : Clock::duration(kRetry);
    longest = std::min(longest, people_due_);
    const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(longest).count();
    timespec time{};
    time.tv_sec = ns / 1'000'000'000, time.tv_nsec = ns % 1'000'000'000;
    std::array<pollfd, 2> watched{pollfd{wake_->descriptor(), POLLIN, 0}, pollfd{lifeline_, POLLIN, 0}};
    (void)ppoll(watched.data(), watched.size(), &time, nullptr);
    wake_->acknowledge();
    return watched[1].revents == 0;
}

bool BusLoop::pass(Clock::time_point now)
{
    (void)writer_.flush();
    bool more = read_people(now);
    more = read_requests() || more;
    if (now - second_ >= kSecond) each_second(now);
    if (matched_.exchange(false, std::memory_order_acquire)) check_readers();
    more = receive() || more;
    presence_.send(now, dropped(), trouble_);
    outbox_.retry(now);
    return more;
}

void BusLoop::each_second(Clock::time_point now)
{
    second_ = now;
    matched_.store(true, std::memory_order_relaxed);
    trouble_.report();
    report_dds();
    report(Up::Alive);
}

/// One line per second, however many invalid packets arrive. A line that finds no room waits.
void BusLoop::report_dds()
{
    if (!writer_.ready()) return;
    const DdsLog::Said said = dds_log_.take();
    if (said.lines == 0) return;
    trouble_.say("DDS reports: " + said.last + (said.lines > 1 ? " (and " + std::to_string(said.lines - 1) + " more)" : ""));
}

bool BusLoop::receive()
{
    MessageReader::Message message;
    for (int i = 0; i < kMostMessages && !is_over_; ++i)
    {
        const auto state = reader_.next(message);
        if (reader_.made_room()) server_->notify();
        if (state == MessageReader::State::Nothing) return false;
        // plabd is of the same build: a message that cannot be decoded means that this process cannot continue.
        if (state == MessageReader::State::Broken || !handle(message)) std::abort();
    }
    return !is_over_;
}

bool BusLoop::handle(const MessageReader::Message& message)
{
    Decoder decoder(message.bytes);
    const auto kind = static_cast<Down>(message.kind);
    if (kind == Down::Catalogue)
    {
        publish::CatalogueChange change;
        decoder.get(change);
        catalogue_.apply(change, trouble_);
        follow_scene();
    }
    else if (kind == Down::Status)
    {
        StatusMessage status;
        decoder.get(status);
        ring_dropped_ = status.dropped;
        presence_.set(std::move(status.status));
        // Handle this at once: the messages that follow may depend on it.
        presence_.send(Clock::now(), dropped(), trouble_);
    }
    else if (kind == Down::Answer)
    {
        wire::Reply answer;
        decoder.get(answer);
        outbox_.send(answer, Clock::now());
    }
    else if (kind == Down::End)
        is_over_ = true;
    else if (message.kind >= static_cast<std::uint32_t>(Down::Stream))
        return stream(message.kind - static_cast<std::uint32_t>(Down::Stream), message.bytes);
    return decoder.whole();
}

bool BusLoop::stream(std::uint32_t stream, std::span<const std::byte> bytes)
{
    bool fine = stream < kStreams;
    each(
        [&](publish::Stream s, auto& out)
        {
            if (static_cast<std::uint32_t>(s) == stream) fine = out.write(bytes, trouble_);
        });
    return fine;
}

/// True if there are more. While plabd has no room for them, they wait in the reader, which keeps all samples.
bool BusLoop::read_requests()
{
    pass_on();
    if (!waiting_.empty() || !arrived_.exchange(false, std::memory_order_acquire)) return false;
    const auto handle = [&](const plab_v2_Request& request, const dds_sample_info_t& info)
    {
        if (info.valid_data) keep(request);
    };
    const dds_return_t n = requests_.take(handle, 1);
    (void)trouble_.check(wire::topic_of<plab_v2_Request>().name, n < 0 ? n : DDS_RETCODE_OK);
    if (n > 0) arrived_.store(true, std::memory_order_relaxed);
    if (const auto rival = presence_.find_rival()) report(Up::Lost, *rival);
    pass_on();
    return n > 0 && waiting_.empty();
}

/// True if there may be more.
bool BusLoop::read_people(Clock::time_point now)
{
    bool more = false;
    if (people_arrived_.exchange(false, std::memory_order_acquire))
    {
        const bool users = users_.read(trouble_), viewers = viewers_.read(trouble_);
        more = users || viewers;
    }
    if (more) people_arrived_.store(true, std::memory_order_relaxed);
    people_due_ = std::min(users_.pass_on(writer_, now), viewers_.pass_on(writer_, now));
    return more;
}

void BusLoop::keep(const plab_v2_Request& request)
{
    RequestMessage& message = waiting_.emplace_back();
    auto read = read_request(request);
    if (read)
        message.request = read.take();
    else
    {
        message.request.client = client_of(request), message.request.number = request.number;
        message.wrong = read.error().reason;
    }
}

void BusLoop::pass_on()
{
    for (; !waiting_.empty() && writer_.ready(); waiting_.pop_front()) (void)writer_.send(Up::Request, waiting_.front());
}

void BusLoop::check_readers()
{
    WantsMessage wants;
    bool changed = false;
    each(
        [&](publish::Stream s, auto& out)
        {
            changed = out.check_readers() || changed;
            wants.wanted[static_cast<std::size_t>(s)] = out.wanted() ? 1 : 0;
            wants.joins[static_cast<std::size_t>(s)] = out.joins();
        });
    if (!changed) return;
    if (writer_.ready())
        (void)writer_.send(Up::Wants, wants);
    else
        matched_.store(true, std::memory_order_relaxed);
}

void BusLoop::follow_scene()
{
    const auto follow = [&](auto& stream, const char* prefix)
    {
        if (auto done = stream.be(catalogue_.has_type_below(prefix), participant_, publisher_); !done) trouble_.say(done.error().text());
    };
    follow(collisions_, "CDetection/");
    follow(images_, "Camera/");
    // A deleted writer has no readers any more, and nothing else reports that.
    check_readers();
}

std::vector<wire::DroppedSamples> BusLoop::dropped() const
{
    std::vector<wire::DroppedSamples> out;
    const_cast<BusLoop*>(this)->each(
        [&](publish::Stream s, auto& stream)
        {
            const std::uint64_t samples = ring_dropped_[static_cast<std::size_t>(s)] + trouble_.lost(stream.topic());
            if (samples > 0) out.push_back({stream.topic(), samples});
        });
    return out;
}

void BusLoop::say_goodbye()
{
    const Clock::time_point retried = Clock::now();
    outbox_.retry(retried);
    catalogue_.dispose_all(trouble_);
    presence_.dispose(trouble_);
    const Clock::time_point end = Clock::now() + kGoodbye;
    const auto flush = [&](dds_entity_t writer)
    {
        const std::chrono::nanoseconds left = end - Clock::now();
        // A reader that does not acknowledge must not delay the end: samples that have not arrived by then are lost for it.
        if (writer > 0 && left.count() > 0) (void)dds_wait_for_acks(writer, left.count());
    };
    flush(replies_.entity().get()), flush(events_.writer().get()), flush(collisions_.writer().get());
    flush(journal_.writer().get()), flush(hashes_.writer().get());
    for (const dds_entity_t writer : catalogue_.writers()) flush(writer);
    flush(presence_.writer());
}

}  // namespace plab::bus
