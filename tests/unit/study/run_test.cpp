// One run: its record is what happened in the scene, and a run that fails gives a record with the failure.
#include "study/run.h"

#include <map>

#include "publish/sampler.h"
#include "study/observe.h"
#include "study/settings.h"
#include "study/study.h"
#include "support/scene.h"

using namespace plab;
using namespace plab::study;
using plab::test::library;
using plab::test::Scene;

namespace
{

model::SceneSpec compiled(const std::string& body, const std::string& settings = "dt='1/100'")
{
    auto scene = test::compile_text(test::whole_scene(body, settings));
    REQUIRE_MESSAGE(scene.ok(), test::reasons(scene));
    return scene.take();
}

const std::string kBall = "<component id='ball' type='State/RigidBody' mass='1' inertia='1 1 1' position='0 0 1'/>";
const std::string kWeight = "<component id='weight' type='Field/Gravity' between='ball'/>";

std::string force(const std::string& code)
{
    return "<component id='script' type='Script/Lua' driven='ball'><param name='code'>function force(t, state) " + code +
           " end</param></component>";
}

RunOptions options(double until)
{
    RunOptions out;
    out.until = until;
    out.quantities = {"ball.position"};
    return out;
}

std::uint64_t count_nothing() { return 42; }

}  // namespace

TEST_CASE("a recorded run ends in the final state of the scene; so does a timed one")
{
    const std::string file = "scenes/fan_and_balloons.xml";
    Scene scene = Scene::file(file);
    scene.run(4);
    const auto spec = test::compile_file(file);
    REQUIRE(spec.ok());
    RunOptions how;
    how.until = 4, how.quantities = {"red.position", "fan.angle", "contact.penetration", "red.orientation.w"};
    const RunRecord record = record_run(library(), *spec, how);
    CHECK(record.hash == scene.hash());
    CHECK(record.steps == 960);
    CHECK(record.ok());
    CHECK(record.time_series[0].at(record.times.size() - 1)[2] == scene.vec("red", "position").z);
    CHECK(record.time_series[1].values.back() == scene.angle("fan"));
    CHECK(record.time_series[3].values.front() == 1);
    CHECK(record.events.at("contact.impact") >= 1);
    const Timing timing = time_run(library(), *spec, how);
    CHECK(timing.steps == 960);
    CHECK(timing.cpu > 0);
    CHECK(timing.outcome == Outcome::Completed);
}

TEST_CASE("the figures of a study are those that the server publishes live")
{
    const model::SceneSpec spec = compiled(kBall + kWeight + "<component id='air' type='Field/Drag' between='ball' linear='0.3'/>");
    RunOptions how = options(1);
    how.sample_times = {0, 0.5, 1};
    const RunRecord record = record_run(library(), spec, how);
    simulation::Simulation s(library(), 1);
    REQUIRE(s.load(spec).ok());
    publish::Sampler sampler(0);
    const wire::Metrics start = sampler.sample(s, 1);
    for (int half = 1; half <= 2; ++half)
    {
        for (int n = 0; n < 50; ++n) s.step();
        const wire::Metrics live = sampler.sample(s, 1 + half);
        const auto at = static_cast<std::size_t>(half);
        CHECK(record.energy.energy[at] == live.ledger.kinetic + live.ledger.stored);
        double unstored = live.ledger.of_requests;
        for (const wire::InteractionMetrics& m : live.interactions) unstored += m.component_id == "air" ? m.work : 0;
        CHECK(unstored < 0);
        CHECK(record.energy.drift[at] ==
              doctest::Approx(live.ledger.kinetic + live.ledger.stored - start.ledger.kinetic - start.ledger.stored - unstored)
                  .epsilon(1e-9));
        for (const wire::InteractionMetrics& m : live.interactions)
            for (const PartFigures& part : record.parts)
                if (part.id == m.component_id && half == 2)
                {
                    CHECK(part.resolved == m.resolved);
                    CHECK(part.error >= m.error);
                }
    }
    CHECK(record.momentum_change == doctest::Approx(length(sampler.sample(s, 9).momentum)));
}

namespace
{

model::SceneSpec compiled_file(const std::string& file)
{
    auto scene = test::compile_file(file);
    REQUIRE(scene.ok());
    return scene.take();
}

/// What an observer of the metrics accumulates over a run.
struct Live
{
    std::vector<wire::Metrics> samples;
    double deepest = 0, residual = 0, violation = 0;
    std::uint64_t evaluations = 0;
    std::map<std::string, int> events;
};

Live watch(const model::SceneSpec& spec, int steps, int every)
{
    Live out;
    simulation::Simulation s(library(), 1);
    REQUIRE(s.load(spec).ok());
    publish::Sampler sampler(0);
    out.samples.push_back(sampler.sample(s, 1));
    for (int n = 1; n <= steps; ++n)
    {
        s.step();
        const wire::Metrics m = sampler.sample(s, 1 + n);
        out.deepest = std::max(out.deepest, m.deepest), out.residual = std::max(out.residual, m.residual);
        out.evaluations += s.stepper().report().evaluations;
        for (const Event& e : s.events()) ++out.events[e.kind];
        if (n % every != 0) continue;
        for (const wire::InteractionMetrics& i : m.interactions)
            if (i.requested.starts_with("Constraint/")) out.violation = std::max(out.violation, i.error);
        out.samples.push_back(m);
    }
    return out;
}

}  // namespace

