#include "daemon/replaying.h"

#include <spdlog/spdlog.h>

#include <cinttypes>
#include <cstdio>
#include <limits>

#include "control/component_requests.h"
#include "daemon/ending.h"
#include "daemon/output.h"
#include "daemon/recording.h"
#include "daemon/trace.h"
#include "model/numbers.h"
#include "program/interruption.h"
#include "program/progress.h"
#include "replay/replay.h"
#include "simulation/snapshot/build.h"

namespace plab::daemon
{
namespace
{

/// The build that made the recording: from the file, or from the first snapshot if it was recorded from the bus. "": unknown.
std::string build_of(record::RunLog& log, model::TypeSource& types)
{
    if (std::string build = log.origin("build"); !build.empty()) return build;
    if (log.snapshots().empty()) return {};
    const auto first = log.read(log.snapshots().front());
    if (!first) return {};  // the replay reports why, if it needs this one
    const auto decoded = simulation::decode(first->data, types);
    return decoded ? decoded->build : std::string();
}

void warn_of_another_build(record::RunLog& log, model::TypeSource& types)
{
    const std::string theirs = build_of(log, types), ours = simulation::build_name();
    if (!theirs.empty() && theirs != ours)
        spdlog::warn("recorded by a different build: digits may differ\n  recorded: {}\n  this one: {}", theirs, ours);
}

/// An error if --from names a step that no run has; otherwise "".
std::string beyond_the_end(const replay::ReplayReport& report, const DaemonOptions& options)
{
    if (!options.replay.from || report.mismatch) return {};
    std::string ends;
    for (const replay::ReplayedRun& r : report.made)
    {
        if (r.last >= *options.replay.from) return {};
        ends += (ends.empty() ? "" : ", ") + std::string("of run ") + std::to_string(r.run) + " it is " + std::to_string(r.last);
    }
    return "--from " + std::to_string(*options.replay.from) + " is beyond the " +
           (options.until >= 0 ? "last step until --until" : "last step") + ": " + ends;
}

/// Why no hash was compared.
std::string why_nothing(const record::RunLog& log, const replay::ReplayReport& report, const DaemonOptions& options)
{
    if (report.steps > 0) return "the recording has no hashes of these steps";
    if (const std::string topics = log.origin("topics"); !topics.empty() && topics.find("plab/hashes") == std::string::npos)
        return "the recording was made without plab/hashes, so the length of the run is not known";
    if (report.made.empty()) return "no run was started";
    const replay::ReplayedRun& last = report.made.back();
    if (options.until >= 0 && last.time >= options.until)
        return "--until " + model::format_real(options.until) + " ends where the recording begins";
    return "the recording ends at step " + std::to_string(last.last) + ", where it begins";
}

/// An interrupted replay is not verified.
void print_how_far(const replay::ReplayReport& report, const DaemonOptions& options)
{
    if (report.made.empty())
        std::printf("interrupted by %s before the first step", program::name_of_interruption().c_str());
    else
        std::printf("interrupted by %s after step %" PRId64 " of run %" PRIu64, program::name_of_interruption().c_str(),
                    report.made.back().last, report.made.back().run);
    if (options.replay.verify)
        std::printf(": NOT VERIFIED; %" PRId64 " state hashes were identical until then\n", report.verified);
    else
        std::printf(": the rest was not replayed\n");
}

void print_report(const replay::ReplayReport& report, const DaemonOptions& options)
{
    std::printf("%s: %" PRIu64 " run%s, %" PRId64 " steps replayed, %" PRIu64 " requests\n", options.replay.file.c_str(), report.runs,
                report.runs == 1 ? "" : "s", report.steps, report.requests);
    if (report.interrupted) print_how_far(report, options);
    if (!options.replay.verify || report.interrupted) return;
    if (report.mismatch)
        std::printf("DIFFERENT after %" PRId64 " identical steps\n%s", report.verified, report.mismatch->text().c_str());
    else if (report.verified > 0)
        std::printf("verified: %" PRId64 " state hashes are identical\n", report.verified);
}

/// Says what the replay found and writes the files that were asked for. Returns the exit code.
int conclude(const replay::ReplayReport& report, const record::RunLog& log, simulation::Simulation& simulation,
             const DaemonOptions& options)
{
    print_report(report, options);
    for (const std::string& doubt : report.doubts) std::printf("%s: %s\n", report.mismatch ? "the cause may be" : "note", doubt.c_str());
    if (report.interrupted)
    {
        if (!options.save.empty() || !options.out.empty()) spdlog::warn("--save and --out are not written: the end was not reached");
        return program::code_of_interruption();
    }
    const std::string beyond = beyond_the_end(report, options);
    const bool nothing = options.replay.verify && report.verified == 0 && !report.mismatch;
    if (!beyond.empty())
        (void)std::fprintf(stderr, "%s\n", beyond.c_str());
    else if (nothing)
        (void)std::fprintf(stderr, "nothing was verified: %s\n", why_nothing(log, report, options).c_str());
    if (!options.save.empty())
        if (auto saved = write_snapshot(simulation.capture(), {}, options.save); !saved) return fail(saved.errors());
    if (!options.out.empty() && !write_end_state(simulation, options.out)) return 1;
    return report.mismatch || nothing || !beyond.empty() ? 1 : 0;
}

}  // namespace

/// "step 1200 of run 2, t = 5 s, 1200 state hashes are the same"
class ReplayProgress
{
public:
    explicit ReplayProgress(const DaemonOptions& options)
        : line_(options.progress ? program::ProgressTo::Lines : program::ProgressTo::Terminal), verifies_(options.replay.verify)
    {
    }
    void note(const simulation::Simulation& s)
    {
        ++steps_;
        if (!line_.is_due()) return;
        char text[160];
        std::snprintf(text, sizeof text, "run %" PRIu64 ", step %" PRId64 ", t = %.6g s; %" PRId64 " steps replayed%s  (Ctrl-C ends)",
                      s.run(), s.tick(), s.time(), steps_, verifies_ ? ", all identical" : "");
        line_.show(text);
    }
    void end() { line_.clear(); }

private:
    program::Progress line_;
    bool verifies_;
    std::int64_t steps_ = 0;
};

int replay_recording(plugins::PluginLibrary& library, const DaemonOptions& options, const std::atomic<bool>& stop,
                     const Interruption& interruption)
{
    program::catch_signals();
    auto module = RecordModule::load_for_reading();
    if (!module) return fail(module.errors());
    auto log = module->read(options.replay.file);
    if (!log) return fail(log.errors());
    if (const std::string damage = (*log)->damage(); !damage.empty()) spdlog::warn("{}", damage);
    warn_of_another_build(**log, library);

    simulation::Simulation simulation(library, options.threads);
    simulation.set_interruption(&interruption);
    // Every recorded request was allowed when it was recorded, so no limits apply here.
    model::CompileLimits recorded;
    recorded.components = std::numeric_limits<std::uint32_t>::max();
    simulation.limit(recorded);
    simulation.read_requests_with(control::component_request_reader(library, recorded));
    std::unique_ptr<Trace> trace;
    ReplayProgress progress(options);
    replay::ReplayOptions how;
    how.verify = options.replay.verify, how.from = options.replay.from, how.run = options.replay.run;
    if (options.until >= 0) how.until = options.until;
    how.stop = [&] { return stop.load(); };
    how.stepped = [&]
    {
        if (options.hashes) std::printf("%" PRId64 " %016" PRIx64 "\n", simulation.tick(), simulation.state_hash());
        if (trace) trace->sample(simulation);
        progress.note(simulation);
    };
    how.begun = [&](double)
    {
        if (options.trace.empty() || trace) return;
        auto opened = Trace::open(options.trace, simulation, options.every);
        if (opened)
            trace = opened.take(), trace->sample(simulation);
        else
            spdlog::error("{}", opened.error().reason);
    };
    auto report = replay::replay(**log, simulation, library, how);
    progress.end();
    if (!report && stop)
    {
        // A recorded request was interrupted.
        for (const Error& e : report.errors()) (void)std::fprintf(stderr, "%s\n", e.text().c_str());
        std::printf("interrupted by %s: NOT VERIFIED\n", program::name_of_interruption().c_str());
        return program::code_of_interruption();
    }
    if (!report) return fail(report.errors());
    if (trace) trace->sample(simulation, true);
    return conclude(*report, **log, simulation, options);
}

}  // namespace plab::daemon
