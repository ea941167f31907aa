#include "daemon/replaying.h"

#include <spdlog/spdlog.h>

#include <cinttypes>
#include <cstdio>

#include "daemon/output.h"
#include "daemon/recording.h"
#include "replay/replay.h"

namespace plab::daemon
{
namespace
{

int fail(const Errors& errors)
{
    for (const Error& e : errors) (void)std::fprintf(stderr, "%s\n", e.text().c_str());
    return 1;
}

void print_report(const replay::ReplayReport& report, const Options& options)
{
    std::printf("%s: %" PRIu64 " run%s, %" PRId64 " steps made again, %" PRIu64 " requests\n", options.replay.file.c_str(), report.runs,
                report.runs == 1 ? "" : "s", report.steps, report.requests);
    if (!options.replay.verify) return;
    if (report.mismatch)
        std::printf("DIFFERENT after %" PRId64 " steps that are the same\n%s", report.verified, report.mismatch->text().c_str());
    else
        std::printf("verified: %" PRId64 " state hashes are the same\n", report.verified);
}

}  // namespace

int replay_recording(plugins::PluginLibrary& library, const Options& options, const std::atomic<bool>& stop)
{
    auto module = RecordModule::load_for_reading();
    if (!module) return fail(module.errors());
    auto log = module->read(options.replay.file);
    if (!log) return fail(log.errors());
    if (const std::string damage = (*log)->damage(); !damage.empty()) spdlog::warn("{}", damage);
    if (const std::string version = (*log)->origin("version"); !version.empty() && version != PLAB_VERSION)
        spdlog::warn("recorded by plabd {}, replayed by {}: digits may differ", version, PLAB_VERSION);

    simulation::Simulation simulation(library, options.threads);
    std::unique_ptr<Trace> trace;
    replay::ReplayOptions how;
    how.verify = options.replay.verify, how.from = options.replay.from, how.run = options.replay.run;
    if (options.until >= 0) how.until = options.until;
    how.stop = [&] { return stop.load(); };
    how.stepped = [&]
    {
        if (options.hashes) std::printf("%" PRId64 " %016" PRIx64 "\n", simulation.tick(), simulation.state_hash());
        if (trace) trace->sample(simulation);
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
    if (!report) return fail(report.errors());
    if (trace) trace->sample(simulation, true);
    print_report(*report, options);
    const bool nothing = options.replay.verify && report->verified == 0 && !report->mismatch;
    if (nothing) std::fputs("nothing was verified: the recording holds no hashes there\n", stderr);
    if (!options.save.empty())
        if (auto saved = write_snapshot(simulation.capture(), {}, options.save); !saved) return fail(saved.errors());
    if (!options.out.empty() && !write_end_state(simulation, options.out)) return 1;
    return report->mismatch || nothing ? 1 : 0;
}

}  // namespace plab::daemon
