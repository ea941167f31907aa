// For how long a swap stops the loop, against the number of bodies beside it or in it, free and in contact. Prints a Markdown table:
// medians and the longest of the pauses in ms and their CPU time, the objects that the trial steps, how many swaps were proved, and the CPU
// time of the steps right after a swap and of the steps before the next one (medians). Names of cases, a number of bodies and swaps=N may
// be given as arguments.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "blueprint/reader.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "simulation/simulation.h"
#include "support/text.h"

using namespace plab;
using test::text;

namespace
{

constexpr int kSettle = 20;  // steps before the first swap

[[noreturn]] void fail(const std::string& why)
{
    std::fprintf(stderr, "bench_swap: %s\n", why.c_str());
    std::exit(1);
}

std::string component(const std::string& id, const std::string& type, const std::string& more)
{
    return "<component id=\"" + id + "\" type=\"" + type + "\" " + more + "/>\n";
}

/// Two gears with a solver of their own.
const std::string kMechanism = component("own", "Solver/RungeKutta4", "") + component("s0", "State/Shaft", "inertia=\"1\" solver=\"own\"") +
                               component("s1", "State/Shaft", "inertia=\"2\" solver=\"own\" angular_velocity=\"0.5\"") +
                               component("load", "Field/Load", "between=\"s0\" shaft_torque=\"1\"") +
                               component("gear", "Constraint/AngularVelocity/Graph", "driver=\"s0\" driven=\"s1\" velocity_factor=\"-1\"");

std::string body(int i, const Vec3& at)
{
    return component("b" + std::to_string(i), "State/RigidBody", "shape=\"s\" mass=\"1\" solver=\"common\" position=\"" + text(at) + "\"");
}

/// Between two columns of the pile, or two free bodies.
std::string spring(bool contact)
{
    return component("spring", "Constraint/SpringDamper",
                     contact ? "a=\"b4\" b=\"b15\" length=\"0.5\" stiffness=\"10\"" : "a=\"b4\" b=\"b5\" length=\"2\" stiffness=\"10\"");
}

enum class Beside : std::uint8_t
{
    Free,
    Pile,
    Gears,
    Springs,
};

/// n mechanisms of two shafts each.
std::string gears(int n)
{
    std::string out = "<plab version=\"1\"><scene dt=\"1/60\"/>\n" + component("own", "Solver/RungeKutta4", "");
    for (int i = 0; i < n; ++i)
    {
        const std::string k = std::to_string(i);
        out +=
            component("a" + k, "State/Shaft", "inertia=\"1\" solver=\"own\" angular_velocity=\"0.5\"") +
            component("b" + k, "State/Shaft", "inertia=\"2\" solver=\"own\"") +
            component("gear" + k, "Constraint/AngularVelocity/Graph", "driver=\"a" + k + "\" driven=\"b" + k + "\" velocity_factor=\"-1\"");
    }
    return out + "</plab>";
}

/// n weights on springs, each with a solver of its own.
std::string springs(int n)
{
    std::string out = "<plab version=\"1\"><scene dt=\"1/60\"/>\n" + component("gravity", "Field/Gravity", "between=\"*\"") +
                      component("s", "Shape/Box", "half_extents=\"0.25 0.25 0.25\"");
    for (int i = 0; i < n; ++i)
    {
        const std::string k = std::to_string(i), x = std::to_string(2 * (i % 100)), y = std::to_string(2 * (i / 100));
        out +=
            component("engine" + k, "Solver/RungeKutta4", "") +
            component("hook" + k, "State/Static", "position=\"" + x + " " + y + " 1\"") +
            component("b" + k, "State/RigidBody", "shape=\"s\" mass=\"1\" solver=\"engine" + k + "\" position=\"" + x + " " + y + " 0\"") +
            component("spring" + k, "Constraint/SpringDamper", "a=\"hook" + k + "\" b=\"b" + k + "\" length=\"1\" stiffness=\"100\"");
    }
    return out + "</plab>";
}

std::string scene(int n, Beside beside)
{
    if (beside == Beside::Gears) return gears(n);
    if (beside == Beside::Springs) return springs(n);
    const bool contact = beside == Beside::Pile;
    std::string out = "<plab version=\"1\"><scene dt=\"1/60\"/>\n" + kMechanism + component("common", "Solver/SemiImplicitEuler", "") +
                      component("gravity", "Field/Gravity", "between=\"*\"") +
                      component("s", "Shape/Box", "half_extents=\"0.25 0.25 0.25\"");
    const int side = std::max(1, n / 100);
    for (int i = 0; i < n; ++i)
        out += body(i, contact ? Vec3{0.55 * (i / 10 % side), 0.55 * (i / 10 / side), 0.251 + 0.501 * (i % 10)}
                               : Vec3{2.0 * (i % 100), 2.0 * (i / 100), 0});
    if (contact)
        out += component("plane", "Shape/Plane", "") + component("ground", "State/Static", "shape=\"plane\"") +
               component("manager", "Manager/SoftStep", "substeps=\"4\"") +
               component("contact", "CDetection/ODE",
                         "between=\"*\" resolution=\"Resolution/None\" response=\"Response/Rows\" response.manager=\"manager\" "
                         "response.friction=\"0.8\"");
    return out + spring(contact) + "</plab>";
}

struct Case
{
    const char* name;
    const char* id;
    const char* types[2];
    Beside beside;
    bool proof = true;  // governors exchange levels without one
};

const Case kCases[] = {
    {"gear beside free bodies", "gear", {"Constraint/AngularVelocity/Impulse", "Constraint/AngularVelocity/Graph"}, Beside::Free},
    {"spring between two free bodies", "spring", {"Constraint/SpringDamper", "Constraint/SpringDamper"}, Beside::Free},
    {"gear beside a pile", "gear", {"Constraint/AngularVelocity/Impulse", "Constraint/AngularVelocity/Graph"}, Beside::Pile},
    {"solver of the gears beside a pile", "own", {"Solver/DormandPrince54", "Solver/RungeKutta4"}, Beside::Pile},
    {"spring between two columns of a pile", "spring", {"Constraint/SpringDamper", "Constraint/SpringDamper"}, Beside::Pile},
    {"one gear of many", "gear7", {"Constraint/AngularVelocity/Impulse", "Constraint/AngularVelocity/Graph"}, Beside::Gears},
    {"all gears", "gear*", {"Constraint/AngularVelocity/Impulse", "Constraint/AngularVelocity/Graph"}, Beside::Gears},
    {"solver of all free bodies", "common", {"Solver/RungeKutta4", "Solver/SemiImplicitEuler"}, Beside::Free},
    {"field of all free bodies", "gravity", {"Field/Gravity", "Field/Gravity"}, Beside::Free},
    {"manager of the pile", "manager", {"Manager/SequentialImpulse", "Manager/SoftStep"}, Beside::Pile},
    {"solvers of ten weights on springs, no trial", "engine1?", {"Solver/DormandPrince54", "Solver/RungeKutta4"}, Beside::Springs, false},
    {"response of the pile", "contact.response", {"Response/Rows", "Response/Rows"}, Beside::Pile},
};

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// ms of this thread: other processes do not count, so a busy machine can be measured.
double cpu_time()
{
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// ms
double time_of_step(simulation::Simulation& simulation)
{
    const double begin = cpu_time();
    simulation.step();
    return cpu_time() - begin;
}

void measure(const Case& c, int n, int swaps)
{
    const auto blueprint = blueprint::read_blueprint(scene(n, c.beside), "case.xml");
    if (!blueprint) fail(blueprint.error().text());
    plugins::PluginLibrary library({PLAB_BINARY_DIR "/lib/plab"});
    const auto compiled = model::compile(*blueprint, library);
    if (!compiled) fail(compiled.error().text());
    simulation::Simulation simulation(library);
    if (const auto loaded = simulation.load(*compiled); !loaded) fail(loaded.error().text());
    for (int i = 0; i < kSettle; ++i) simulation.step();
    std::vector<double> pauses, cpu, first, usual;
    int proven = 0;
    std::size_t objects = 0;
    for (int i = 0; i < swaps; ++i)
    {
        simulation::Request request;
        request.trial.budget = c.proof ? simulation::TrialChoice::Budget::Automatic : simulation::TrialChoice::Budget::None;
        request.operations = {simulation::SwapOperation{c.id, c.types[i % 2], {}}};
        const double begin = cpu_time();
        const simulation::Reply reply = simulation.carry_out_now(request);
        cpu.push_back(cpu_time() - begin);
        if (!reply.done) fail(reply.errors.front().text());
        pauses.push_back(1e-6 * reply.pause_ns);
        proven += reply.trial.outcome == simulation::TrialReport::Outcome::Made ? 1 : 0;
        objects = reply.trial.objects;
        first.push_back(time_of_step(simulation));
        simulation.step();
        usual.push_back(time_of_step(simulation));
    }
    std::printf("| %s | %d | %.3g | %.3g | %.3g | %zu | %d of %d | %.3g | %.3g |\n", c.name, n, median(pauses),
                *std::max_element(pauses.begin(), pauses.end()), median(cpu), objects, proven, swaps, median(first), median(usual));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv)
{
    std::vector<int> counts = {100, 1000, 10000};
    int swaps = 11;
    std::vector<std::string> names;
    for (int i = 1; i < argc; ++i)
        if (std::atoi(argv[i]) > 0)
            counts = {std::atoi(argv[i])};
        else if (std::strncmp(argv[i], "swaps=", 6) == 0)
            swaps = std::max(1, std::atoi(argv[i] + 6));
        else
            names.emplace_back(argv[i]);
    std::printf(
        "| swap | bodies | pause, ms | longest, ms | CPU, ms | objects in the trial | with a proof | next step, ms | usual step, ms |\n");
    std::printf("|---|---|---|---|---|---|---|---|---|\n");
    for (const Case& c : kCases)
        if (names.empty() || std::find(names.begin(), names.end(), c.name) != names.end())
            for (const int n : counts) measure(c, n, swaps);
    return 0;
}