TEST_CASE("live metrics and a study agree on energy, momenta, violation, evaluations and events, scene by scene")
{
    struct Run
    {
        const char* file;
        int per_second, steps;
        bool by_work;  ///< energy without a source: kinetic less all work
    };
    for (const Run& run : {Run{"scenes/fan_and_balloons.xml", 240, 960, true}, Run{"scenes/studies/double_pendulum.xml", 120, 120, false},
                           Run{"scenes/studies/bounce.xml", 120, 240, true}, Run{"scenes/studies/stack.xml", 60, 30, true},
                           Run{"scenes/studies/spring_stand.xml", 240, 60, true}, Run{"scenes/studies/gear_train.xml", 120, 60, false}})
    {
        CAPTURE(run.file);
        const model::SceneSpec spec = compiled_file(run.file);
        const int every = run.steps / 10;
        const Live live = watch(spec, run.steps, every);
        RunOptions how;
        for (int k = 0; k <= 10; ++k) how.sample_times.push_back(static_cast<double>(k * every) / run.per_second);
        const RunRecord record = record_run(library(), spec, how);
        REQUIRE(record.energy.energy.size() == live.samples.size());
        double momentum = 0, spin = 0;
        for (std::size_t k = 0; k < live.samples.size(); ++k)
        {
            const wire::Metrics &m = live.samples[k], &start = live.samples.front();
            CHECK(record.energy.energy[k] == m.ledger.kinetic + m.ledger.stored);
            if (run.by_work) CHECK(record.energy.drift[k] == doctest::Approx(m.ledger.unexplained).epsilon(1e-9));
            momentum = std::max(momentum, length(m.momentum - start.momentum));
            spin = std::max(spin, length(m.angular_momentum - start.angular_momentum));
        }
        CHECK(record.momentum_change == momentum);
        CHECK(record.angular_momentum_change == spin);
        CHECK(record.violation == live.violation);
        CHECK(record.penetration == live.deepest);
        CHECK(record.residual == live.residual);
        CHECK(record.evaluations == live.evaluations);
        CHECK(record.events == live.events);
        CHECK(record.evaluations > 0);
        for (const wire::InteractionMetrics& m : live.samples.back().interactions)
            for (const PartFigures& part : record.parts)
                if (part.id == m.component_id) CHECK(part.requested == m.requested);
    }
}

TEST_CASE("a spring with a damper loses energy, and that is not an error")
{
    const RunRecord record =
        record_run(library(),
                   compiled(kBall + "<component id='spring' type='Constraint/SpringDamper' b='ball' anchor_a='0 0 0' anchor_b='0 0 0' "
                                    "length='0.5' stiffness='100' damping='2'/><component id='solver' type='Solver/RungeKutta4'/>"),
                   options(2));
    CHECK(record.energy.energy.back() < 0.1 * record.energy.energy.front());
    for (const double d : record.energy.drift) CHECK(std::fabs(d) < 1e-4 * record.energy.scale);
}

TEST_CASE("a stiff spring at a long step diverges: this is reported, and the run ends there")
{
    const model::SceneSpec spec = compiled_file("scenes/studies/spring_stand.xml");
    auto explicit_one = apply(spec, library(), {{"solver", "RungeKutta4"}, {"dt", "1/60"}});
    REQUIRE(explicit_one.ok());
    RunOptions how;
    how.until = 2, how.quantities = {"table.position.z"};
    const RunRecord failed = record_run(library(), *explicit_one, how);
    CHECK(failed.outcome == Outcome::BlewUp);
    CHECK(name_of(failed.outcome) == "blew up");
    CHECK(failed.why.find("table") != std::string::npos);
    CHECK(failed.reached < 2);
    auto exponential = apply(spec, library(), {{"solver", "Exponential"}, {"dt", "1/60"}});
    REQUIRE(exponential.ok());
    CHECK(record_run(library(), *exponential, how).ok());
}

