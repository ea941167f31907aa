// pLab's algorithms in each case: the table to extend. Types that this build lacks are left out with a note.
#include <set>

#include "bench/peers/case.h"
#include "bench/peers/plab_engine.h"

namespace plab::peers
{
namespace
{

using Ladder = std::vector<Step>;

/// An algorithm with suitable steps.
struct Entry
{
    Algorithm algorithm;
    Ladder ladder;
    std::string control;  ///< tolerance of a method that chooses its own steps
};
using Entries = std::vector<Entry>;

const Ladder kFine = steps({30, 60, 120, 240, 480, 1000, 2000, 4000});
const Ladder kWide = steps({5, 10, 20, 30, 60, 120, 240, 480, 1000});
const Ladder kLongSteps{{5, 1}, {2, 1}, {1, 1}, {1, 2}, {1, 5}, {1, 10}, {1, 20}, {1, 30}, {1, 60}, {1, 120}, {1, 240}};
const Ladder kContact = steps({30, 60, 120, 240, 480});
const Ladder kBalls = steps({10, 20, 30, 60, 120, 240, 480});

std::string type(const std::string& name) { return "type=\"" + name + "\""; }
std::string solver(const std::string& name) { return type("Solver/" + name); }

Algorithm smooth(const std::string& name, const std::string& attributes)
{
    Algorithm r;
    r.name = name, r.solver = attributes;
    return r;
}
Algorithm smooth(const std::string& name) { return smooth(name, solver(name)); }

/// Methods that choose their own steps, at several tolerances, sampled at the times of the case.
void add_adaptive(Entries& out, const std::string& name, const Step& sampling)
{
    for (const char* tolerance : {"1e-3", "1e-5", "1e-7", "1e-9", "1e-11"})
    {
        const std::string attributes = solver(name) + " relative_tolerance=\"" + tolerance + "\" absolute_tolerance=\"" + tolerance + "\"";
        out.push_back({smooth(name, attributes), {sampling}, tolerance});
    }
}

Entries flight_algorithms()
{
    Entries out;
    out.push_back({smooth("SemiImplicitEuler"), kFine, ""});
    out.push_back({smooth("StoermerVerlet"), kFine, ""});
    out.push_back({smooth("RungeKutta4"), kWide, ""});
    out.push_back({smooth("RotationSplitting 2", solver("RotationSplitting") + " order=\"2\""), kWide, ""});
    out.push_back({smooth("RotationSplitting 4", solver("RotationSplitting") + " order=\"4\""), kWide, ""});
    out.push_back({smooth("ImplicitMidpoint"), kWide, ""});
    out.push_back({smooth("Exact"), kLongSteps, ""});
    out.push_back({smooth("Automatic"), kLongSteps, ""});
    add_adaptive(out, "DormandPrince54", {1, 10});
    return out;
}

/// Impacts as events: a solver between them, a resolution that locates them, a response by impulses.
Algorithm by_events(const std::string& solver_name, const std::string& resolution, const std::string& more = "")
{
    Algorithm r = smooth(solver_name + "+" + resolution, solver(solver_name));
    r.contact = "resolution=\"Resolution/" + resolution + "\"";
    r.response = type("Response/Impulse") + more;
    return r;
}

/// Contacts as rows that a manager satisfies.
Algorithm by_rows(const std::string& manager, const std::string& resolution, const std::string& more = "", const std::string& label = "")
{
    Algorithm r = smooth(manager + (label.empty() ? "" : " " + label) + "+" + resolution, solver("RungeKutta4"));
    r.contact = "resolution=\"Resolution/" + resolution + "\"";
    r.response = type("Response/Rows") + " manager=\"manager\"";
    r.extra = "<component id=\"manager\" " + type("Manager/" + manager) + " " + more + "/>\n";
    return r;
}

/// Contacts as springs.
Algorithm by_force(const std::string& solver_name, const std::string& response, const std::string& more = "")
{
    Algorithm r = smooth(response + "+" + solver_name, solver(solver_name));
    r.response = type("Response/" + response) + " " + more;
    return r;
}

Entries bounce_algorithms()
{
    Entries out;
    for (const char* resolution : {"None", "LocalBisection", "LocalRoot", "ConservativeAdvancement"})
        for (const char* name : {"SemiImplicitEuler", "StoermerVerlet", "RungeKutta4", "Exact"})
            out.push_back({by_events(name, resolution), kLongSteps, ""});
    out.push_back({by_force("RungeKutta4", "Penalty"), kContact, ""});
    out.push_back({by_rows("Direct", "LocalRoot"), kLongSteps, ""});
    out.push_back({by_rows("SequentialImpulse", "Speculative"), kContact, ""});
    return out;
}

Entries slide_algorithms()
{
    Entries out;
    const Ladder ladder = steps({1, 2, 5, 10, 20, 30, 60, 120, 240, 480});
    out.push_back({by_events("RungeKutta4", "None"), ladder, ""});
    out.push_back({by_events("RungeKutta4", "LocalRoot"), ladder, ""});
    for (const char* manager : {"SequentialImpulse", "SoftStep", "Direct"}) out.push_back({by_rows(manager, "None"), ladder, ""});
    out.push_back({by_force("RungeKutta4", "Penalty"), kContact, ""});
    return out;
}

Entries ball_algorithms()
{
    Entries out;
    for (const char* name : {"RungeKutta4", "StoermerVerlet", "Exact"})
        for (const char* resolution : {"None", "LocalRoot"}) out.push_back({by_events(name, resolution), kBalls, ""});
    for (const char* manager : {"SequentialImpulse", "SoftStep", "Direct"})
        for (const char* resolution : {"None", "Speculative"}) out.push_back({by_rows(manager, resolution), kBalls, ""});
    for (const std::string substeps : {"2", "4"})
        for (const char* resolution : {"None", "Speculative"})
            out.push_back({by_rows("SoftStep", resolution, "substeps=\"" + substeps + "\" damping_ratio=\"3\"", substeps + " damping 3"),
                           kBalls, ""});
    out.push_back({by_rows("Direct", "LocalRoot"), kBalls, ""});
    return out;
}

Entries stack_algorithms()
{
    Entries out;
    out.push_back({by_events("RungeKutta4", "None"), kContact, ""});
    for (const char* sweeps : {"10", "50", "200"})
        out.push_back({by_rows("SequentialImpulse", "None", "max_iterations=\"" + std::string(sweeps) + "\"", sweeps), kContact, ""});
    for (const char* substeps : {"4", "16"})
        out.push_back({by_rows("SoftStep", "None", "substeps=\"" + std::string(substeps) + "\"", substeps), kContact, ""});
    out.push_back({by_rows("Direct", "None"), kContact, ""});
    return out;
}

Entries large_algorithms()
{
    Entries out;
    for (const Entry& e : stack_algorithms())
        if (e.algorithm.name != "SequentialImpulse 200+None") out.push_back({e.algorithm, steps({60}), ""});
    out.push_back({by_rows("SoftStep", "None", "substeps=\"8\"", "8"), steps({60}), ""});
    out.push_back({by_rows("Automatic", "None"), steps({60}), ""});
    // As server/docs/pace.md advises for many bodies.
    for (const std::string substeps : {"2", "3", "4", "8"})
        out.push_back(
            {by_rows("SoftStep", "None", "substeps=\"" + substeps + "\" damping_ratio=\"3\"", substeps + " damping 3"), steps({60}), ""});
    return out;
}

Entries chain_algorithms()
{
    Entries out;
    for (const char* name : {"SemiImplicitEuler", "StoermerVerlet", "RungeKutta4", "ImplicitMidpoint", "RotationSplitting"})
        out.push_back({smooth(name), steps({20, 30, 60, 120, 240, 480, 1000}), ""});
    for (const char* name : {"DormandPrince54", "Articulated"}) add_adaptive(out, name, {1, 60});
    return out;
}

Entries gear_algorithms()
{
    Entries out;
    for (const char* name : {"SemiImplicitEuler", "StoermerVerlet", "RungeKutta4", "Exact", "ImplicitMidpoint"})
    {
        out.push_back({smooth(name), {{10, 1}, {1, 1}, {1, 10}, {1, 30}, {1, 60}, {1, 240}}, ""});
        Algorithm bodies = smooth(std::string(name) + " hinges", solver(name));
        bodies.gears = Algorithm::Gears::Bodies;
        out.push_back({bodies, steps({10, 30, 60, 240}), ""});
    }
    return out;
}

Entries spring_algorithms()
{
    Entries out;
    for (const char* name : {"SemiImplicitEuler", "StoermerVerlet", "RungeKutta4", "ImplicitMidpoint"})
        out.push_back({smooth(name), steps({60, 240, 1000, 2000, 4000, 8000}), ""});
    for (const char* name : {"Exponential", "Automatic"}) out.push_back({smooth(name), steps({1, 2, 10, 60, 240, 1000, 4000}), ""});
    add_adaptive(out, "DormandPrince54", {1, 60});
    add_adaptive(out, "Radau5", {1, 60});
    return out;
}

Entries algorithms_for(const Case& which)
{
    switch (which.id[0])
    {
        case 'a':
            return flight_algorithms();
        case 'b':
            return bounce_algorithms();
        case 'c':
            return slide_algorithms();
        case 'd':
            return ball_algorithms();
        case 'e':
            return stack_algorithms();
        case 'f':
            return large_algorithms();
        case 'g':
            return chain_algorithms();
        case 'h':
            return gear_algorithms();
        default:
            return spring_algorithms();
    }
}

/// Whether this build has the types that the algorithm names; if not, `notes` receives what is missing.
bool is_there(const Entry& entry, const Case& which, std::set<std::string>& reported, std::vector<std::string>& notes)
{
    const auto missing = missing_types(blueprint_text(which.scenes[0], entry.algorithm, {1, 60}));
    for (const std::string& name : missing)
        if (reported.insert(entry.algorithm.name + name).second)
            notes.push_back("plab " + entry.algorithm.name + " is left out of " + which.id + ": no plugin has " + name);
    return missing.empty();
}

}  // namespace

std::vector<Run> plab_runs(const Case& which, std::vector<std::string>& notes)
{
    std::vector<Run> runs;
    std::set<std::string> reported;
    for (const Entry& entry : algorithms_for(which))
    {
        if (!is_there(entry, which, reported, notes)) continue;
        for (const Step& step : entry.ladder)
        {
            if (step.seconds() > which.scenes[0].duration) continue;
            const auto make = [algorithm = entry.algorithm, step](const Scene& scene)
            { return make_plab_engine(blueprint_text(scene, algorithm, step), scene.bodies.size()); };
            runs.push_back({"plab", entry.algorithm.name, step, entry.control, make});
        }
    }
    return runs;
}

}  // namespace plab::peers
