// What scenes of ten to fifty thousand elements cost, and how that grows. Prints the Markdown tables of server/docs/pace.md, and draws
// the growth if the name of a PNG file is given; takes about two minutes. Each case runs in a process of its own, whose processor time and
// memory are measured.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/pace_scenes.h"
#include "blueprint/reader.h"
#include "figures/axes.h"
#include "figures/drawing.h"
#include "model/compile.h"
#include "plab/random.h"
#include "plugins/library.h"
#include "simulation/simulation.h"
#include "support/text.h"

using namespace plab;
using namespace plab::bench;
using test::text;

namespace
{

constexpr double kMostSeconds = 4;  // of processor time per case, for stepping
constexpr double kMebi = 1 << 20;

/// What a case costs; made by a child process and sent through a pipe.
struct Figures
{
    double load = 0;      ///< s
    double first = 0;     ///< s, of the first step
    double step = 0;      ///< s, mean of the others
    double steps = 0;     ///< how many they are
    double contacts = 0;  ///< contact points in the last step
    double impacts = 0;   ///< located, per step
    double rates = 0;     ///< evaluations of the equations of motion per step, where the solver counts them
    double memory = 0;    ///< bytes, at the end, beyond what an empty scene takes
    double early = 0;     ///< s, mean of the first 30 steps after the first one
    double late = 0;      ///< s, mean of the last 60; 0: not so many steps were made
    double moved = 0;     ///< m, the farthest that a body is from where it was put
    double created = 0;   ///< J, by contacts
};

double processor_time()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_memory()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

[[noreturn]] void fail(const std::string& why)
{
    std::fprintf(stderr, "bench_pace: %s\n", why.c_str());
    std::exit(1);
}

double contact_points(const simulation::Simulation& simulation)
{
    double points = 0;
    for (const simulation::PairState& pair : simulation.stepper().contacts().pairs()) points += pair.count;
    return points;
}

/// Of a solver that counts them (those with error control), in the last step.
double evaluations(const simulation::Simulation& simulation)
{
    const world::World& world = simulation.world();
    const std::uint32_t solver = world.find("solver");
    if (solver == kNoIndex || !world.type_of(solver)->schema.find_field("evaluations")) return 0;
    return static_cast<double>(std::get<std::int64_t>(world.get(solver, "evaluations")));
}

/// m, the farthest that a body is from these positions.
double farthest_from(const std::vector<Vec3>& places, const std::vector<Vec3>& now)
{
    double most = 0;
    for (std::size_t b = 0; b < places.size(); ++b) most = std::max(most, length(now[b] - places[b]));
    return most;
}

Figures run_here(const std::string& scene_text, int most_steps)
{
    Figures out;
    const double idle = peak_memory();
    double begin = processor_time();
    const auto blueprint = blueprint::read_blueprint(scene_text, "case.xml");
    if (!blueprint) fail(blueprint.error().text());
    plugins::PluginLibrary library({PLAB_BINARY_DIR "/lib/plab"});
    const auto scene = model::compile(*blueprint, library);
    if (!scene) fail(scene.error().text());
    simulation::Simulation simulation(library);
    if (const auto loaded = simulation.load(*scene); !loaded) fail(loaded.error().text());
    out.load = processor_time() - begin;
    const std::vector<Vec3> places = simulation.world().host().bodies.position;
    begin = processor_time();
    simulation.step();
    out.first = processor_time() - begin;
    begin = processor_time();
    double last_60 = begin;
    for (int i = 0; i < most_steps; ++i)
    {
        if (i == 30) out.early = (processor_time() - begin) / 30;
        if (i == most_steps - 60) last_60 = processor_time();
        simulation.step();
        ++out.steps, out.impacts += simulation.stepper().report().events, out.rates += evaluations(simulation);
        if (processor_time() - begin > kMostSeconds) break;
    }
    out.step = (processor_time() - begin) / out.steps, out.impacts /= out.steps, out.rates /= out.steps;
    if (out.steps == most_steps) out.late = (processor_time() - last_60) / 60;
    out.contacts = contact_points(simulation);
    out.moved = farthest_from(places, simulation.world().host().bodies.position);
    for (const simulation::ContactEnergy& e : simulation.stepper().contact_energy()) out.created += e.created;
    out.memory = peak_memory() - idle;
    return out;
}

Figures measure(const std::string& scene_text, int most_steps)
{
    int ends[2];
    if (pipe(ends) != 0) fail("no pipe");
    std::fflush(stdout);
    const pid_t child = fork();
    if (child < 0) fail("no process");
    if (child == 0)
    {
        const Figures found = run_here(scene_text, most_steps);
        const bool written = write(ends[1], &found, sizeof found) == static_cast<ssize_t>(sizeof found);
        _exit(written ? 0 : 1);
    }
    close(ends[1]);
    Figures out;
    const bool whole = read(ends[0], &out, sizeof out) == static_cast<ssize_t>(sizeof out);
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (!whole || status != 0) fail("a case ended without figures");
    return out;
}

// Scenes --------------------------------------------------------------------------------------------------------------

/// Balls far from one another that bounce at random times, each impact located. `above`: m, of the lowest height.
std::string dropped_balls(int n, double above)
{
    std::string out = kGravity + kGround + component("s", "Shape/Sphere", "radius=\"0.1\"");
    std::uint64_t random = 5;
    const int side = static_cast<int>(std::ceil(std::sqrt(n)));
    for (int i = 0; i < n; ++i) out += body(i, {2.0 * (i % side), 2.0 * (i / side), 0.1 + above + 4 * next_uniform(random)});
    return scene("1/240", out + component("contact", "CDetection/ODE",
                                          "between=\"*\" resolution=\"Resolution/LocalRoot\" response=\"Response/Impulse\" "
                                          "response.restitution=\"0.95\""));
}

/// The same balls out of reach of the ground show what a step costs without an impact.
void impacts_table()
{
    std::printf(
        "\n| balls dropped | impacts a step | step, ms | CPU s per simulated s | without impacts, ms | us each impact | against the first "
        "row "
        "|\n|---|---|---|---|---|---|---|\n");
    double first = 0;
    for (const int n : {100, 1000, 10000})
    {
        const Figures with = measure(dropped_balls(n, 0.2), 720), without = measure(dropped_balls(n, 1000), 720);
        const double each = (with.step - without.step) / with.impacts;
        if (first == 0) first = each;
        std::printf("| %d | %.3g | %.3g | %.3g | %.3g | %.3g | %.2f |\n", n, with.impacts, with.step * 1e3, with.step * 240,
                    without.step * 1e3, each * 1e6, each / first);
    }
}

std::string gears(const char* algorithm, int n)
{
    std::string out;
    for (int i = 0; i <= n; ++i) out += component(numbered("s", i), "State/Shaft", "inertia=\"1\" axis=\"0 0 1\"");
    out += component("load", "Field/Load", "between=\"s0\" shaft_torque=\"1\"");
    for (int i = 0; i < n; ++i)
        out += component(numbered("g", i), std::string("Constraint/AngularVelocity/") + algorithm,
                         "driver=\"" + numbered("s", i) + "\" driven=\"" + numbered("s", i + 1) + "\" velocity_factor=\"-1\"");
    return scene("1/240", out);
}

/// A chain of links that hangs from the world and is released level.
std::string hinges(int n, const std::string& solver)
{
    std::string out = kGravity + component("solver", "Solver/" + solver, "");
    for (int i = 0; i < n; ++i)
    {
        out += body(i, {0.5 * i + 0.25, 0, 0}, "mass=\"1\" inertia=\"0.01 0.03 0.03\" solver=\"solver\"");
        const std::string before = i == 0 ? "" : "a=\"" + numbered("b", i - 1) + "\" ";
        out += component(numbered("h", i), "Constraint/Hinge",
                         before + "b=\"" + numbered("b", i) + "\" anchor=\"" + text(Vec3{0.5 * i, 0, 0}) + "\" axis=\"0 1 0\"");
    }
    return scene("1/240", out);
}

/// Solvers with error control take more internal steps in a longer chain, which whips faster: cost per evaluation as well.
void chains_table()
{
    std::printf("\n| links of a chain | solver | evaluations a step | step, us each | us each and evaluation |\n|---|---|---|---|---|\n");
    for (const char* solver : {"DormandPrince54", "Articulated"})
        for (const int n : {10, 100, 1000})
        {
            const Figures f = measure(hinges(n, solver), 2000);
            const double each = f.step * 1e6 / n;
            std::printf("| %d | %s | %.3g | %.3g | %.3g |\n", n, solver, f.rates, each, each / f.rates);
        }
}

/// Each damps the relative motion of two shafts.
std::string scripts(int n)
{
    std::string out;
    for (int i = 0; i < n; ++i)
        out += component(numbered("a", i), "State/Shaft", "inertia=\"1\" axis=\"0 0 1\" angular_velocity=\"1\"") +
               component(numbered("b", i), "State/Shaft", "inertia=\"1\" axis=\"0 0 1\"") + "<component id=\"" + numbered("c", i) +
               "\" type=\"Script/Lua\" driver=\"" + numbered("a", i) + "\" driven=\"" + numbered("b", i) +
               "\"><param name=\"code\">function force(t, state) driven:add_torque(0.01 * (driver.speed - driven.speed)) "
               "end</param></component>\n";
    return scene("1/240", out);
}

// Tables --------------------------------------------------------------------------------------------------------------

void scenes_table()
{
    std::printf(
        "| scene | dt | contact points | first step, ms | step, ms | CPU s per simulated s | memory, MB "
        "|\n|---|---|---|---|---|---|---|\n");
    const auto row = [](const char* name, const char* dt_text, double dt, const std::string& text, int steps)
    {
        const Figures f = measure(text, steps);
        std::printf("| %s | %s | %.0f | %.3g | %.3g | %.3g | %.0f |\n", name, dt_text, f.contacts, f.first * 1e3, f.step * 1e3, f.step / dt,
                    f.memory / kMebi);
    };
    row("wall of 1000 bricks", "1/60", 1.0 / 60, wall(40, 25), 120);
    row("pile of 5000 cubes", "1/60", 1.0 / 60, pile(5000), 120);
    row("10,000 balls", "1/60", 1.0 / 60, balls(10000), 120);
    row("1000 tumbled boxes", "1/60", 1.0 / 60, tumbled("Shape/Box", "half_extents=\"0.1 0.1 0.1\"", 1000), 120);
    row("1000 tumbled capsules", "1/60", 1.0 / 60, tumbled("Shape/Capsule", "radius=\"0.07\" length=\"0.15\"", 1000), 120);
    row("1000 tumbled cylinders", "1/60", 1.0 / 60, tumbled("Shape/Cylinder", "radius=\"0.1\" height=\"0.2\"", 1000), 120);
    row("1000 tumbled hulls of 20 corners", "1/60", 1.0 / 60, tumbled("Shape/ConvexHull", "points=\"" + twenty_corners() + "\"", 1000),
        120);
    row("40 chains of five boxes", "1/240", 1.0 / 240, chains_in_a_heap(40), 480);
    row("100 robots of four legs, nothing named", "1/240", 1.0 / 240, four_legged(100), 480);
    row("chain of 100 links with 1000 kg", "1/240", 1.0 / 240, heavy_chain(100), 120);
    row("200 balls and boxes, nothing named", "1/240", 1.0 / 240, newcomers_heap(200), 480);
    row("1000 balls and boxes, nothing named", "1/240", 1.0 / 240, newcomers_heap(1000), 480);
}

/// What stands where it is put, and is to stay there, at dt 1/60 for 10 s.
void rest_table()
{
    std::printf(
        "\n| scene at rest | manager | first step, ms | a step of the next 0.5 s, ms | a step at the end, ms | moved, m | energy made, J "
        "|\n|---|---|---|---|---|---|---|\n");
    const auto row = [](const char* name, const char* manager, const std::string& text)
    {
        const Figures f = measure(text, 600);
        std::printf("| %s | %s | %.3g | %.3g | %.3g | %.2g | %.2g |\n", name, manager, f.first * 1e3, f.early * 1e3, f.late * 1e3, f.moved,
                    f.created);
    };
    row("tower of 30 cubes", "nothing named", tower(30));
    row("the same", "SoftStep", tower(30, "SoftStep"));
    row("pyramid of 210 cubes", "nothing named", pyramid(20));
    row("the same", "SoftStep", pyramid(20, "SoftStep"));
    row("10,000 cubes apart", "nothing named", cubes_apart(10000));
}

/// What was measured with `count` elements of a kind, per element; `step` per contact point in the rows of heaps.
struct GrowthPoint
{
    double count = 0, load = 0, step = 0, memory = 0;  ///< 1, us, us, kB
};
struct Growth
{
    std::string kind;
    std::vector<GrowthPoint> points;
};

/// Elements of one kind, for each of the counts: cost per element and its growth.
Growth growth_table(const char* kind, const std::vector<int>& counts, int steps, const std::function<std::string(int)>& make,
                    bool per_contact = false)
{
    std::printf(
        "\n| %s | load, us each | first step, us each | step, us each%s | memory, kB each%s | step against the first row "
        "|\n|---|---|---|---|---|---|%s\n",
        kind, per_contact ? " contact point" : "", per_contact ? " | memory, kB each contact point" : "", per_contact ? "---|" : "");
    Growth out{kind, {}};
    for (const int n : counts)
    {
        const Figures f = measure(make(n), steps);
        const double each = 1e6 / n;
        out.points.push_back({double(n), f.load * each, f.step * 1e6 / (per_contact ? f.contacts : n), f.memory / 1024 / n});
        const GrowthPoint& p = out.points.back();
        std::printf("| %d | %.3g | %.3g | %.3g | %.3g |", n, p.load, f.first * each, p.step, p.memory);
        if (per_contact) std::printf(" %.3g |", f.memory / 1024 / f.contacts);
        std::printf(" %.2f |\n", p.step / out.points.front().step);
    }
    return out;
}

// Picture -------------------------------------------------------------------------------------------------------------

constexpr double kPanelWidth = 430, kPanelHeight = 380, kLeft = 60, kRight = 20, kTop = 36, kBottom = 50, kFoot = 34;  // px

void draw_panel_of(figures::Drawing& drawing, double left, const char* title, const std::vector<Growth>& all, double GrowthPoint::*value)
{
    using figures::Scale;
    std::vector<double> counts, values;
    for (const Growth& g : all)
        for (const GrowthPoint& p : g.points) counts.push_back(p.count), values.push_back(p.*value);
    figures::Panel panel{left + kLeft, kTop, kPanelWidth - kLeft - kRight, kPanelHeight - kTop - kBottom, {}, {}, {}};
    panel.x = Scale::around(Scale::Kind::Log, counts);
    panel.y = Scale::around(Scale::Kind::Log, values);
    drawing.words({panel.left, kTop - 12}, title, {13, {figures::Ink::Role::Text}, figures::Anchor::Start, true});
    figures::draw_panel(drawing, panel, "elements", "");
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        const figures::Ink ink = figures::Ink::series(static_cast<int>(i));
        std::vector<figures::Spot> line;
        for (const GrowthPoint& p : all[i].points) line.push_back(panel.at(p.count, p.*value));
        for (const figures::Spot& at : line) drawing.marker(at, static_cast<int>(i) % figures::Drawing::kMarkers, 4, ink, true);
        drawing.line(std::move(line), {ink, 1.8, false});
    }
}

