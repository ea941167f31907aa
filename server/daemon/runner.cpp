#include "daemon/runner.h"

#include <spdlog/spdlog.h>

#include <cinttypes>
#include <fstream>
#include <optional>
#include <set>

#include "daemon/live_table.h"
#include "daemon/output.h"
#include "daemon/overseer.h"
#include "daemon/pacer.h"
#include "daemon/trace.h"
#include "program/interruption.h"
#include "simulation/costs/clock.h"

namespace plab::daemon
{
namespace
{

using Clock = std::chrono::steady_clock;

/// Interval at which a paused server publishes its status.
constexpr std::chrono::seconds kHeartbeat(1);
/// Clock, rate and overload are checked at this interval, not at each step.
constexpr std::chrono::milliseconds kStatus(100);

void report_events(const simulation::Simulation& s)
{
    for (const Event& e : s.events())
    {
        const auto level = e.severity == Severity::Failure   ? spdlog::level::err
                           : e.severity == Severity::Warning ? spdlog::level::warn
                                                             : spdlog::level::debug;
        if (spdlog::should_log(level)) spdlog::log(level, "t = {:.9f}  {}", e.time, event_text(s, e));
    }
}

/// Shared objects of this process, one per line (Linux: /proc/self/maps).
void print_mapped_libraries()
{
    std::ifstream maps("/proc/self/maps");
    std::set<std::string> libraries;
    for (std::string line; std::getline(maps, line);)
        if (const std::size_t path = line.find('/'); path != std::string::npos && line.find(".so", path) != std::string::npos)
            libraries.insert(line.substr(path));
    for (const std::string& library : libraries) std::printf("%s\n", library.c_str());
}

std::string footer(const DaemonOptions& options)
{
    if (!options.bus) return {};
    const std::string ctl = options.name == "plab" ? "plabctl" : "plabctl --server " + options.name;
    return "second terminal: " + ctl + " interactions; " + ctl + " swap ID --to TYPE; " + ctl + " --help     Ctrl-C ends";
}

/// One run of plabd: the data of its main loop.
class Run
{
public:
    Run(simulation::Simulation& simulation, Service& service, const DaemonOptions& options, const Wake& wake, const std::atomic<bool>& stop)
        : s_(simulation), service_(service), options_(options), wake_(wake), stop_(stop), table_(options.table, footer(options))
    {
    }

    int go();

private:
    Result<void> open_trace();
    void begin();
    bool is_at_end() const { return options_.until >= 0 && s_.time() >= options_.until - 0.5 * s_.dt(); }
    bool over() const { return stop_ || s_.gave_up() || service_.shutdown_wanted() || is_at_end(); }
    /// A signal is the ordinary end of a server. A run with an end time of its own did not reach it.
    bool is_cut() const { return stop_ && options_.until >= 0 && !is_at_end(); }
    bool serve();
    void step();
    void report_rate(Clock::time_point now);
    void report_given_up();
    bool save();
    bool finish();

