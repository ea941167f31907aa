// plabd: the composition root. Nothing is decided here; everything is put together here.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <csignal>

#include "blueprint/reader.h"
#include "blueprint/writer.h"
#include "daemon/explain.h"
#include "daemon/options.h"
#include "daemon/replaying.h"
#include "daemon/runner.h"
#include "daemon/shadow.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "simulation/snapshot/history.h"

namespace
{

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

// The loop sleeps: a signal must wake it. Writing to an eventfd is allowed in a handler.
std::atomic<const plab::daemon::Wake*> sleeper{nullptr};
static_assert(std::atomic<const plab::daemon::Wake*>::is_always_lock_free);

extern "C" void on_signal(int)
{
    stop = true;
    if (const plab::daemon::Wake* wake = sleeper) wake->wake();
}

int fail(const plab::Errors& errors)
{
    for (const plab::Error& e : errors) std::fprintf(stderr, "%s\n", e.text().c_str());
    return 1;
}

int run_scene(plab::simulation::Simulation& simulation, plab::plugins::PluginLibrary& library, const plab::daemon::Options& options,
              std::chrono::steady_clock::time_point start, const std::vector<std::string>& waiting = {})
{
    auto wake = plab::daemon::Wake::make();
    if (!wake) return fail(wake.errors());
    sleeper = &*wake;
    int code = 0;
    {
        plab::daemon::Service service(simulation, library, options);
        if (options.bus)
        {
            if (auto opened = service.open_bus(options, *wake); !opened) return fail(opened.errors());
            const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
            spdlog::info("server '{}' in domain {}, {}; ready after {:.1f} ms", options.name, options.domain,
                         options.network_interface.empty() ? "this host only" : "interface " + options.network_interface, took.count());
        }
        if (const std::string missing = plab::daemon::missing_for_replay(options.record); !missing.empty())
            spdlog::warn("{} cannot be replayed: --record-topics is without {}", options.record.file, missing);
        if (!options.record.file.empty())
            if (auto opened = service.open_recording(options); !opened) return fail(opened.errors());
        if (auto taken = service.take_over(waiting); !taken) return fail(taken.errors());
        code = plab::daemon::run(simulation, service, options, *wake, stop);
    }
    sleeper = nullptr;
    return code;
}

/// --load: a run that was left goes on.
int go_on(plab::plugins::PluginLibrary& library, const plab::daemon::Options& options, std::chrono::steady_clock::time_point start)
{
    auto snapshot = plab::daemon::read_snapshot(options.load, library);
    if (!snapshot) return fail(snapshot.errors());
    plab::simulation::Simulation simulation(library, options.threads);
    simulation.history().configure(plab::daemon::history_of(options));
    if (auto restored = simulation.restore(snapshot->snapshot); !restored) return fail(restored.errors());
    if (options.until >= 0 && options.until < simulation.time() - 0.5 * simulation.dt())
    {
        std::fprintf(stderr, "plabd: --until %.9g is before the snapshot, which is at %.9g s: --until counts from the run's beginning\n",
                     options.until, simulation.time());
        return 2;
    }
    return run_scene(simulation, library, options, start, snapshot->waiting);
}

int carry_out(const plab::daemon::Options& options)
{
    const auto start = std::chrono::steady_clock::now();
    plab::plugins::PluginLibrary library;
    for (const plab::Error& e : library.problems()) spdlog::warn("{}", e.text());
    if (options.task == plab::daemon::Task::Reference)
    {
        std::fputs(plab::blueprint::write_reference(library).c_str(), stdout);
        return 0;
    }
    if (options.task == plab::daemon::Task::Replay) return plab::daemon::replay_recording(library, options, stop);
    if (options.task == plab::daemon::Task::Shadow) return plab::daemon::run_shadow(library, options, stop);
    if (!options.load.empty()) return go_on(library, options, start);
    auto blueprint = plab::blueprint::read_blueprint_file(options.scene);
    if (!blueprint) return fail(blueprint.errors());
    auto scene = plab::model::compile(*blueprint, library);
    if (!scene) return fail(scene.errors());
    plab::simulation::Simulation simulation(library, options.threads);
    simulation.history().configure(plab::daemon::history_of(options));
    if (auto loaded = simulation.load(*scene); !loaded) return fail(loaded.errors());
    switch (options.task)
    {
        case plab::daemon::Task::Check:
            std::printf("%s: %zu components, no errors\n", options.scene.c_str(), scene->components.size());
            return 0;
        case plab::daemon::Task::Expand:
            std::fputs(plab::blueprint::write_long_form(*scene, library).c_str(), stdout);
            return 0;
        case plab::daemon::Task::Explain:
            std::fputs(plab::daemon::explain(simulation, library).c_str(), stdout);
            simulation.step();  // choices by the state exist only then
            std::fputs(plab::daemon::explain_choices(simulation).c_str(), stdout);
            return 0;
        default:
            return run_scene(simulation, library, options, start);
    }
}

}  // namespace

int main(int argc, char** argv)
{
    plab::daemon::Options options;
    if (const auto end = plab::daemon::parse_options(argc, argv, options))
    {
        std::fputs(end->text.c_str(), end->exit_code == 0 ? stdout : stderr);
        return end->exit_code;
    }
    spdlog::set_default_logger(spdlog::stderr_color_mt("plabd"));
    spdlog::set_pattern("%^%l%$ %v");
    spdlog::set_level(spdlog::level::from_str(options.log_level));
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    std::signal(SIGHUP, on_signal);  // the terminal has gone
    std::signal(SIGPIPE, SIG_IGN);   // whoever read the table has gone; the run goes on
    std::signal(SIGXFSZ, SIG_IGN);   // a file at its limit is an error of that file, not of the run
    return carry_out(options);
}
