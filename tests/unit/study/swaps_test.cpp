// Swaps in all runs of a study: by step or by time, checked before anything runs, reported if a run refuses one.
#include "study/swaps.h"

#include "model/values.h"
#include "study/study.h"
#include "study/write.h"
#include "support/scene.h"
#include "support/text.h"
#include "unit/study/run_study.h"

using namespace plab;
using namespace plab::study;
using plab::test::has;
using plab::test::library;
using plab::test::near;
using plab::test::study_of;

namespace
{

std::vector<model::StepLength> lengths(std::initializer_list<const char*> texts)
{
    std::vector<model::StepLength> out;
    for (const char* text : texts) out.push_back(*model::parse_step_length(text));
    return out;
}

/// The error of a swap in runs of 2 s; "none" and its time in ms if there is no error.
std::string settled(const std::string& text, const std::vector<model::StepLength>& of)
{
    auto swap = parse_swap(text);
    if (!swap) return swap.error().text();
    std::vector<PlannedSwap> all{swap.take()};
    const auto done = settle_times(all, of, 2);
    return done ? "none " + std::to_string(std::lround(1e3 * all[0].time)) : done.error().text();
}

Plan swap_plan(const std::string& file, const std::vector<std::string>& vary, const std::vector<std::string>& swaps,
               const std::string& reference)
{
    Plan out;
    auto scene = test::compile_file("scenes/studies/" + file);
    REQUIRE(scene.ok());
    out.scene = scene.take();
    std::vector<std::vector<Setting>> varied;
    for (const std::string& text : vary) varied.push_back(*parse_vary(text));
    for (const std::string& text : swaps) out.swaps.push_back(*parse_swap(text));
    out.combinations = combine({}, varied), out.reference = parse_reference(reference);
    out.run.quantities = {"ball.position.z"}, out.run.until = 2, out.repeat = 0;
    return out;
}

std::string wrong(const Plan& p)
{
    const auto before = check_swaps(library(), p);
    const auto done = run_study(library(), p);
    CHECK_MESSAGE(before.ok() == done.ok(), "the check before gives the verdict of the study");
    return before ? "none" : before.error().text();
}

}  // namespace

TEST_CASE("a step is a whole number, a time has a unit; both come before the end")
{
    const auto one = lengths({"1/60"}), two = lengths({"1/60", "1/50"});
    CHECK(settled("30:solver=Exact", one) == "none 500");
    for (const char* text : {"0.5s:solver=Exact", "0.5 s:solver=Exact", "500 ms:solver=Exact", "1/2 s:solver=Exact"})
        CHECK(settled(text, two) == "none 500");
    CHECK(settled("0:solver=Exact", one) == "none 0");
    CHECK(settled("0s:solver=Exact", two) == "none 0");
    CHECK(settled("119:solver=Exact", one) == "none 1983");
    for (const char* text : {"solver=Exact", ":solver=Exact", "0.5:solver=Exact", "-1:solver=Exact", "-1s:solver=Exact", "1 m:solver=Exact",
                             "s:solver=Exact", "30:solver=", "30:=Exact", "30:solver", "1e400s:solver=Exact"})
        CHECK_MESSAGE(has(settled(text, one), "--swap needs STEP:ID=TYPE or TIME:ID=TYPE"), std::string(text));
    CHECK(has(settled("120:solver=Exact", one), "the runs end at 2 s, before step 120"));
    CHECK(has(settled("2s:solver=Exact", two), "the runs end at 2 s"));
    CHECK(has(settled("9000000000000000000:solver=Exact", one), "the runs end at"));
}

TEST_CASE("with several step lengths a step is not a time; a time has to be a step of all")
{
    const auto two = lengths({"1/60", "1/50"});
    CHECK(has(settled("30:solver=Exact", two), "step 30 is at 0.5 s with dt = "));
    CHECK(has(settled("30:solver=Exact", two),
              "and at 0.6 s with dt = 0.02 s: give a time, which is the same for all, such as 0.5s:solver="));
    CHECK(settled("0:solver=Exact", two) == "none 0");
    CHECK(has(settled("0.52s:solver=Exact", two), "begins at 0.52 s; all runs have steps at multiples of 0.1 s"));
}