    simulation::Simulation& s_;
    Service& service_;
    const DaemonOptions& options_;
    const Wake& wake_;
    const std::atomic<bool>& stop_;
    std::unique_ptr<Trace> trace_;
    LiveTable table_;
    Pacer pacer_;
    RateMeter meter_;
    Clock::time_point logged_at_{}, status_{};
    bool shown_paused_ = false;
    std::uint64_t shown_answers_ = 0;
    double logged_slip_ = 0;
    bool fine_ = true;
};

Result<void> Run::open_trace()
{
    if (options_.trace.empty()) return {};
    auto opened = Trace::open(options_.trace, s_, options_.every);
    if (!opened) return opened.errors();
    trace_ = opened.take();
    trace_->sample(s_);
    return {};
}

void Run::begin()
{
    simulation::Request clock;
    // Without an end time it is a server whose clients live in real time; with one, it is a batch computation.
    clock.operations.push_back(simulation::RateOperation{options_.rate >= 0 ? options_.rate : options_.until >= 0 ? 0.0 : 1.0});
    // A snapshot of a paused run continues: without a bus, no client could resume it.
    if (options_.paused)
        clock.operations.push_back(simulation::PauseOperation{});
    else
        clock.operations.push_back(simulation::ResumeOperation{});
    (void)s_.carry_out_now(clock);
    for (const ScheduledOperation& op : options_.operations)
    {
        simulation::Request request;
        request.operations.push_back(op.operation);
        request.at = op.at;
        service_.post(std::move(request));
    }
    service_.publish(false);
}

/// Carries out requests that are due; true if there were any, or if one requests the shutdown.
bool Run::serve()
{
    service_.take_requests();
    // A server that is to end does not wait first, even if it is paused.
    const bool any = s_.apply_due();
    service_.show_scene();
    if (!any) return service_.shutdown_wanted();
    // The catalogue goes first, so that a client that has the reply can rely on it.
    service_.publish(false);
    fine_ = service_.answer() && fine_;
    return true;
}

void Run::step()
{
    service_.take_people();
    service_.prepare();
    if (!s_.step())
    {
        if (s_.gave_up()) report_given_up();
        return;
    }
    if (options_.hashes) std::printf("%" PRId64 " %016" PRIx64 "\n", s_.tick(), s_.state_hash());
    report_events(s_);
    service_.note_own_requests();
    service_.publish(true);
    if (trace_) trace_->sample(s_);
    table_.note(s_);
    table_.show(s_);
}

void Run::report_rate(Clock::time_point now)
{
    const bool changed = s_.paused() != shown_paused_ || service_.answered() != shown_answers_;
    if (!changed && now - status_ < kStatus) return;
    status_ = now, shown_paused_ = s_.paused(), shown_answers_ = service_.answered();
    meter_.sample(s_.time(), s_.run(), now);
    service_.publish_status(meter_.factor(), pacer_.slipped(), pacer_.slipping(now));
    if (pacer_.slipped() == logged_slip_ || now - logged_at_ < std::chrono::seconds(1)) return;
    logged_at_ = now, logged_slip_ = pacer_.slipped();
    spdlog::warn("too slow for the rate: {:.3f} s of real time lost so far", logged_slip_);
}

/// The run ends at the state before the step; if a shutdown request caused this, it is answered.
void Run::report_given_up()
{
    const publish::Busy busy = publish::words_of(s_.progress().read(), simulation::now_ns());
    spdlog::error("{}: abandoned, because the run is to end; the state is that of t = {:.9g} s, before the step", publish::text_of(busy),
                  s_.time());
    service_.take_last_requests(kGrace);
}

/// Requests that still wait are saved with the snapshot. True if a snapshot was made.
bool Run::save()
{
    if (options_.save.empty()) return false;
    const auto saved = service_.save(options_.save);
    if (!saved) spdlog::error("{}", saved.error().text());
    fine_ = fine_ && saved;
    return static_cast<bool>(saved);
}

bool Run::finish()
{
    table_.show(s_, true);
    if (trace_) trace_->sample(s_, true);
    if (options_.maps) print_mapped_libraries();
    // Clients whose requests are being read get an answer, too.
    service_.take_last_requests(kGrace);
    const bool saved = save();
    if (const std::size_t own = service_.close(); own > 0 && !saved)
    {
        spdlog::error("{} requests did not take effect: the run did not reach their step", own);
        fine_ = false;
    }
    if (const std::string why = service_.lost(); !why.empty())
    {
        spdlog::error("{}", why);
        fine_ = false;
    }
    fine_ = service_.close_recording() && fine_;
    if (!options_.out.empty()) fine_ = write_end_state(s_, options_.out) && fine_;
    return fine_;
}

int Run::go()
{
    if (auto opened = open_trace(); !opened)
    {
        spdlog::error("{}", opened.error().reason);
        return 1;
    }
    std::optional<Overseer> overseer;
    if (options_.table) overseer.emplace(s_.progress(), [this](const publish::Busy& busy) { table_.show_busy(busy); });
    begin();
    while (!over() && service_.lost().empty())
    {
        if (serve()) continue;
        const auto now = Clock::now();
        report_rate(now);
        if (s_.paused())
        {
            pacer_.stand_still();
            table_.show(s_);
            service_.idle();
            (void)wake_.wait_until(now + kHeartbeat);
            continue;
        }
        // Requests are served while the next step is not due yet: they do not wait for the clock, only for a running step.
        const auto due = pacer_.due(s_.time() + s_.dt(), s_.rate(), s_.run(), now);
        if (due > now && (wake_.wait_until(due) || Clock::now() < due))
        {
            service_.idle();
            continue;
        }
        step();
    }
    overseer.reset();
    if (!finish()) return 1;
    if (!is_cut()) return s_.gave_up() ? kExitGaveUp : 0;
    spdlog::warn("interrupted by {} at t = {:.9g} s, step {}: --until {:.9g} was not reached, and the files end there",
                 program::name_of_interruption(), s_.time(), s_.tick(), options_.until);
    return program::code_of_interruption();
}

}  // namespace

int run(simulation::Simulation& simulation, Service& service, const DaemonOptions& options, const Wake& wake, const std::atomic<bool>& stop)
{
    return Run(simulation, service, options, wake, stop).go();
}

}  // namespace plab::daemon
