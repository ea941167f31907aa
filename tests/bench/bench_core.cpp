// Prints the core's figures: cost of an empty step, steps per second of the paper's scene, pause of a swap, time from
// start to the first step, what a frame of 10,000 bodies costs the step thread. CSV on standard output: name, unit, value.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "blueprint/reader.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "publish/roster.h"
#include "publish/states.h"
#include "simulation/costs/clock.h"
#include "simulation/simulation.h"

using namespace plab;

namespace
{

struct Loaded
{
    std::unique_ptr<plugins::PluginLibrary> library;
    std::unique_ptr<simulation::Simulation> simulation;
};

Loaded load(Result<model::Blueprint> blueprint)
{
    Loaded out;
    out.library = std::make_unique<plugins::PluginLibrary>(std::vector<std::string>{PLAB_BINARY_DIR "/lib/plab"});
    auto scene = blueprint ? model::compile(*blueprint, *out.library) : Result<model::SceneSpec>(blueprint.errors());
    out.simulation = std::make_unique<simulation::Simulation>(*out.library);
    auto done = scene ? out.simulation->load(*scene) : Result<void>(scene.errors());
    if (!done)
    {
        std::fprintf(stderr, "%s\n", done.error().text().c_str());
        std::exit(1);
    }
    return out;
}

Loaded load_paper() { return load(blueprint::read_blueprint_file(PLAB_SOURCE_DIR "/scenes/fan_and_balloons.xml")); }

double median(std::vector<double> v)
{
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

void print(const char* name, const char* unit, double value) { std::printf("%s,%s,%.6g\n", name, unit, value); }

void empty_step()
{
    Loaded l = load(blueprint::read_blueprint("<plab version=\"1\"/>", "empty.xml"));
    std::vector<double> rounds;
    for (int r = 0; r < 21; ++r)
    {
        const std::uint64_t before = simulation::now_ns();
        for (int i = 0; i < 100000; ++i) l.simulation->step();
        rounds.push_back(static_cast<double>(simulation::now_ns() - before) / 1e5);
    }
    print("empty_step_median", "ns", median(rounds));
}

void paper_scene()
{
    std::vector<double> rounds;
    for (int r = 0; r < 11; ++r)
    {
        Loaded l = load_paper();
        const std::uint64_t before = simulation::now_ns();
        for (int i = 0; i < 2400; ++i) l.simulation->step();
        rounds.push_back(2400 / (static_cast<double>(simulation::now_ns() - before) * 1e-9));
    }
    print("paper_scene_median", "steps/s", median(rounds));
}

void swaps()
{
    Loaded l = load_paper();
    std::vector<double> pauses;
    for (int i = 0; i < 1000; ++i)
    {
        simulation::Request request;
        request.operations = {simulation::SwapOperation{"contact.response", i % 2 == 0 ? "Response/None" : "Response/Impulse", {}}};
        const simulation::Reply reply = l.simulation->carry_out_now(request);
        if (!reply.done) std::exit(1);
        pauses.push_back(reply.pause_ns * 1e-3);
        l.simulation->step();
    }
    print("swap_pause_median", "us", median(pauses));
    print("swap_pause_max", "us", *std::max_element(pauses.begin(), pauses.end()));
}

void start()
{
    std::vector<double> rounds;
    for (int r = 0; r < 11; ++r)
    {
        const std::uint64_t before = simulation::now_ns();
        Loaded l = load_paper();
        l.simulation->step();
        rounds.push_back(static_cast<double>(simulation::now_ns() - before) * 1e-6);
    }
    print("load_to_first_step_median", "ms", median(rounds));
}

/// After each step, as frames for the bus are: the bodies are not in the processor's caches.
void frames()
{
    const char* const field = R"(<plab version="1"><scene dt="1/60"/><component id="s" type="Shape/Sphere" radius="0.1"/>
        <repeat id="row" count="100 100" step="1 1 0"><component id="b" type="State/Kinematic" shape="s"
        angular_velocity="0 0 1"/></repeat></plab>)";
    Loaded l = load(blueprint::read_blueprint(field, "field.xml"));
    publish::Roster roster;
    (void)roster.update(l.simulation->world(), 0);
    std::vector<wire::Frame> ring(4);
    std::vector<double> rounds;
    for (std::size_t i = 0; i < 304; ++i)
    {
        l.simulation->step();
        const std::uint64_t before = simulation::now_ns();
        publish::fill_frame(*l.simulation, roster, ring[i % ring.size()]);
        if (i >= ring.size()) rounds.push_back(static_cast<double>(simulation::now_ns() - before) * 1e-3);
    }
    print("frame_of_10000_bodies_median", "us", median(rounds));
}

}  // namespace

int main()
{
    empty_step();
    paper_scene();
    swaps();
    start();
    frames();
    return 0;
}
