// The cost of a step with each algorithm of the ladders, in small standard scenes: a Markdown table on standard output.
//
//   build/bin/bench_algorithms [FAMILY ...]     beginnings of type names: Solver Resolution Response Manager Constraint (default: all)
//   build/bin/bench_algorithms --measured       the rows of server/model/measured_costs.h, which the reference and plabctl types print
//
// Types come from the registry, so a new algorithm appears by itself. The figure is the least mean of five runs, microseconds per step
// of 1/240 s, one thread, no bus.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

#include "model/measured_costs.h"
#include "plab/interruption.h"
#include "simulation/costs/clock.h"
#include "support/load.h"

using namespace plab;
using plab::test::library;
using plab::test::load_text;
using plab::test::whole_scene;

namespace
{

constexpr int kRuns = 5;
constexpr int kSteps = 1200;  // 5 s

/// us per step.
Result<double> cost_of(const std::string& text)
{
    double least = 1e300;
    for (int run = 0; run < kRuns; ++run)
    {
        auto simulation = load_text(text, "algorithm.xml");
        if (!simulation) return simulation.errors();
        const std::uint64_t before = simulation::now_ns();
        for (int i = 0; i < kSteps; ++i) (*simulation)->step();
        least = std::min(least, static_cast<double>(simulation::now_ns() - before) * 1e-3 / kSteps);
    }
    return least;
}

std::string cell_of(const Result<double>& cost)
{
    if (!cost)
    {
        std::string why = cost.error().reason.substr(0, 90);
        std::replace(why.begin(), why.end(), '|', '/');
        return why;
    }
    char text[32];
    std::snprintf(text, sizeof text, *cost < 10 ? "%.2f" : "%.1f", *cost);
    return text;
}

// Scenes ---------------------------------------------------------------------------------------------------------------

const std::string kGravity = "<component id=\"gravity\" type=\"Field/Gravity\" between=\"*\"/>";

std::string scene(const std::string& body, const std::string& settings = "") { return whole_scene(body, "dt=\"1/240\" " + settings); }

std::string body(const std::string& id, const std::string& where, const std::string& more = "")
{
    return "<component id=\"" + id + "\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 2 3\" position=\"" + where + "\" " + more + "/>";
}

std::string cubes_on_ground(int n)
{
    std::string out =
        "<component id=\"plane\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"plane\"/>"
        "<component id=\"cube\" type=\"Shape/Box\" half_extents=\"0.5 0.5 0.5\"/>";
    for (int i = 0; i < n; ++i)
        out += "<component id=\"cube" + std::to_string(i) + "\" type=\"State/RigidBody\" mass=\"1\" shape=\"cube\" position=\"0 0 " +
               std::to_string(i) + ".5\"/>";
    return out + kGravity;
}

std::string contact(const std::string& more) { return "<component id=\"contact\" type=\"CDetection/ODE\" between=\"*\" " + more + "/>"; }

std::string free_body(const std::string& solver)
{
    return scene(body("top", "0 0 0", "angular_velocity=\"0.1 5 0.1\"") + kGravity, "solver=\"" + solver + "\"");
}

std::string swinging_chain(const std::string& solver)
{
    return scene(body("a", "0.5 0 0") + body("b", "1.5 0 0") + body("c", "2.5 0 0") +
                     "<component id=\"j1\" type=\"Constraint/Hinge\" b=\"a\" anchor=\"0 0 0\" axis=\"0 1 0\"/>"
                     "<component id=\"j2\" type=\"Constraint/Hinge\" a=\"a\" b=\"b\" anchor=\"1 0 0\" axis=\"0 1 0\"/>"
                     "<component id=\"j3\" type=\"Constraint/Hinge\" a=\"b\" b=\"c\" anchor=\"2 0 0\" axis=\"0 1 0\"/>" +
                     kGravity,
                 "solver=\"" + solver + "\"");
}

std::string bouncing_ball(const std::string& resolution, const std::string& response)
{
    return scene(
        "<component id=\"plane\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"plane\"/>"
        "<component id=\"form\" type=\"Shape/Sphere\" radius=\"0.1\"/>"
        "<component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" shape=\"form\" position=\"0 0 1.1\"/>" +
        kGravity + contact("resolution=\"" + resolution + "\" response=\"" + response + "\" response.restitution=\"1\""));
}

// Families -------------------------------------------------------------------------------------------------------------

struct Algorithm
{
    std::string name;
    const model::ComponentType* type = nullptr;
};

std::vector<Algorithm> algorithms_of(const std::string& family)
{
    std::vector<Algorithm> out;
    for (const std::string& name : library().names())
    {
        if (name.rfind(family + "/", 0) != 0) continue;
        if (const auto type = library().require(name)) out.push_back({name, *type});
    }
    return out;
}

void print_head(const std::string& family, const std::vector<std::string>& columns)
{
    std::printf("\n### %s\n\n| type | order |", family.c_str());
    for (const std::string& c : columns) std::printf(" %s |", c.c_str());
    std::printf(" declared cost |\n|---|---:|");
    for (std::size_t i = 0; i < columns.size(); ++i) std::printf("---:|");
    std::printf("---|\n");
}

void print_row(const Algorithm& algorithm, const std::vector<std::string>& cells)
{
    const TypeInfo& info = algorithm.type->info;
    std::printf("| `%s` | %s |", algorithm.name.c_str(), info.order > 0 ? std::to_string(info.order).c_str() : "");
    for (const std::string& c : cells) std::printf(" %s |", c.c_str());
    std::printf(" %s |\n", info.cost.c_str());
    std::fflush(stdout);
}

void solvers()
{
    print_head("Solver", {"free body, us", "3 hinged bodies, us"});
    for (const Algorithm& r : algorithms_of("Solver"))
        print_row(r, {cell_of(cost_of(free_body(r.name))), cell_of(cost_of(swinging_chain(r.name)))});
}

void resolutions()
{
    print_head("Resolution", {"ball, 5 bounces in 1200 steps, us"});
    for (const Algorithm& r : algorithms_of("Resolution"))
        print_row(r, {cell_of(cost_of(bouncing_ball(r.name, r.type->info.speculates ? "Response/Rows" : "Response/Impulse")))});
}

void responses()
{
    print_head("Response", {"cube at rest, us"});
    for (const Algorithm& r : algorithms_of("Response"))
        print_row(r, {cell_of(cost_of(scene(cubes_on_ground(1) + contact("resolution=\"Resolution/None\" response=\"" + r.name + "\""))))});
}

void managers()
{
    print_head("Manager", {"5 cubes stacked, us", "20 cubes stacked, us"});
    for (const Algorithm& r : algorithms_of("Manager"))
    {
        const auto stack = [&r](int n)
        {
            return scene(cubes_on_ground(n) + "<component id=\"manager\" type=\"" + r.name + "\"/>" +
                         "<component id=\"contact.response\" type=\"Response/Rows\" manager=\"manager\" friction=\"0.8\"/>" +
                         contact("resolution=\"Resolution/None\""));
        };
        print_row(r, {cell_of(cost_of(stack(5))), cell_of(cost_of(stack(20)))});
    }
}

// Measured costs by kind of scene --------------------------------------------------------------------------------------

/// Processor time of this process, ns: other programs on the machine do not count.
std::uint64_t processor_ns()
{
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<std::uint64_t>(t.tv_sec) * 1'000'000'000 + static_cast<std::uint64_t>(t.tv_nsec);
}

double median_of(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

constexpr double kGivenUp = std::numeric_limits<double>::infinity();

/// us per step of one run: median of at most 240 steps after ten that warm up, or of as many as fit into half a second: a type
/// whose step is expensive gets few, at least one. kGivenUp: the first step took longer than model::kDearestStep.
Result<double> cost_of_run(const std::string& text)
{
    constexpr std::uint64_t kLongestWarming = 4'000'000'000, kLongest = 500'000'000;
    constexpr std::size_t kWarm = 10, kMost = 240;
    auto simulation = load_text(text, "algorithm.xml");
    if (!simulation) return simulation.errors();
    Interruption deadline;
    deadline.ask(std::chrono::seconds(model::kDearestStep));
    (*simulation)->set_interruption(&deadline);
    std::uint64_t begin = processor_ns();
    for (std::size_t i = 0; i < kWarm && processor_ns() - begin < kLongestWarming; ++i)
    {
        if ((*simulation)->step()) continue;
        if (i == 0) return kGivenUp;
        break;
    }
    (*simulation)->set_interruption(nullptr);
    begin = processor_ns();
    std::vector<double> us;
    while (us.size() < kMost && (us.empty() || processor_ns() - begin < kLongest))
    {
        const std::uint64_t before = processor_ns();
        (*simulation)->step();
        us.push_back(static_cast<double>(processor_ns() - before) * 1e-3);
    }
    return median_of(std::move(us));
}

/// us per step: the median of three runs' medians; of one run where that takes seconds.
Result<double> median_cost(const std::string& text)
{
    constexpr std::uint64_t kLong = 1'500'000'000;
    std::vector<double> runs;
    for (const std::uint64_t begin = processor_ns(); runs.size() < 3 && (runs.empty() || processor_ns() - begin < kLong);)
    {
        auto run = cost_of_run(text);
        if (!run) return run.errors();
        runs.push_back(*run);
    }
    return median_of(std::move(runs));
}

/// `stacks` stacks of `high` cubes each, 3 m apart, at rest, with friction.
std::string stacks_on_ground(int stacks, int high, const std::string& answer)
{
    std::string out =
        "<component id=\"plane\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"plane\"/>"
        "<component id=\"cube\" type=\"Shape/Box\" half_extents=\"0.5 0.5 0.5\"/>";
    for (int k = 0; k < stacks; ++k)
        for (int i = 0; i < high; ++i)
            out += "<component id=\"cube" + std::to_string(k) + "_" + std::to_string(i) +
                   "\" type=\"State/RigidBody\" mass=\"1\" shape=\"cube\" position=\"" + std::to_string(3 * k) + " 0 " + std::to_string(i) +
                   ".5\"/>";
    return scene(out + kGravity + contact("response.friction=\"0.6\" " + answer));
}

std::string free_bodies(int n, const std::string& solver)
{
    std::string out;
    for (int i = 0; i < n; ++i) out += body("b" + std::to_string(i), std::to_string(2 * i) + " 0 0", "angular_velocity=\"0.1 5 0.1\"");
    return scene(out + kGravity + "<component id=\"air\" type=\"Field/Drag\" between=\"*\" linear=\"0.1\"/>", "solver=\"" + solver + "\"");
}

/// Lines of `length` shafts, each of which turns the next one, with drag so that there is always something to do.
std::string lines_of_shafts(int lines, int length, const std::string& coupling)
{
    std::string out;
    for (int k = 0; k < lines; ++k)
        for (int i = 0; i < length; ++i)
        {
            const std::string line = std::to_string(k) + "_", me = line + std::to_string(i);
            out += "<component id=\"s" + me + "\" type=\"State/Shaft\" inertia=\"1\" angular_velocity=\"3\"/>";
            if (i > 0)
                out += "<component id=\"g" + me + "\" type=\"" + coupling + "\" driver=\"s" + line + std::to_string(i - 1) +
                       "\" driven=\"s" + me + "\" velocity_factor=\"1\"/>";
        }
    return scene(out + "<component id=\"air\" type=\"Field/Drag\" between=\"*\" rotational=\"0.1\"/>");
}

void print_measured(const std::string& type, const std::string& few, const std::string& many, const std::string& tied)
{
    std::string out = "    {\"" + type + "\"";
    for (const std::string& text : {few, many, tied})
    {
        const auto cost = median_cost(text);
        if (!cost) std::fprintf(stderr, "%s: %s\n", type.c_str(), cost.error().text().c_str());
        char figure[32];
        std::snprintf(figure, sizeof figure, ", %.3g", cost ? *cost : -1.0);
        out += cost && *cost == kGivenUp ? ", kDear" : figure;
    }
    std::printf("%s},\n", out.c_str());
    std::fflush(stdout);
}

/// Three kinds of scene for each family: few, many, and many that depend on one another (server/model/measured_costs.h has them in words).
void measured()
{
    const auto contacts = [](const std::string& type, const std::string& answer)
    { print_measured(type, stacks_on_ground(1, 1, answer), stacks_on_ground(64, 3, answer), stacks_on_ground(1, 20, answer)); };
    const std::string none = "resolution=\"Resolution/None\" ";
    for (const Algorithm& r : algorithms_of("Manager"))
        contacts(r.name, none + "response=\"Response/Rows\" response.manager=\"" + r.name + "\"");
    for (const Algorithm& r : algorithms_of("Resolution")) contacts(r.name, "resolution=\"" + r.name + "\" response=\"Response/Rows\"");
    for (const Algorithm& r : algorithms_of("Response"))
        if (r.name != "Response/None") contacts(r.name, none + "response=\"" + r.name + "\"");  // it has no response
    for (const Algorithm& r : algorithms_of("Solver"))
        print_measured(r.name, free_bodies(1, r.name), free_bodies(192, r.name), swinging_chain(r.name));
    for (const Algorithm& r : algorithms_of("Constraint/AngularVelocity"))
        print_measured(r.name, lines_of_shafts(1, 2, r.name), lines_of_shafts(96, 2, r.name), lines_of_shafts(1, 20, r.name));
    std::fprintf(stderr, "%.0f s of processor time\n", static_cast<double>(processor_ns()) * 1e-9);
}

/// A valid value for a parameter without default.
std::string some_value(const Field& field)
{
    for (const Rule& rule : field.rules)
        if (rule.kind == Rule::Kind::OneOf) return rule.options.front();
    return field.type == FieldType::Vector ? "1 2 3" : "1";
}

/// Participants for a role: bodies or shafts in turn.
std::string some_participants(const Role& role, std::size_t& next)
{
    const bool shafts = std::count(role.facets.begin(), role.facets.end(), Facet::Body) == 0;
    const std::size_t n = std::max<std::size_t>(role.max > 1 ? 2 : 1, role.min);
    std::string out;
    for (std::size_t i = 0; i < n; ++i) out += (i > 0 ? " " : "") + std::string(shafts ? "shaft" : "body") + std::to_string(next++ % 3);
    return out;
}

std::string constraint_scene(const model::ComponentType* type)
{
    std::string out = kGravity;
    for (int i = 0; i < 3; ++i)
    {
        const std::string n = std::to_string(i);
        out +=
            body("body" + n, n + " 0 0") + "<component id=\"shaft" + n + "\" type=\"State/Shaft\" inertia=\"1\" angular_velocity=\"0\"/>";
    }
    if (type == nullptr) return scene(out);
    std::size_t next = 0;
    out += "<component id=\"manager\" type=\"Manager/SequentialImpulse\"/><component id=\"algorithm\" type=\"" + type->info.name + "\"";
    for (const Role& role : type->schema.roles())
    {
        const bool objects =
            std::any_of(role.facets.begin(), role.facets.end(), [](Facet f) { return f == Facet::Body || f == Facet::Shaft; });
        if (objects) out += " " + role.name + "=\"" + some_participants(role, next) + "\"";
        if (role.name == "manager") out += " manager=\"manager\"";
    }
    for (const Field& field : type->schema.fields())
        if (field.required && field.kind == FieldKind::Param) out += " " + field.name + "=\"" + some_value(field) + "\"";
    return scene(out + "/>");
}

void constraints()
{
    const auto without = cost_of(constraint_scene(nullptr));
    print_head("Constraint", {"3 free bodies and shafts with it, us", "more than without, us"});
    for (const Algorithm& r : algorithms_of("Constraint"))
    {
        const auto with = cost_of(constraint_scene(r.type));
        print_row(r, {cell_of(with), with && without ? cell_of(*with - *without) : ""});
    }
}

}  // namespace

int main(int argc, char** argv)
{
    struct Family
    {
        const char* name;
        void (*print)();
    };
    const std::vector<std::string> wanted(argv + 1, argv + argc);
    if (wanted == std::vector<std::string>{"--measured"}) return measured(), 0;
    for (const Family& f : {Family{"Solver", solvers}, Family{"Resolution", resolutions}, Family{"Response", responses},
                            Family{"Manager", managers}, Family{"Constraint", constraints}})
        if (wanted.empty() || std::count(wanted.begin(), wanted.end(), f.name) > 0) f.print();
    return 0;
}
