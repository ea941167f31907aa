#include "study/run.h"

#include <time.h>

#include <algorithm>
#include <cmath>

#include "model/numbers.h"
#include "plab/number_text.h"
#include "study/observe.h"

namespace plab::study
{
namespace
{

constexpr int kSamples = 200;
/// The budget is checked at this interval: a check costs less than a thousandth of the cheapest step.
constexpr Tick kStepsPerCheck = 16;

/// Steps are warm after a tenth of the run and at least this many, from the start and from each swap: buffers have grown then.
constexpr Tick kFewestToWarm = 20;

/// The step boundary at t, to within a thousandth of a step.
Tick tick_at(double t, double dt) { return static_cast<Tick>(std::floor(t / dt + 1e-3)); }

std::vector<Tick> sample_ticks(const RunOptions& options, double dt)
{
    std::vector<Tick> out;
    for (const double t : options.sample_times) out.push_back(tick_at(t, dt));
    if (!out.empty()) return out;
    const Tick last = std::max<Tick>(1, tick_at(options.until, dt));
    const Tick stride = std::max<Tick>(1, last / kSamples);
    for (Tick n = last % stride; n <= last; n += stride) out.push_back(n);
    if (out.front() != 0) out.insert(out.begin(), 0);
    return out;
}

std::string join(const Errors& errors)
{
    std::string out;
    for (const Error& e : errors) out += (out.empty() ? "" : "; ") + e.text();
    return out;
}

void post_swaps(simulation::Simulation& s, const std::vector<SwapAt>& swaps)
{
    for (const SwapAt& swap : swaps)
    {
        simulation::Request request;
        request.operations.push_back(simulation::SwapOperation{swap.id, swap.type, {}});
        request.at = swap.at;
        s.post(std::move(request));
    }
}

bool lost(const simulation::Simulation& s) { return !s.stepper().report().frozen.empty(); }

/// The run that is recorded.
class Recorder
{
public:
    Recorder(simulation::Simulation& s, const RunOptions& options, RunRecord& out)
        : simulation_(s), options_(options), out_(out), observe_(s, out)
    {
    }

    void go()
    {
        out_.dt = simulation_.dt();
        post_swaps(simulation_, options_.swaps);
        const std::vector<Tick> samples = sample_ticks(options_, simulation_.dt());
        warming_ = std::max(kFewestToWarm, samples.back() / 10), warm_from_ = warming_;
        const double begin = thread_cpu_seconds();
        for (const Tick next : samples)
        {
            while (simulation_.tick() < next && out_.ok()) step(begin);
            if (!out_.ok()) break;
            observe_.sample();
            if (!std::isfinite(out_.energy.energy.back()))
                fail(Outcome::NotFinite,
                     "the energy of the scene was no longer a number at t = " + model::format_real(simulation_.time()) + " s");
        }
        if (out_.ok() && out_.swaps.size() < options_.swaps.size())
            fail(Outcome::SwapRefused, "the run ended after " + std::to_string(simulation_.tick()) + " steps, before the step of a swap");
        out_.steps = simulation_.tick(), out_.reached = simulation_.time(), out_.hash = simulation_.state_hash();
        observe_.finish();
    }

private:
    void step(double begin)
    {
        const std::uint64_t before = options_.allocations ? options_.allocations() : 0;
        const bool stepped = simulation_.step();
        const std::uint64_t made = options_.allocations ? options_.allocations() - before : 0;
        if (!stepped) return fail(Outcome::Frozen, "the scene was paused and did not step");
        observe_.step();
        if (take_replies() > 0) warm_from_ = simulation_.tick() + warming_;
        if (options_.allocations && simulation_.tick() > warm_from_) out_.allocations = out_.allocations.value_or(0) + made;
        if (!out_.ok()) return;
        check();
        if (options_.is_stopped()) return fail(Outcome::Interrupted, "interrupted");
        if (simulation_.tick() % kStepsPerCheck == 0 && thread_cpu_seconds() - begin > options_.budget)
            fail(Outcome::TooSlow, "stopped after " + number_text(options_.budget) + " s of CPU time");
    }
    /// How many swaps were answered before this step.
    std::size_t take_replies()
    {
        const std::size_t before = out_.swaps.size();
        for (simulation::Reply& reply : simulation_.take_replies())
        {
            if (!reply.done && out_.ok())
            {
                char when[80];
                const long long step = simulation_.tick() - 1;
                std::snprintf(when, sizeof when, "the swap before step %lld, at t = %.9g s: ", step,
                              static_cast<double>(step) * simulation_.dt());
                fail(Outcome::SwapRefused, when + join(reply.errors));
            }
            out_.swaps.push_back(std::move(reply));
        }
        return out_.swaps.size() - before;
    }
    void check()
    {
        if (lost(simulation_))
            return fail(Outcome::NotFinite, "the state of " + simulation_.world().id_of(simulation_.stepper().report().frozen.front()) +
                                                " was no longer finite at t = " + model::format_real(simulation_.time()) + " s");
        for (const Event& e : simulation_.events())
        {
            if (e.kind == "motion.diverged")
                return fail(Outcome::BlewUp, e.message + "; t = " + model::format_real(simulation_.time()) + " s");
            if (e.severity == Severity::Failure)
                return fail(
                    Outcome::Quarantined,
                    (e.component == kNoIndex ? std::string() : simulation_.world().id_of(e.component) + ": ") + e.kind + ": " + e.message);
        }
        if (!options_.floor) return;
        const Bodies& bodies = simulation_.world().host().bodies;
        for (const std::uint32_t i : simulation_.world().in_id_order())
        {
            const world::Component& c = simulation_.world().component(i);
            if (c.facet != Facet::Body || !bodies.dynamic(c.host_index) || bodies.position[c.host_index].z >= *options_.floor) continue;
            return fail(Outcome::FellThrough, c.id + " was below z = " + model::format_real(*options_.floor) +
                                                  " m at t = " + model::format_real(simulation_.time()) + " s");
        }
    }
    void fail(Outcome outcome, std::string why) { out_.outcome = outcome, out_.why = std::move(why); }