/// Three panels, one line per kind: cost of a step, of loading, and memory, each per element.
void draw_growth(const std::vector<Growth>& all, const std::string& path)
{
    figures::Drawing drawing(3 * kPanelWidth, kPanelHeight + kFoot, "Cost per element against the number of elements");
    draw_panel_of(drawing, 0, "a step, us per element (heaps: per contact point)", all, &GrowthPoint::step);
    draw_panel_of(drawing, kPanelWidth, "loading, us per element", all, &GrowthPoint::load);
    draw_panel_of(drawing, 2 * kPanelWidth, "memory, kB per element", all, &GrowthPoint::memory);
    double x = kLeft;
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        const double y = kPanelHeight + 8;
        drawing.marker({x, y - 4}, static_cast<int>(i) % figures::Drawing::kMarkers, 5, figures::Ink::series(static_cast<int>(i)), true);
        drawing.words({x + 10, y}, all[i].kind, {12, {figures::Ink::Role::Text}});
        x += 34 + figures::text_width(all[i].kind, 12);
    }
    if (const auto written = drawing.write_png(path); !written) fail(written.error().text());
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc > 2 || (argc == 2 && argv[1][0] == '-'))
    {
        std::puts(
            "usage: bench_pace [FILE.png]\nPrints what large scenes cost as tables, and draws the growth into the file; about two "
            "minutes.");
        return argc == 2 && std::strcmp(argv[1], "--help") == 0 ? 0 : 2;
    }
    scenes_table();
    rest_table();
    impacts_table();
    const std::vector<int> tens{10, 100, 1000, 10000}, hundreds{100, 1000, 10000};
    std::vector<Growth> all;
    all.push_back(growth_table("free bodies", {100, 1000, 10000, 50000}, 2000, free_bodies));
    all.push_back(growth_table("cubes in a pile", hundreds, 120, pile, true));
    all.push_back(growth_table("balls in a box", hundreds, 120, balls, true));
    all.push_back(growth_table("cubes in threes on springs", {48, 192, 768}, 40, stacks_on_springs));
    all.push_back(growth_table("gears, Graph", tens, 2000, [](int n) { return gears("Graph", n); }));
    all.push_back(growth_table("gears, Impulse", tens, 2000, [](int n) { return gears("Impulse", n); }));
    all.push_back(growth_table("links of a chain", tens, 2000, [](int n) { return hinges(n, "Automatic"); }));
    all.push_back(growth_table("scripts", tens, 2000, scripts));
    for (const std::string solver : {"RungeKutta4", "SemiImplicitEuler"})
        (void)growth_table(("links of a chain, " + solver).c_str(), {10, 100, 1000}, 2000, [&](int n) { return hinges(n, solver); });
    chains_table();
    if (argc > 1) draw_growth(all, argv[1]);
    return 0;
}
