#include "twin.h"

#include <algorithm>
#include <filesystem>

#include "model/numbers.h"
#include "simulation/snapshot/format.h"

namespace plab::test
{
namespace
{

std::string id_of(const world::World& world, Ref ref) { return ref.valid() ? world.id_of(ref) : "-"; }

/// The content of a Lua state depends on when its garbage was collected.
bool is_memory(const simulation::Difference& d) { return d.field == "memory_used"; }

std::string words(int snapshot_step, int step, const Footprint& before, const Footprint& after)
{
    std::string out = "from step " + std::to_string(snapshot_step) + ", after step " + std::to_string(step) + ": ";
    if (before.hash != after.hash) return out + "another state hash";
    for (std::size_t i = 0; i < std::max(before.events.size(), after.events.size()); ++i)
    {
        const std::string a = i < before.events.size() ? before.events[i] : "-", b = i < after.events.size() ? after.events[i] : "-";
        if (a != b) return out + "event\n  " + a + "\nis now\n  " + b;
    }
    return out + "?";
}

}  // namespace

std::vector<std::string> scene_files()
{
    namespace fs = std::filesystem;
    std::vector<std::string> out;
    const std::string root = PLAB_SOURCE_DIR;
    for (const char* folder : {"scenes", "scenes/studies", "tests/golden/scenes"})
        for (const auto& entry : fs::directory_iterator(root + "/" + folder))
            if (entry.path().extension() == ".xml") out.push_back(std::string(folder) + "/" + entry.path().filename().string());
    std::sort(out.begin(), out.end());
    return out;
}

model::SceneSpec scene_of(const std::string& body, const std::string& settings)
{
    auto scene = compile_text(whole_scene(body, settings));
    REQUIRE_MESSAGE(scene.ok(), reasons(scene));
    return scene.take();
}

void ask(simulation::Simulation& simulation, std::vector<simulation::Operation> operations)
{
    simulation::Request request;
    request.operations = std::move(operations);
    const simulation::Reply reply = simulation.carry_out_now(request);
    REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
}

simulation::AddBlueprintOperation added(const std::string& body)
{
    auto blueprint = blueprint::read_blueprint(whole_scene(body), "request");
    REQUIRE_MESSAGE(blueprint.ok(), reasons(blueprint));
    return simulation::AddBlueprintOperation(blueprint.take());
}

Footprint footprint(const simulation::Simulation& s)
{
    Footprint out;
    out.hash = s.state_hash();
    for (const Event& e : s.events())
    {
        std::string text = std::to_string(e.tick) + " " + model::format_real(e.time) + " " + e.kind + " ";
        text += e.component == kNoIndex ? "-" : s.world().id_of(e.component);
        text += " " + id_of(s.world(), e.a) + " " + id_of(s.world(), e.b) + " ";
        // What levels cost is measured by the clock, and for people alone; how they err is not.
        const bool has_costs = e.kind == "level.changed";
        const std::size_t costs = has_costs ? e.message.find("; cost") : std::string::npos;
        text += costs == std::string::npos ? e.message : e.message.substr(0, costs) + e.message.substr(e.message.find(", error", costs));
        for (std::size_t k = has_costs ? 2 : 0; k < e.values.size(); ++k) text += " " + model::format_real(e.values[k]);
        out.events.push_back(std::move(text));
    }
    return out;
}

Trajectory run(simulation::Simulation& simulation, const Plan& plan)
{
    Trajectory out;
    for (int k = 0; k < plan.steps; ++k)
    {
        if (k % plan.every == 0) out.snapshots.push_back(simulation.capture());
        plan.meddle(simulation, k);
        simulation.step();
        out.steps.push_back(footprint(simulation));
    }
    out.end = simulation.capture();
    return out;
}

namespace
{

/// Written to bytes and read back, if that is planned.
Result<simulation::Snapshot> arrived(const simulation::Snapshot& snapshot, const Plan& plan)
{
    if (!plan.as_file) return snapshot;
    const auto bytes = simulation::encode(snapshot, std::vector<std::string>(snapshot->waiting.size()));
    if (!bytes) return bytes.errors();
    auto file = simulation::decode(*bytes, library());
    if (!file) return file.errors();
    return file->snapshot;
}

std::string follow(const Trajectory& trajectory, std::size_t number, const Plan& plan)
{
    const int from = static_cast<int>(number) * plan.every;
    const bool ledger = plan.threads == plan.threads_after;
    const auto snapshot = arrived(trajectory.snapshots[number], plan);
    if (!snapshot) return "step " + std::to_string(from) + ": " + first_error(snapshot.errors());
    simulation::Simulation twin(library(), plan.threads_after);
    if (auto done = twin.restore(*snapshot); !done) return "step " + std::to_string(from) + ": " + first_error(done.errors());
    if (auto what = difference_of(trajectory.snapshots[number], twin.capture()); !what.empty())
        return "restored at step " + std::to_string(from) + ": " + what;
    const int until = std::min(from + plan.follow, plan.steps);
    for (int k = from; k < until; ++k)
    {
        plan.meddle(twin, k);
        twin.step();
        const Footprint now = footprint(twin), &then = trajectory.steps[static_cast<std::size_t>(k)];
        if (now != then) return words(from, k, then, now);
    }
    if (until < plan.steps) return {};
    const std::string what = difference_of(trajectory.end, twin.capture(), ledger);
    return what.empty() ? what : "from step " + std::to_string(from) + ", at the end: " + what;
}

}  // namespace

std::string follow(const Trajectory& trajectory, const Plan& plan)
{
    for (std::size_t i = 0; i < trajectory.snapshots.size(); ++i)
        if (auto what = follow(trajectory, i, plan); !what.empty()) return what;
    return {};
}

std::string follow(const model::SceneSpec& scene, const Plan& plan)
{
    const auto original = started(scene, plan.threads);
    return follow(run(*original, plan), plan);
}

std::string difference_of(const simulation::Snapshot& first, const simulation::Snapshot& second, bool ledger)
{
    simulation::Comparison how;
    how.outputs = true, how.ledger = ledger, how.most = 20;
    for (const simulation::Difference& d : simulation::differences(*first, *second, how))
        if (!is_memory(d)) return d.text();
    return {};
}

}  // namespace plab::test
