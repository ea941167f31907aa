#include "daemon/runner.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <cinttypes>
#include <fstream>
#include <set>
#include <thread>

#include "daemon/output.h"

namespace plab::daemon
{
namespace
{

using Clock = std::chrono::steady_clock;

void report_events(const simulation::Simulation& s)
{
    for (const Event& e : s.events())
    {
        const std::string who = e.component == kNoIndex ? "" : s.world().id_of(e.component);
        std::string text = e.kind + " " + who;
        if (e.a.valid() && e.b.valid()) text += " (" + s.world().id_of(e.a) + ", " + s.world().id_of(e.b) + ")";
        if (!e.message.empty()) text += ": " + e.message;
        const auto level = e.severity == Severity::Failure   ? spdlog::level::err
                           : e.severity == Severity::Warning ? spdlog::level::warn
                                                             : spdlog::level::debug;
        if (spdlog::should_log(level)) spdlog::log(level, "t = {:.9f}  {}", e.time, text);
    }
}

const char* word(simulation::Fate fate)
{
    switch (fate)
    {
        case simulation::Fate::Kept:
            return "kept";
        case simulation::Fate::Converted:
            return "converted";
        case simulation::Fate::Given:
            return "given";
        case simulation::Fate::Fresh:
            return "fresh";
        case simulation::Fate::Lost:
            return "lost";
    }
    return "";
}

/// False if a request was refused: a run that was asked for something else must not pass for it.
bool report_replies(simulation::Simulation& s)
{
    bool fine = true;
    for (const simulation::Reply& r : s.take_replies())
    {
        for (const Error& e : r.errors) spdlog::error("request refused at step {}: {}", r.step, e.text());
        fine = fine && r.done;
        for (const simulation::SwapReport& swap : r.swaps)
        {
            std::string fields;
            for (const simulation::FieldFate& f : swap.fields) fields += fmt::format(" {} {}", f.field, word(f.fate));
            spdlog::info("step {}: {} {} -> {}; pause {:.1f} us;{}", r.step, swap.id, swap.from, swap.to, r.pause_ns * 1e-3, fields);
            spdlog::info(
                "  first step: energy {:.9g} J -> {:.9g} J (old: {:.9g} J), error {:.3g} (old: {:.3g}), cost {:.1f} us (old: {:.1f} us)",
                swap.energy_before, swap.with_new.energy, swap.with_old.energy, swap.with_new.error, swap.with_old.error,
                swap.with_new.cost_ns * 1e-3, swap.with_old.cost_ns * 1e-3);
        }
    }
    return fine;
}

void post_operations(simulation::Simulation& s, const Options& options)
{
    std::uint64_t id = 0;
    for (const ScheduledOperation& op : options.operations)
    {
        simulation::Request request;
        request.id = ++id;
        request.operations.push_back(op.operation);
        request.at = op.at;
        s.post(std::move(request));
    }
}

/// Holds simulated time to real time. Too slow: it slips, and says so once a second, instead of chasing.
class Pacer
{
public:
    explicit Pacer(double rate) : rate_(rate), begin_(Clock::now()), told_(begin_) {}
    void wait(double simulated)
    {
        if (rate_ <= 0) return;
        const auto due =
            begin_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>((simulated + slipped_) / rate_));
        const auto now = Clock::now();
        if (now < due)
        {
            std::this_thread::sleep_until(due);
            return;
        }
        const double late = std::chrono::duration<double>(now - due).count();
        if (late < 0.1) return;
        slipped_ += late * rate_;
        if (now - told_ < std::chrono::seconds(1)) return;
        told_ = now;
        spdlog::warn("too slow for the rate: {:.3f} s slipped so far", slipped_);
    }

private:
    double rate_;
    double slipped_ = 0;  // simulated s
    Clock::time_point begin_, told_;
};

/// Redraws in place on a terminal, else a block each simulated second.
class Table
{
public:
    explicit Table(bool wanted) : wanted_(wanted), terminal_(isatty(STDOUT_FILENO) != 0) {}
    void show(const simulation::Simulation& s, bool last = false)
    {
        if (!wanted_) return;
        const auto now = Clock::now();
        const bool due = terminal_ ? now - shown_ > std::chrono::milliseconds(100) : s.time() >= next_;
        if (!due && !last) return;
        shown_ = now;
        while (next_ <= s.time()) next_ += 1.0;
        const std::string text = table_text(s);
        if (terminal_) std::fputs("\x1b[H\x1b[J", stdout);
        std::fputs(text.c_str(), stdout);
        std::fflush(stdout);
    }

private:
    bool wanted_, terminal_;
    Clock::time_point shown_{};
    double next_ = 0;
};

bool write_end_state(const simulation::Simulation& s, const std::string& file)
{
    const std::string text = end_state_json(s);
    if (file == "-") return std::fputs(text.c_str(), stdout) >= 0;
    std::FILE* f = std::fopen(file.c_str(), "w");
    const bool written = f && std::fputs(text.c_str(), f) >= 0;
    const bool closed = f && std::fclose(f) == 0;
    if (!written || !closed) spdlog::error("cannot write {}", file);
    return written && closed;
}

/// Shared objects of this process, a line each (Linux: /proc/self/maps).
void print_mapped_libraries()
{
    std::ifstream maps("/proc/self/maps");
    std::set<std::string> libraries;
    for (std::string line; std::getline(maps, line);)
        if (const std::size_t path = line.find('/'); path != std::string::npos && line.find(".so", path) != std::string::npos)
            libraries.insert(line.substr(path));
    for (const std::string& library : libraries) std::printf("%s\n", library.c_str());
}

}  // namespace

int run(simulation::Simulation& s, const Options& options, const std::atomic<bool>& stop)
{
    post_operations(s, options);
    std::unique_ptr<Trace> trace;
    if (!options.trace.empty())
    {
        auto opened = Trace::open(options.trace, s, options.every);
        if (!opened)
        {
            spdlog::error("{}", opened.error().reason);
            return 1;
        }
        trace = opened.take();
        trace->sample(s);
    }
    const double rate = options.rate >= 0 ? options.rate : (options.until >= 0 ? 0.0 : 1.0);
    Pacer pacer(rate);
    Table table(options.table);
    bool fine = true;
    // The end is a step, not a sum of steps: the last one is the nearest to --until.
    const auto last = options.until >= 0 ? static_cast<Tick>(options.until / s.dt() + 0.5) : std::numeric_limits<Tick>::max();
    while (!stop && s.tick() < last && (options.until < 0 || s.time() < options.until - 0.5 * s.dt()))
    {
        if (!s.step()) break;
        if (options.hashes) std::printf("%" PRId64 " %016" PRIx64 "\n", s.tick(), s.state_hash());
        report_events(s);
        fine = report_replies(s) && fine;
        if (trace) trace->sample(s);
        table.show(s);
        pacer.wait(s.time());
    }
    table.show(s, true);
    if (trace) trace->sample(s, true);
    if (options.maps) print_mapped_libraries();
    if (s.pending_requests() > 0)
    {
        spdlog::error("{} requests found no step to take effect at: the run did not reach it", s.pending_requests());
        fine = false;
    }
    if (!options.out.empty()) fine = write_end_state(s, options.out) && fine;
    return fine ? 0 : 1;
}

}  // namespace plab::daemon