    simulation::Simulation& simulation_;
    const RunOptions& options_;
    RunRecord& out_;
    Observation observe_;
    Tick warming_ = 0, warm_from_ = 0;
};

}  // namespace

double thread_cpu_seconds()
{
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string_view name_of(Outcome outcome)
{
    constexpr std::string_view names[] = {"completed",    "refused",  "not finite", "blew up",      "component failed",
                                          "fell through", "too slow", "frozen",     "swap refused", "interrupted"};
    return names[static_cast<int>(outcome)];
}

RunRecord record_run(model::TypeSource& types, const model::SceneSpec& scene, const RunOptions& options)
{
    RunRecord out;
    out.dt = scene.settings.dt.seconds;
    const auto refuse = [&](std::string why) { out.outcome = Outcome::Refused, out.why = std::move(why); };
    simulation::Simulation s(types, 1);
    s.set_interruption(options.stop);
    if (auto loaded = s.load(scene); !loaded) return refuse(join(loaded.errors())), out;
    for (const std::string& text : options.quantities)
    {
        auto quantity = resolve_quantity(s.world(), text);
        if (!quantity) return refuse(quantity.error().reason), out;
        out.time_series.push_back({quantity->width, {}});
        out.quantities.push_back(quantity.take());
    }
    Recorder(s, options, out).go();
    return out;
}

double seconds_of_a_run(model::TypeSource& types, const model::SceneSpec& scene, const RunOptions& options)
{
    constexpr double kEnough = 5e-3;  // s
    constexpr Tick kFewest = 2;
    const double loading = thread_cpu_seconds();
    simulation::Simulation s(types, 1);
    s.set_interruption(options.stop);
    if (!s.load(scene)) return 0;
    const double begin = thread_cpu_seconds();
    const Tick last = std::max<Tick>(kFewest, static_cast<Tick>(std::llround(options.until / s.dt())));
    while (s.tick() < last && (s.tick() < kFewest || thread_cpu_seconds() - begin < kEnough))
        if (!s.step() || lost(s) || options.is_stopped()) break;
    const double of_steps = thread_cpu_seconds() - begin;
    const double whole = of_steps * static_cast<double>(last) / static_cast<double>(std::max<Tick>(1, s.tick()));
    return begin - loading + std::min(whole, options.budget);
}

Timing time_run(model::TypeSource& types, const model::SceneSpec& scene, const RunOptions& options)
{
    Timing out;
    simulation::Simulation s(types, 1);
    s.set_interruption(options.stop);
    if (!s.load(scene))
    {
        out.outcome = Outcome::Refused;
        return out;
    }
    post_swaps(s, options.swaps);
    const Tick last = sample_ticks(options, s.dt()).back();
    const double begin = thread_cpu_seconds();
    while (s.tick() < last && out.outcome == Outcome::Completed)
    {
        const Tick stop = std::min(last, s.tick() + kStepsPerCheck);
        while (s.tick() < stop && out.outcome == Outcome::Completed)
        {
            if (!s.step() || lost(s)) out.outcome = lost(s) ? Outcome::NotFinite : Outcome::Frozen;
            if (options.is_stopped()) out.outcome = Outcome::Interrupted;
        }
        if (out.outcome == Outcome::Completed && thread_cpu_seconds() - begin > options.budget) out.outcome = Outcome::TooSlow;
    }
    out.cpu = thread_cpu_seconds() - begin;
    out.steps = s.tick(), out.reached = s.time();
    return out;
}

}  // namespace plab::study
