// The run whose levels are checked: a scene, or a recording made again.
#include <limits>

#include "blueprint/reader.h"
#include "control/component_requests.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "plugins/plugin_file.h"
#include "record/record.h"
#include "replay/replay.h"
#include "study/verify.h"

namespace plab::study
{
namespace
{

using simulation::Simulation;

void tell_progress(const VerifyPlan& plan, const Simulation& run)
{
    if (plan.progress) plan.progress(plan.file + ": " + std::to_string(static_cast<int>(run.time())) + " s");
}

Result<VerifyResult> verify_scene(model::TypeSource& types, const VerifyPlan& plan)
{
    auto blueprint = blueprint::read_blueprint_file(plan.file);
    if (!blueprint) return blueprint.errors();
    auto scene = model::compile(*blueprint, types);
    if (!scene) return scene.errors();
    Simulation run(types);
    run.read_requests_with(control::component_request_reader(types, {}));
    if (auto loaded = run.load(*scene); !loaded) return loaded.errors();
    run.let_measure(true);
    LevelVerifier verifier(types);
    while (true)
    {
        if (auto done = verifier.at_boundary(run); !done) return done.errors();
        if (run.time() > plan.until - 0.5 * run.dt()) break;
        if (plan.stop && plan.stop->due()) return reason("interrupted");
        tell_progress(plan, run);
        (void)run.step();
    }
    auto out = verifier.take();
    if (out) out->title = scene->settings.title.empty() ? plan.file : scene->settings.title;
    return out;
}

Result<std::unique_ptr<record::RunLog>> open_recording(const std::string& file)
{
    auto module = plugins::open_module("record", record::kRunLogEntry, plugins::PluginLibrary::default_directories());
    if (!module) return module.errors();
    Error error;
    auto opened = reinterpret_cast<record::OpenRunLog>(module->entry)(file, error);
    if (!opened) return error;
    return opened;
}

Result<VerifyResult> verify_recording(model::TypeSource& types, const VerifyPlan& plan)
{
    auto log = open_recording(plan.file);
    if (!log) return log.errors();
    Simulation run(types);
    // Every recorded request was allowed when it was recorded, so no limits apply here.
    model::CompileLimits recorded;
    recorded.components = std::numeric_limits<std::uint32_t>::max();
    run.limit(recorded);
    run.read_requests_with(control::component_request_reader(types, recorded));
    LevelVerifier verifier(types);
    Errors failed;
    const auto look = [&]
    {
        tell_progress(plan, run);
        if (failed.empty())
            if (auto done = verifier.at_boundary(run); !done) failed = done.errors();
    };
    replay::ReplayOptions options;
    options.verify = true;
    if (plan.until >= 0) options.until = plan.until;
    options.stop = [&] { return !failed.empty() || (plan.stop && plan.stop->due()); };
    options.begun = [&](double) { look(); };
    options.stepped = look;
    const auto report = replay::replay(**log, run, types, options);
    if (!failed.empty()) return failed;
    if (!report) return report.errors();
    if (report->interrupted) return reason("interrupted");
    if (report->mismatch) return reason("the replay is not what was recorded: " + report->mismatch->text());
    if (report->steps == 0) return reason("the recording has no steps that could be made again");
    auto out = verifier.take();
    if (out) out->title = plan.file;
    return out;
}

}  // namespace

Result<VerifyResult> verify_levels(model::TypeSource& types, const VerifyPlan& plan)
{
    auto out = plan.file.ends_with(".mcap") ? verify_recording(types, plan) : verify_scene(types, plan);
    if (out) out->source = plan.file, out->command = plan.command;
    return out;
}

}  // namespace plab::study
