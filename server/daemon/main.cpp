// plabd: the composition root, which only puts the modules together.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "blueprint/writer.h"
#include "control/component_requests.h"
#include "daemon/ending.h"
#include "daemon/explain.h"
#include "daemon/frozen.h"
#include "daemon/options.h"
#include "daemon/replaying.h"
#include "daemon/runner.h"
#include "daemon/scene_source.h"
#include "daemon/shadow.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "program/interruption.h"
#include "simulation/snapshot/history.h"

namespace
{

/// What a signal can interrupt: a step, a trial, a rewind.
plab::Interruption work;
void interrupt_work() { work.ask(plab::daemon::kGrace); }

int run_scene(plab::simulation::Simulation& simulation, plab::plugins::PluginLibrary& library, const plab::daemon::DaemonOptions& options,
              std::chrono::steady_clock::time_point start, const std::vector<std::string>& waiting = {})
{
    auto wake = plab::daemon::Wake::make();
    if (!wake) return plab::daemon::fail(wake.errors());
    // Until here a signal ends the process in the default way: nothing needs an orderly end yet.
    plab::program::call_on_signal(interrupt_work);
    plab::program::catch_signals();
    plab::program::wake_on_signal(wake->descriptor());
    simulation.set_interruption(&work);
    int code = 0;
    {
        plab::daemon::Service service(simulation, library, options);
        if (options.bus)
        {
            if (auto opened = service.open_bus(options, *wake, work); !opened) return plab::daemon::fail(opened.errors());
            const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
            spdlog::info("server '{}' in domain {}, {}; ready after {:.1f} ms", options.name, options.domain,
                         options.network_interface.empty() ? "this host only" : "interface " + options.network_interface, took.count());
        }
        if (const std::string missing = plab::daemon::missing_for_replay(options.record); !missing.empty())
            spdlog::warn("{} cannot be replayed: --record-topics does not include {}", options.record.file, missing);
        if (!options.record.file.empty())
            if (auto opened = service.open_recording(options); !opened) return plab::daemon::fail(opened.errors());
        if (auto taken = service.take_over(waiting); !taken) return plab::daemon::fail(taken.errors());
        code = plab::daemon::run(simulation, service, options, *wake, plab::program::interruption());
    }
    plab::program::wake_on_signal(-1);
    return code;
}

/// --load: continues a saved run.
int go_on(plab::plugins::PluginLibrary& library, const plab::daemon::DaemonOptions& options, std::chrono::steady_clock::time_point start)
{
    auto snapshot = plab::daemon::read_snapshot(options.load, library);
    if (!snapshot) return plab::daemon::fail(snapshot.errors());
    plab::simulation::Simulation simulation(library, options.threads);
    simulation.limit(plab::daemon::limits_of(options));
    simulation.read_requests_with(plab::control::component_request_reader(library, plab::daemon::limits_of(options)));
    simulation.let_measure(true);
    simulation.history().configure(plab::daemon::history_of(options));
    if (auto restored = simulation.restore(snapshot->snapshot); !restored) return plab::daemon::fail(restored.errors());
    if (options.task == plab::daemon::Task::Export) return plab::daemon::export_scene(simulation, options);
    if (options.until >= 0 && options.until < simulation.time() - 0.5 * simulation.dt())
    {
        std::fprintf(stderr, "plabd: --until %.9g is before the snapshot, which is at %.9g s: --until counts from the start of the run\n",
                     options.until, simulation.time());
        return 2;
    }
    return run_scene(simulation, library, options, start, snapshot->waiting);
}

/// Makes the steps before `time`, s; none if it is negative.
void run_until(plab::simulation::Simulation& simulation, double time)
{
    while (simulation.time() < time - 0.5 * simulation.dt())
        if (!simulation.step_once()) return;
}

int carry_out(const plab::daemon::DaemonOptions& options)
{
    const auto start = std::chrono::steady_clock::now();
    plab::plugins::PluginLibrary library;
    for (const plab::Error& e : library.problems()) spdlog::warn("{}", e.text());
    if (options.task == plab::daemon::Task::Reference)
    {
        const auto text = options.reference.empty() ? plab::Result<std::string>(plab::blueprint::write_reference(library))
                                                    : plab::blueprint::write_reference(library, options.reference);
        if (!text) return plab::daemon::fail(text.errors());
        std::fputs(text->c_str(), stdout);
        return 0;
    }
    if (options.task == plab::daemon::Task::Replay || options.task == plab::daemon::Task::Shadow)
    {
        plab::program::call_on_signal(interrupt_work);
        const std::atomic<bool>& stop = plab::program::interruption();
        return options.task == plab::daemon::Task::Replay ? plab::daemon::replay_recording(library, options, stop, work)
                                                          : plab::daemon::run_shadow(library, options, stop, work);
    }
    if (!options.load.empty()) return go_on(library, options, start);
    if (options.task == plab::daemon::Task::Import) return plab::daemon::import_scene(library, options);
    auto blueprint = plab::daemon::read_scene(options);
    if (!blueprint) return plab::daemon::fail(blueprint.errors());
    auto scene = plab::model::compile(*blueprint, library, nullptr, plab::daemon::limits_of(options));
    if (!scene) return plab::daemon::fail(scene.errors());
    plab::simulation::Simulation simulation(library, options.threads);
    simulation.limit(plab::daemon::limits_of(options));
    simulation.read_requests_with(plab::control::component_request_reader(library, plab::daemon::limits_of(options)));
    simulation.let_measure(true);
    simulation.history().configure(plab::daemon::history_of(options));
    if (auto loaded = simulation.load(*scene); !loaded) return plab::daemon::fail(loaded.errors());
    switch (options.task)
    {
        case plab::daemon::Task::Check:
            std::printf("%s: %zu components, no errors\n", options.scene.c_str(), scene->components.size());
            return 0;
        case plab::daemon::Task::Expand:
            run_until(simulation, options.until);
            std::fputs(
                plab::blueprint::write_long_form(options.until > 0 ? plab::daemon::frozen_scene(simulation) : *scene, library).c_str(),
                stdout);
            return 0;
        case plab::daemon::Task::Export:
            run_until(simulation, options.until);
            return plab::daemon::export_scene(simulation, options);
        case plab::daemon::Task::Explain:
            run_until(simulation, options.until);
            std::fputs(plab::daemon::explain(simulation, library).c_str(), stdout);
            simulation.step();  // state-dependent choices exist only after a step
            std::fputs(plab::daemon::explain_choices(simulation).c_str(), stdout);
            std::fputs(plab::daemon::explain_rules(simulation).c_str(), stdout);
            return 0;
        default:
            return run_scene(simulation, library, options, start);
    }
}

}  // namespace

int main(int argc, char** argv)
{
    plab::daemon::DaemonOptions options;
    if (const auto end = plab::daemon::parse_options(argc, argv, options))
    {
        std::fputs(end->text.c_str(), end->exit_code == 0 ? stdout : stderr);
        return end->exit_code;
    }
    spdlog::set_default_logger(spdlog::stderr_color_mt("plabd"));
    spdlog::set_pattern("%^%l%$ %v");
    spdlog::set_level(spdlog::level::from_str(options.log_level));
    plab::program::ignore_write_signals();  // a reader of the table may have gone, or a file may be at its size limit: the run continues
    return carry_out(options);
}
