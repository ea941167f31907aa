// What a governor buys: the error of a whole scene against the cost of its steps, governed and with one level for all. Prints a Markdown
// table. The scene is scenes/city.xml unless another one is named, seconds=T its length, governor=ID whose ladder is used, and eye=ID the
// body from which pixels are counted.
//
// Trajectories of double pendulums part whatever one does, so courses are not compared as a whole. From the state at each second, a second
// simulation makes the steps of a quarter of a second with the most exact level for all; the error is how far the bodies are apart then.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "blueprint/reader.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "simulation/costs/clock.h"
#include "simulation/simulation.h"

using namespace plab;

namespace
{

struct Options
{
    std::string scene = PLAB_SOURCE_DIR "/scenes/city.xml", governor = "cranes", eye = "drone";
    double seconds = 20;
};

constexpr double kBetween = 1, kWindow = 0.25;  // s: from one comparison to the next; of a comparison

[[noreturn]] void fail(const std::string& why)
{
    std::fprintf(stderr, "bench_levels: %s\n", why.c_str());
    std::exit(1);
}

void ask(simulation::Simulation& s, std::vector<simulation::Operation> operations)
{
    simulation::Request request;
    request.trial.budget = simulation::TrialChoice::Budget::None;
    request.operations = std::move(operations);
    if (const simulation::Reply reply = s.carry_out_now(request); !reply.done) fail(reply.errors.front().text());
}

/// The components that the governor watches.
std::vector<std::string> watched_by(const simulation::Simulation& s, const std::string& governor)
{
    std::vector<std::string> out;
    for (const simulation::LevelInfo& l : s.levels().levels())
        if (s.world().id_of(l.governor) == governor) out.push_back(s.world().id_of(l.component));
    return out;
}

void give_all(simulation::Simulation& s, const std::vector<std::string>& watched, const simulation::Level& level)
{
    std::vector<simulation::Operation> operations;
    for (const std::string& id : watched) operations.emplace_back(simulation::SwapOperation{id, level.type, level.values});
    ask(s, std::move(operations));
}

/// Squared departures of all moving bodies, in m and in pixels of a picture 720 pixels high whose angle is 0.7 rad.
struct Departure
{
    double metres = 0, pixels = 0;
    std::size_t bodies = 0;

    void add(const simulation::Simulation& one, const simulation::Simulation& other, const std::string& eye)
    {
        const Bodies &a = one.world().host().bodies, &b = other.world().host().bodies;
        const Vec3 from = a.position[one.world().component(one.world().find(eye)).host_index];
        for (const std::uint32_t i : one.world().in_id_order())
        {
            const world::Component& c = one.world().component(i);
            if (c.facet != Facet::Body || !a.dynamic(c.host_index)) continue;
            const std::uint32_t k = other.world().component(other.world().find(c.id)).host_index;
            const double apart = length(a.position[c.host_index] - b.position[k]);
            const double distance = std::max(1.0, length(a.position[c.host_index] - from));
            const bool ahead = a.position[c.host_index].x > from.x;
            const double seen = ahead ? apart / distance * 360 / std::tan(0.35) : 0;
            metres += apart * apart, pixels += seen * seen, ++bodies;
        }
    }
};

double at(std::vector<double> values, double share)
{
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// `level`: for all, with the governors removed; null: governed.
void measure(const model::SceneSpec& scene, plugins::PluginLibrary& library, const Options& options, const simulation::Ladder& ladder,
             const simulation::Level* level)
{
    simulation::Simulation live(library), exact(library);
    if (const auto loaded = live.load(scene); !loaded) fail(loaded.error().text());
    live.let_measure(true);
    const std::vector<std::string> watched = watched_by(live, options.governor);
    exact.let_decide(false);
    if (level)
    {
        live.let_decide(false);
        give_all(live, watched, *level);
    }
    std::vector<double> cpu;
    Departure departure;
    double next = kBetween;
    const auto step = [&]
    {
        const std::uint64_t begin = simulation::thread_ns();
        live.step();
        cpu.push_back(1e-6 * static_cast<double>(simulation::thread_ns() - begin));
    };
    while (live.time() < options.seconds)
    {
        if (live.time() < next - 0.5 * live.dt())
        {
            step();
            continue;
        }
        next += kBetween;
        if (const auto restored = exact.restore(live.capture()); !restored) fail(restored.error().text());
        give_all(exact, watched, ladder.levels.back());
        for (const double end = live.time() + kWindow; live.time() < end - 0.5 * live.dt();) step(), exact.step_once();
        departure.add(live, exact, options.eye);
    }
    const auto n = static_cast<double>(std::max<std::size_t>(1, departure.bodies));
    std::printf("| %s | %.3g | %.3g | %.3g | %.3g | %.3g | %.3g |\n", level ? level->text.c_str() : "governed", at(cpu, 0.5), at(cpu, 0.9),
                at(cpu, 0.99), at(cpu, 1), std::sqrt(departure.pixels / n), 1e3 * std::sqrt(departure.metres / n));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv)
{
    Options options;
    for (int i = 1; i < argc; ++i)
        if (std::strncmp(argv[i], "seconds=", 8) == 0)
            options.seconds = std::max(1.0, std::atof(argv[i] + 8));
        else if (std::strncmp(argv[i], "governor=", 9) == 0)
            options.governor = argv[i] + 9;
        else if (std::strncmp(argv[i], "eye=", 4) == 0)
            options.eye = argv[i] + 4;
        else
            options.scene = argv[i];
    const auto blueprint = blueprint::read_blueprint_file(options.scene);
    if (!blueprint) fail(blueprint.error().text());
    plugins::PluginLibrary library({PLAB_BINARY_DIR "/lib/plab"});
    const auto scene = model::compile(*blueprint, library);
    if (!scene) fail(scene.error().text());
    const model::ComponentSpec* governor = scene->find(options.governor);
    if (!governor) fail("the scene has no governor '" + options.governor + "'");
    std::string written;
    for (const model::FieldSpec& f : governor->fields)
        if (f.name == "levels") written = std::get<std::string>(f.value);
    const auto ladder = simulation::read_ladder(written, library);
    if (!ladder) fail(ladder.error().text());
    std::printf(
        "| levels | step, ms of CPU: median | 90 %% | 99 %% | longest | error, pixels | error, mm |\n|---|---|---|---|---|---|---|\n");
    measure(*scene, library, options, *ladder, nullptr);
    for (const simulation::Level& level : ladder->levels) measure(*scene, library, options, *ladder, &level);
    return 0;
}