TEST_CASE("a run that does not converge continues, and is counted as a warning; a solver that gives up has failed")
{
    const model::SceneSpec stack = compiled_file("scenes/studies/stack.xml");
    auto few = apply(stack, library(), {{"manager", "SequentialImpulse"}, {"manager.max_iterations", "1"}});
    REQUIRE(few.ok());
    RunOptions how;
    how.until = 0.5, how.quantities = {"cube20.position"};
    const RunRecord loose = record_run(library(), *few, how);
    CHECK(loose.ok());
    CHECK(loose.residual > 1e-6);
    CHECK(!loose.warnings.empty());
    CHECK(!loose.first_warning.empty());
    auto bound =
        apply(compiled_file("scenes/studies/robertson.xml"), library(), {{"solver", "DormandPrince54"}, {"solver.max_substeps", "3"}});
    REQUIRE(bound.ok());
    how.quantities = {"reaction.values.2"};
    const RunRecord gave_up = record_run(library(), *bound, how);
    CHECK((!gave_up.ok() || !gave_up.warnings.empty()));
}

TEST_CASE("a run that fails is a record with the reason")
{
    const RunRecord lost =
        record_run(library(), compiled(kBall + force("driven:add_force(driven.position * (1e300 * 10 ^ (400 * t)))")), options(2));
    CHECK(lost.outcome != Outcome::Completed);
    CHECK(!lost.why.empty());
    CHECK(lost.reached < 2);
    const RunRecord failed = record_run(library(), compiled(kBall + force("error('no more')")), options(1));
    CHECK(failed.outcome == Outcome::Quarantined);
    CHECK(failed.why.find("no more") != std::string::npos);
    RunOptions floor = options(5);
    floor.floor = -1;
    const RunRecord fell = record_run(library(), compiled(kBall + kWeight), floor);
    CHECK(fell.outcome == Outcome::FellThrough);
    CHECK(fell.reached == doctest::Approx(std::sqrt(4 / 9.81)).epsilon(0.05));
    RunOptions broke = options(1e6);
    broke.budget = 0.02;
    const RunRecord slow = record_run(library(), compiled(kBall + kWeight), broke);
    CHECK(slow.outcome == Outcome::TooSlow);
    CHECK(slow.reached < 1e6);
    CHECK(time_run(library(), compiled(kBall + kWeight), broke).outcome == Outcome::TooSlow);
    RunOptions unknown = options(1);
    unknown.quantities = {"bell.position"};
    CHECK(record_run(library(), compiled(kBall), unknown).outcome == Outcome::Refused);
}

TEST_CASE("a swap inside a run is carried out and answered; one that is refused ends it")
{
    RunOptions how = options(1);
    how.swaps = {{40, "solver", "Solver/SemiImplicitEuler"}};
    how.allocations = &count_nothing;
    const RunRecord record = record_run(library(), compiled(kBall + kWeight), how);
    REQUIRE(record.swaps.size() == 1);
    CHECK(record.ok());
    CHECK(record.swaps[0].done);
    CHECK(record.swaps[0].step == 40);
    CHECK(record.swaps[0].swaps.front().to == "Solver/SemiImplicitEuler");
    CHECK(record.allocations == 0);
    // Semi-implicit Euler from t = 0.4 on: late by g dt/2 per second.
    CHECK(record.time_series[0].values.back() == doctest::Approx(1 - 0.5 * 9.81 - 0.6 * 9.81 * 0.005).epsilon(1e-9));
    how.swaps.push_back({60, "nobody", "Solver/SemiImplicitEuler"});
    const RunRecord refused = record_run(library(), compiled(kBall + kWeight), how);
    CHECK(refused.outcome == Outcome::SwapRefused);
    CHECK(refused.why.find("the swap before step 60, at t = 0.6 s: ") == 0);
    CHECK(refused.why.find("nobody") != std::string::npos);
    CHECK(refused.steps == 61);
    REQUIRE(refused.swaps.size() == 2);
    CHECK(!refused.swaps[1].done);
    how.swaps.back() = {100, "solver", "Solver/Exact"};
    CHECK(record_run(library(), compiled(kBall + kWeight), how).outcome == Outcome::SwapRefused);
}

TEST_CASE("allocations are counted in warm steps: not in the first ones, nor those after a swap")
{
    // Each step allocates once.
    static std::uint64_t calls = 0;
    const auto count = [](double until, std::vector<SwapAt> swaps)
    {
        RunOptions how = options(until);
        how.swaps = std::move(swaps), how.allocations = [] { return calls++; };
        return record_run(library(), compiled(kBall + kWeight), how).allocations;
    };
    CHECK(count(4, {}) == 360);
    CHECK(count(1, {}) == 80);
    CHECK(!count(0.2, {}).has_value());
    CHECK(!count(0.03, {}).has_value());
    // Steps 21 to 40, and from the 20th after the one that the swap came before.
    CHECK(count(1, {{40, "solver", "Solver/SemiImplicitEuler"}}) == 20 + 39);
}