TEST_CASE("ids and types are checked before the runs, with the short names of --vary")
{
    const auto why = [](const std::string& swap) { return wrong(swap_plan("projectile.xml", {"dt=1/60"}, {swap}, "none")); };
    CHECK(why("0:solver=StoermerVerlet") == "none");
    CHECK(why("0:solver=Solver/StoermerVerlet") == "none");
    CHECK(has(why("0:solver=StormerVerlet"), "unknown type 'Solver/StormerVerlet', did you mean 'Solver/StoermerVerlet'"));
    CHECK(has(why("0:solvr=Exact"), "no component has the id 'solvr', did you mean 'solver'"));
    CHECK(has(why("0:solver=Resolution/None"), "cannot be exchanged"));
    CHECK(has(why("0:dt=1/30"), "no component has the id 'dt'"));
    CHECK(has(why("0:ball.mass=2"), "no component has the id 'ball.mass'"));
    CHECK(has(why("500:solver=Exact"), "the runs end at 2 s"));
    CHECK(wrong(swap_plan("bounce.xml", {"dt=1/60"}, {"0:contact.response=Rows", "1:contact.response.manager=SoftStep"}, "none")) ==
          "none");
}

TEST_CASE("a swap that one algorithm does not support is that run's result; a reference that cannot make it is an error")
{
    const StudyResult r =
        study_of(swap_plan("bounce.xml", {"contact.response=Rows,Impulse", "dt=1/60"}, {"0.5s:contact.response.manager=SoftStep"}, "none"));
    CHECK(r.points[0].record.ok());
    CHECK(r.points[0].record.swaps.size() == 1);
    CHECK(r.points[1].record.outcome == Outcome::Refused);
    CHECK(has(r.points[1].record.why, "contact.response.manager"));
    Plan p = swap_plan("projectile.xml", {"dt=1/60"}, {"0.5s:solver=SemiImplicitEuler"}, "auto");
    p.reference.algorithm = *parse_algorithm("dt=1/7");
    CHECK(has(wrong(p), "in the reference: --swap '0.5s:solver=SemiImplicitEuler': no step of dt = "));
}

TEST_CASE("all runs and the reference swap at one time: the order is the method's")
{
    Plan p = swap_plan("projectile.xml", {"solver=RungeKutta4", "dt=1/60,1/120,1/240"}, {"0.5s:solver=SemiImplicitEuler"}, "auto");
    const StudyResult r = study_of(p);
    CHECK(r.reference.order[0] == doctest::Approx(1).epsilon(0.01));
    CHECK(r.reference.converges);
    // From t = 0.5 s on late by g dt/2 a second; the limit is the parabola.
    for (const Point& point : r.points)
    {
        CHECK(point.record.swaps[0].step == std::lround(0.5 / point.record.dt));
        CHECK(near(point.errors[0].last_absolute, 1.5 * 9.81 * point.record.dt / 2, 1e-9));
    }
    // A step of the runs' one length is the same time in the reference.
    p = swap_plan("projectile.xml", {"solver=RungeKutta4", "dt=1/60"}, {"30:solver=SemiImplicitEuler"}, "auto");
    CHECK(study_of(p).reference.order[0] == doctest::Approx(1).epsilon(0.01));
}

TEST_CASE("a swap that a run refuses is its outcome, and is reported on the console")
{
    const std::string body =
        "<component id='motor' type='State/Shaft' inertia='1'/><component id='out' type='State/Shaft' inertia='1'/>"
        "<component id='gear' type='Constraint/AngularVelocity/Impulse' driver='motor' driven='out' velocity_factor='2'/>"
        "<component id='back' type='Constraint/AngularVelocity/Graph' driver='motor' driven='out' velocity_factor='3'/>";
    auto scene = test::compile_text(test::whole_scene(body, "dt='1/100'"));
    REQUIRE_MESSAGE(scene.ok(), test::reasons(scene));
    Plan p;
    p.scene = scene.take(), p.combinations = combine({}, {}), p.reference = parse_reference("none");
    p.swaps = {*parse_swap("0.4s:gear=Graph")};
    p.run.quantities = {"out.angle"}, p.run.until = 1, p.repeat = 1;
    CHECK(check_swaps(library(), p).ok());
    const StudyResult r = study_of(p);
    const RunRecord& record = r.points[0].record;
    CHECK(record.outcome == Outcome::SwapRefused);
    CHECK(name_of(record.outcome) == "swap refused");
    CHECK(record.why.starts_with("the swap before step 40, at t = 0.4 s: "));
    CHECK(record.steps == 41);
    const auto reported = findings(r);
    CHECK(std::any_of(reported.begin(), reported.end(),
                      [](const auto& s)
                      { return has(s, "One run gave no result (swap refused): as written: the swap before step 40, at t = 0.4 s: "); }));
}
