/// The work of the thread that communicates with plab-bus.
#include <poll.h>

#include <algorithm>

#include "bus/request_check.h"
#include "bus/server_bus.h"

namespace plab::bus
{
namespace
{

using std::chrono::milliseconds;

constexpr std::size_t kBurst = 64;  ///< records of one stream before the others get their turn
constexpr int kMostMessages = 256;  ///< messages from plab-bus before other work gets its turn
constexpr milliseconds kSecond(1000);
constexpr milliseconds kSettling(1000);  ///< time for readers to find a new plab-bus before their streams count as unwanted
constexpr milliseconds kGoodbye(2000), kLastWords(1000), kHangUp(100), kBusyCheck(500);
/// The longest delay is below the lease after which readers consider a participant lost (10 s), so that the next process joins
/// before that.
constexpr milliseconds kFirstDelay(50), kLongestDelay(5000);
constexpr std::chrono::seconds kGoodLife(30);  ///< a process that lived for this long is restarted at once
constexpr int kLongestSilence = 4;             ///< s; deleting a writer that a reader does not acknowledge blocks plab-bus for one second
constexpr milliseconds kStopped(100);          ///< number of checks: two processes stopped together resume at about the same time
constexpr int kMostStopped = 2;  ///< number of these checks: if both processes are stopped, they are continued at about the same time

/// Makes text of another process safe for a log: no control characters, at most one line.
std::string one_line(std::string text)
{
    constexpr std::size_t kLongest = 300;
    if (text.size() > kLongest) text.resize(kLongest), text += " ...";
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return is_utf8(text) ? text : "(no text)";
}

template <class T>
bool decode(const MessageReader::Message& message, T& out)
{
    Decoder decoder(message.bytes);
    decoder.get(out);
    return decoder.whole();
}

}  // namespace

void ServerBus::run()
{
    while (!stop_.load(std::memory_order_acquire))
    {
        const Clock::time_point now = Clock::now();
        supervise(now);
        if (pass(now)) continue;
        const Clock::duration next = process_ ? (process_->stopped() ? kStopped : kBusyCheck) : start_at_ - now;
        sleep(std::min<Nanoseconds>(next, kBusyCheck));
        wake_.acknowledge();
    }
    say_goodbye();
    if (!was_first_received_) first_.set_value(reason("the bus was closed"));
}

void ServerBus::sleep(Nanoseconds longest)
{
    std::array<pollfd, 2> watched{pollfd{wake_.descriptor(), POLLIN, 0}, pollfd{process_ ? process_->lifeline() : -1, POLLIN, 0}};
    timespec time{};
    time.tv_sec = longest.count() / 1'000'000'000, time.tv_nsec = longest.count() % 1'000'000'000;
    has_hung_up_ = ppoll(watched.data(), watched.size(), &time, nullptr) > 0 && watched[1].revents != 0;
}

void ServerBus::supervise(Clock::time_point now)
{
    if (process_)
    {
        watch(now);
        if (is_broken_) return end_process("sent an invalid message", now);
        if (silent_ > kLongestSilence) return end_process("sent nothing for " + std::to_string(kLongestSilence) + " s", now);
        // Its socket is closed but it still runs: end it, since this thread would no longer sleep.
        if (std::exchange(has_hung_up_, false) && !process_->wait(kHangUp)) return end_process("closed its connection", now);
        if (const std::string how = process_->ended(); !how.empty())
        {
            (void)receive(now);  // its last messages
            end_process(how, now);
        }
        else if (was_stopped(now))
            end_process("was stopped", now);
        return;
    }
    if (now < start_at_) return;
    auto started = BusProcess::start(bus_program(options_.ros.enabled), wake_, start_);
    if (!started)
    {
        end_process("could not be started: " + started.error().reason, now);
        return;
    }
    process_ = started.take();
    pid_.store(process_->pid(), std::memory_order_relaxed);
    started_ = heard_ = stopped_ = now, silent_ = stopped_checks_ = 0;
    has_joined_ = is_broken_ = false, failed_.clear();
}

/// A plab-bus that hangs serves no client. Only seconds in which this thread was awake count, because it may have been stopped
/// as well.
void ServerBus::watch(Clock::time_point now)
{
    if (now - heard_ < kSecond) return;
    heard_ = now, ++silent_;
}

/// A stopped process cannot be expected to continue; the checks count like the seconds above.
bool ServerBus::was_stopped(Clock::time_point now)
{
    if (!process_->stopped())
        stopped_checks_ = 0, stopped_ = now;
    else if (now - stopped_ >= kStopped)
        ++stopped_checks_, stopped_ = now;
    return stopped_checks_ > kMostStopped;
}

void ServerBus::end_process(const std::string& why, Clock::time_point now)
{
    const std::string text = failed_.empty() ? why : failed_;
    if (!was_first_received_)
    {
        // It never joined: open() reports the reason, and there is no retry.
        first_.set_value(reason(text));
        was_first_received_ = true, start_at_ = Clock::time_point::max();
        process_.reset();
        return;
    }
    const bool had_joined = has_joined_;
    const std::string name = process_ ? "plab-bus (process " + std::to_string(process_->pid()) + ")" : "plab-bus";
    process_.reset();
    pid_.store(0, std::memory_order_relaxed);
    has_joined_ = is_broken_ = false;
    // A process that ends repeatedly is restarted after increasing delays.
    if (had_joined && now - started_ >= kGoodLife) delay_ = {};
    delay_ = std::clamp<Clock::duration>(2 * delay_, kFirstDelay, kLongestDelay);
    start_at_ = now + delay_;
    if (why_restarted_.empty()) died_ = now;
    why_restarted_ = name + " " + text;
    log(why_restarted_ + ": it will be restarted in " + std::to_string(std::chrono::duration_cast<milliseconds>(delay_).count()) + " ms");
}

/// The current plab-bus has joined: send it everything that clients may rely on. This needs nothing from the step thread.
void ServerBus::begin_anew(Clock::time_point now)
{
    has_joined_ = true;
    if (!was_first_received_)
    {
        first_.set_value({});
        was_first_received_ = true;
        return;
    }
    is_new_ = true, started_ = now;
    each([](auto& feed) { feed.begin_anew(); });
    if (!mirror_.empty()) is_broken_ = !process_->writer().send(Down::Catalogue, mirror_.everything());
    status_is_new_ = has_status_;
    const auto away = std::chrono::duration_cast<milliseconds>(now - died_).count();
    {
        const std::lock_guard guard(restart_mutex_);
        restart_ = one_line(std::exchange(why_restarted_, {})) + "; process " + std::to_string(process_->pid()) + " replaced it after " +
                   std::to_string(away) + " ms";
        restarted_.store(true, std::memory_order_relaxed);
    }
    wake();
}

bool ServerBus::pass(Clock::time_point now)
{
    const bool more = process_ && receive(now);
    if (!has_joined_)
        while (next_change([](const auto&) {})) continue;
    if (!has_joined_ || is_broken_) return is_broken_;
    return send(now) || more || is_broken_;
}

bool ServerBus::receive(Clock::time_point now)
{
    MessageReader::Message message;
    for (int i = 0; i < kMostMessages && !is_broken_; ++i)
    {
        // If plab-bus sends requests but does not take data, do not receive from it; the silence limit then ends it. The status
        // of a new process is received, since it gets its answers only after that.
        if (has_joined_ && desk_.is_full()) return false;
        const auto state = process_->reader().next(message);
        is_broken_ = state == MessageReader::State::Broken;
        if (state == MessageReader::State::Whole) handle(message, now);
        if (process_->reader().made_room()) process_->notify();
        if (state == MessageReader::State::Nothing) return false;
    }
    return true;
}

void ServerBus::handle(const MessageReader::Message& message, Clock::time_point now)
{
    heard_ = now, silent_ = 0;
    std::string text;
    switch (static_cast<Up>(message.kind))
    {
        case Up::Joined:
            if (has_joined_) break;
            return begin_anew(now);
        case Up::Failed:
            if (!decode(message, text)) break;
            failed_ = one_line(text);
            return;
        case Up::Wants:
        {
            WantsMessage wants;
            if (!decode(message, wants)) break;
            return note_wants(wants);
        }
        case Up::Request:
        {
            RequestMessage request;
            if (!decode(message, request)) break;
            const auto received =
                desk_.receive(std::move(request), std::chrono::duration_cast<Nanoseconds>(now.time_since_epoch()).count());
            if (received.is_shutdown && options_.end != nullptr) options_.end(options_.end_argument);
            if (received.is_new) wake();
            return;
        }
        case Up::Lost:
            if (!decode(message, text)) break;
            if (is_lost_.load(std::memory_order_relaxed)) return;
            why_lost_ = one_line(text);
            is_lost_.store(true, std::memory_order_release);
            return wake();
        case Up::Log:
            if (!decode(message, text)) break;
            if (!log_limit_.may(now)) return;
            text = one_line(std::move(text));
            if (const std::uint64_t n = log_limit_.left_out(); n > 0) text += " (and " + std::to_string(n) + " more lines)";
            return log(text);
        case Up::Alive:
            return;
        case Up::User:
        {
            UserMessage user;
            if (!decode(message, user)) break;
            return people_.receive(std::move(user), std::chrono::duration_cast<Nanoseconds>(now.time_since_epoch()).count());
        }
        case Up::Viewer:
        {
            ViewerMessage viewer;
            if (!decode(message, viewer)) break;
            return people_.receive(std::move(viewer), std::chrono::duration_cast<Nanoseconds>(now.time_since_epoch()).count());
        }
    }
    is_broken_ = true;
}

void ServerBus::note_wants(const WantsMessage& wants)
{
    bool came = false;
    each([&](auto& feed) { came = feed.receive(wants, !is_new_) || came; });
    if (came) wake();
}

template <class Function>
void ServerBus::each(Function function)
{
    function(events_), function(collisions_), function(states_), function(metrics_), function(journal_), function(hashes_),
        function(snapshots_), function(images_), function(forces_), function(contacts_);
}

bool ServerBus::send(Clock::time_point now)
{
    if (is_new_ && now - started_ >= kSettling)
    {
        is_new_ = false;
        each([](auto& feed) { feed.forget(); });
    }
    MessageWriter& to = process_->writer();
    if (!to.flush()) is_broken_ = true;
    send_catalogue();
    send_status(now);
    send_answers();
    bool more = false;
    each(
        [&](auto& feed)
        {
            if (is_broken_) return;
            using Of = std::remove_reference_t<decltype(feed)>;
            constexpr bool kIsLarge = std::is_same_v<Of, Feed<wire::Image>> || std::is_same_v<Of, Feed<wire::Snapshot>>;
            const Sent done = feed.send(kIsLarge ? 1 : kBurst, to, is_new_);
            is_broken_ = done == Sent::Broken;
            more = more || done == Sent::More;
        });
    if (to.committed()) process_->notify();
    return more && to.ready();
}

/// The status comes from the step thread; its current activity is added when it has sent nothing for long.
void ServerBus::send_status(Clock::time_point now)
{
    while (wire::Server* status = statuses_.begin_pop())
    {
        status_.status = *status, overload_ = status->overload, has_status_ = status_is_new_ = true;
        statuses_.end_pop();
    }
    const bool is_due = status_is_new_ || (has_status_ && now - status_sent_ >= kBusyCheck);
    if (!is_due || !process_->writer().ready() || is_broken_) return;
    std::string busy = options_.busy != nullptr ? options_.busy(options_.busy_argument) : std::string();
    status_sent_ = now;
    if (!status_is_new_ && busy.empty() && status_.status.overload == overload_) return;
    status_.status.overload = busy.empty() ? overload_ : std::move(busy);
    status_.dropped = {states_.dropped(),  collisions_.dropped(), events_.dropped(),    metrics_.dropped(), images_.dropped(),
                       journal_.dropped(), hashes_.dropped(),     snapshots_.dropped(), forces_.dropped(),  contacts_.dropped()};
    is_broken_ = !process_->writer().send(Down::Status, status_);
    status_is_new_ = false;
}

void ServerBus::send_catalogue()
{
    while (has_joined_ && process_->writer().ready() && !is_broken_)
        if (!next_change([this](const auto& change) { is_broken_ = !process_->writer().send(Down::Catalogue, change); })) return;
}

/// Records the next change in the mirror, and passes it to `f`. False if there is none.
template <class Function>
bool ServerBus::next_change(Function f)
{
    publish::CatalogueChange* const change = changes_.begin_pop();
    if (change == nullptr) return false;
    mirror_.apply(*change);
    f(*change);
    *change = {};
    changes_.end_pop();
    changes_waiting_.fetch_sub(1, std::memory_order_release);
    return true;
}

/// The catalogue is sent before the answer: a client that has the reply finds the effect of its request in the catalogue.
void ServerBus::send_answers()
{
    MessageWriter& to = process_->writer();
    std::uint64_t strays = 0;
    while (!is_broken_)
    {
        if (!answer_) answer_ = desk_.next_answer(strays);
        if (!answer_) break;
        send_catalogue();
        if (!to.ready() || is_broken_) break;
        is_broken_ = !to.send(Down::Answer, *answer_);
        answer_.reset();
    }
    if (strays > 0) log(std::to_string(strays) + " replies to requests that no client waits for were dropped");
}

void ServerBus::say_goodbye()
{
    if (!process_) return;
    // Whatever was handed over before the end is still sent.
    const Clock::time_point last = Clock::now() + kLastWords;
    for (Clock::time_point now = Clock::now(); has_joined_ && !is_broken_ && now < last; now = Clock::now())
    {
        if (!process_->ended().empty()) return;
        if (pass(now)) continue;
        if (process_->writer().ready()) break;
        sleep(milliseconds(10));
        wake_.acknowledge();
    }
    if (!is_broken_ && process_->writer().ready()) (void)process_->writer().send(Down::End);
    process_->notify();
    (void)process_->wait(kGoodbye);
    process_.reset();
}

void ServerBus::log(const std::string& line)
{
    if (options_.log != nullptr)
        options_.log(options_.log_argument, line.c_str());
    else
        (void)std::fprintf(stderr, "bus: %s\n", line.c_str());
}

}  // namespace plab::bus
