#include "daemon/shadow.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <nlohmann/json.hpp>

#include "control/replies.h"
#include "daemon/ending.h"
#include "daemon/recording.h"
#include "daemon/runner.h"
#include "idl/json/json.h"
#include "program/interruption.h"
#include "program/progress.h"
#include "simulation/requests/request_words.h"

namespace plab::daemon
{
namespace
{

/// Number of printed rows of the comparison.
constexpr int kShadowRows = 20;
/// Number of steps of one future before the other has its turn: enough that its data are in the cache for most of them.
constexpr std::int64_t kPiece = 16;

/// CPU time of this thread, s: independent of other load on the machine.
double thread_seconds()
{
    timespec now{};
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median_of(std::vector<double> values)
{
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Distance between two states of a scene.
struct Gap
{
    double time = 0;                             ///< s
    double distance = 0, turn = 0;               ///< m, rad: the largest of any body, or shaft (turn)
    std::string farthest, most_turned;           ///< ids of these objects
    double energy_without = 0, energy_with = 0;  ///< J
};

/// One future of the scene.
struct Future
{
    simulation::Simulation simulation;
    std::vector<double> costs;  ///< ns per step, of each piece
    double cpu_ns = 0;          ///< of all steps
    double worst_error = 0;
    std::map<std::string, std::uint64_t> events;

    explicit Future(plugins::PluginLibrary& library, int threads) : simulation(library, threads) {}
    void go(std::int64_t steps, const std::string& id)
    {
        const double begin = thread_seconds();
        for (std::int64_t i = 0; i < steps; ++i) step(id);
        const double ns = 1e9 * (thread_seconds() - begin);
        cpu_ns += ns;
        costs.push_back(ns / static_cast<double>(steps));
    }
    void step(const std::string& id)
    {
        if (!simulation.step_once()) return;
        for (const Event& e : simulation.events()) ++events[e.kind];
        if (const std::uint32_t i = simulation.world().find(id); i != kNoIndex)
            worst_error = std::fmax(worst_error, simulation.error_of(i));
    }
    double energy() const
    {
        const simulation::Totals t = simulation.totals();
        return t.kinetic + t.stored;
    }
};

double angle_between(const Quat& a, const Quat& b)
{
    if (a == b) return 0;  // avoids rounding: the product of a quaternion with its own conjugate is not exactly one
    const Quat d = conjugate(a) * b;
    return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::fabs(d.w));
}

Gap gap_between(const Future& without, const Future& with)
{
    Gap gap;
    gap.time = without.simulation.time(), gap.energy_without = without.energy(), gap.energy_with = with.energy();
    const world::World &a = without.simulation.world(), &b = with.simulation.world();
    const auto widen = [](double value, double& most, std::string& whose, const std::string& id)
    {
        // A position that is no longer finite counts as infinitely far.
        if (value > most || !(value == value)) most = value, whose = id;
    };
    for (const std::uint32_t i : a.in_id_order())
    {
        const world::Component& c = a.component(i);
        const std::uint32_t k = b.find(c.id);
        if (k == kNoIndex) continue;
        const world::Component& d = b.component(k);
        if (c.facet == Facet::Body && d.facet == Facet::Body)
        {
            const Pose p = a.host().bodies.pose(c.host_index), q = b.host().bodies.pose(d.host_index);
            widen(length(p.p - q.p), gap.distance, gap.farthest, c.id);
            widen(angle_between(p.q, q.q), gap.turn, gap.most_turned, c.id);
        }
        if (c.facet == Facet::Shaft && d.facet == Facet::Shaft)
            widen(std::fabs(a.host().shafts.angle[c.host_index] - b.host().shafts.angle[d.host_index]), gap.turn, gap.most_turned, c.id);
    }
    return gap;
}

struct Outcome
{
    simulation::Reply reply;
    std::int64_t steps = 0;
    Tick from = 0;
    double begin = 0;  ///< s
    std::vector<Gap> trajectory;
};

wire::Json outcome_json(const Outcome& o, const Future& without, const Future& with, const ShadowChoice& choice)
{
    const auto future = [&](const Future& f)
    {
        return wire::Json{{"cost_ns_per_step", median_of(f.costs)},
                          {"mean_cost_ns_per_step", f.cpu_ns / static_cast<double>(std::max<std::int64_t>(1, o.steps))},
                          {"largest_error", f.worst_error},
                          {"events", f.events}};
    };
    wire::Json trajectory = wire::Json::array();
    for (const Gap& g : o.trajectory)
        trajectory.push_back({{"time", g.time},
                              {"distance", g.distance},
                              {"farthest", g.farthest},
                              {"turn", g.turn},
                              {"most_turned", g.most_turned},
                              {"energy_without", g.energy_without},
                              {"energy_with", g.energy_with}});
    // As a reply reports it, with the same keys.
    const wire::Json swap = wire::json_of(o.reply.swaps.empty() ? wire::SwapReport{choice.id, {}, choice.type, {}, 0, {}, {}}
                                                                : control::report_of(o.reply.swaps.front()));
    return {{"component", choice.id}, {"from", swap["from"]},     {"to", choice.type},        {"step", o.from},
            {"time", o.begin},        {"steps", o.steps},         {"fields", swap["fields"]}, {"without", future(without)},
            {"with", future(with)},   {"differences", trajectory}};
}

void print(const Outcome& o, const Future& without, const Future& with, const ShadowChoice& choice)
{
    const double steps = static_cast<double>(std::max<std::int64_t>(1, o.steps));
    const std::string from = o.reply.swaps.empty() ? "?" : o.reply.swaps.front().from;
    std::printf("%s: %s (unchanged) beside %s (shadow), from step %" PRId64 " (t = %.9g s), %" PRId64 " steps\n", choice.id.c_str(),
                from.c_str(), choice.type.c_str(), o.from, o.begin, o.steps);
    std::printf("%-24s %14s %14s\n", "", "unchanged", "shadow");
    std::printf("%-24s %14.3f %14.3f\n", "cost, us per step", median_of(without.costs) * 1e-3, median_of(with.costs) * 1e-3);
    std::printf("%-24s %14.3f %14.3f\n", "mean, with rare events", without.cpu_ns / steps * 1e-3, with.cpu_ns / steps * 1e-3);
    std::printf("%-24s %14.3g %14.3g\n", "largest error", without.worst_error, with.worst_error);
    std::printf("\n%12s %14s  %-20s %14s  %-20s %14s\n", "t (s)", "distance (m)", "by", "angle (rad)", "by", "energy (J)");
    for (const Gap& g : o.trajectory)
        std::printf("%12.6g %14.6g  %-20s %14.6g  %-20s %+14.6g\n", g.time, g.distance, g.farthest.c_str(), g.turn, g.most_turned.c_str(),
                    g.energy_with - g.energy_without);
}

}  // namespace

int run_shadow(plugins::PluginLibrary& library, const DaemonOptions& options, const std::atomic<bool>& stop,
               const Interruption& interruption)
{
    auto snapshot = read_snapshot(options.load, library);
    if (!snapshot) return fail(snapshot.errors());
    Future without(library, options.threads), with(library, options.threads);
    for (Future* future : {&without, &with}) future->simulation.set_interruption(&interruption);
    for (Future* future : {&without, &with})
        if (auto restored = future->simulation.restore(snapshot->snapshot); !restored) return fail(restored.errors());
    Outcome outcome;
    outcome.from = without.simulation.tick(), outcome.begin = without.simulation.time();
    simulation::Request swap;
    swap.operations.push_back(simulation::SwapOperation{options.shadow.id, options.shadow.type, {}});
    outcome.reply = with.simulation.carry_out_now(swap);
    if (!outcome.reply.done) return fail(outcome.reply.errors);

    const auto steps = static_cast<std::int64_t>(std::llround(options.shadow.seconds / without.simulation.dt()));
    const std::int64_t every = std::max<std::int64_t>(1, steps / kShadowRows);
    program::catch_signals();
    program::Progress progress(options.progress ? program::ProgressTo::Lines : program::ProgressTo::Terminal);
    const auto gave_up = [&] { return without.simulation.gave_up() || with.simulation.gave_up(); };
    while (outcome.steps < steps && !stop && !gave_up())
    {
        progress.show_share("shadow of " + options.shadow.id, static_cast<double>(outcome.steps) / static_cast<double>(steps));
        // A piece ends where a row is printed; the first row is that of the first step.
        const std::int64_t to_row = outcome.steps == 0 ? 1 : every - outcome.steps % every;
        const std::int64_t piece = std::min({kPiece, to_row, steps - outcome.steps});
        // Each future goes first equally often, so that other load on the machine affects both.
        const bool turn = without.costs.size() % 2 == 0;
        (turn ? without : with).go(piece, options.shadow.id);
        (turn ? with : without).go(piece, options.shadow.id);
        if (gave_up()) break;
        outcome.steps += piece;
        if (outcome.steps % every == 0 || outcome.steps == 1) outcome.trajectory.push_back(gap_between(without, with));
    }
    progress.clear();
    const bool is_cut = outcome.steps < steps;
    if (options.shadow.json)
    {
        wire::Json json = outcome_json(outcome, without, with, options.shadow);
        json["interrupted"] = is_cut;
        std::printf("%s\n", json.dump(2).c_str());
    }
    else
        print(outcome, without, with, options.shadow);
    if (gave_up()) (void)std::fprintf(stderr, "a step was abandoned: the comparison ends before it\n");
    if (!is_cut) return 0;
    (void)std::fprintf(stderr, "plabd: interrupted by %s after %" PRId64 " of %" PRId64 " steps\n", program::name_of_interruption().c_str(),
                       outcome.steps, steps);
    return program::code_of_interruption();
}

}  // namespace plab::daemon
