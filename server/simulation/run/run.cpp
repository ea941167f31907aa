#include "simulation/run/run.h"

#include <algorithm>

#include "model/alike.h"

namespace plab::simulation
{

void RunContext::note_cost(double ns)
{
    // The mean over all steps while there are few of them, then an exponential mean over about the last hundred.
    constexpr std::uint64_t kMost = 100;
    steps_timed = std::min(steps_timed + 1, kMost);
    mean_step_ns += (ns - mean_step_ns) / static_cast<double>(steps_timed);
}

Run Run::set_aside()
{
    Run out;
    out.live = std::move(live);
    out.watch = std::exchange(watch, std::make_unique<DivergenceWatch>());
    out.loaded = loaded, out.clock = clock, out.kinetic_at_start = kinetic_at_start, out.number = number, out.revision = revision;
    out.waiting = waiting, out.changes = changes, out.events = events, out.changed_by_scripts = changed_by_scripts;
    return out;
}

void Run::forget_late_requests()
{
    std::erase_if(waiting, [&](const WaitingRequest& w) { return w.run == number && w.request->at && *w.request->at < clock.tick; });
}

Result<void> LiveScene::rebuild()
{
    auto built = stepper->rebuild();
    return built ? levels->rebuild() : built;
}

Result<LiveScene> build_scene(const RunContext& context, const model::SceneSpec& scene)
{
    LiveScene live;
    live.world = std::make_unique<world::World>(*context.types);
    live.world->describe(scene.settings, scene.file);
    if (auto added = live.world->add(scene); !added) return added.errors();
    live.stepper = std::make_unique<Stepper>(*live.world, context.threads);
    live.levels = std::make_unique<LevelBook>(*live.world, *live.stepper);
    if (auto built = live.rebuild(); !built)
    {
        Errors errors = built.errors();
        for (Error& e : errors)
            if (e.where.file.empty()) e.where.file = scene.file;
        return model::first_of_alike(std::move(errors));
    }
    return live;
}

}  // namespace plab::simulation
