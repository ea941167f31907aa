// Plans, errors, references, contacts, and a whole study in this process.
#include "study/study.h"

#include "model/values.h"
#include "program/text_out.h"
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

model::SceneSpec scene_of(const std::string& file)
{
    auto scene = test::compile_file(file);
    REQUIRE(scene.ok());
    return scene.take();
}

std::vector<Setting> varied(const std::string& text)
{
    auto v = parse_vary(text);
    REQUIRE_MESSAGE(v.ok(), text);
    return v.take();
}

std::string refused(const model::SceneSpec& scene, const std::string& setting)
{
    const auto done = apply(scene, library(), varied(setting));
    return done ? "none" : done.error().text();
}

Plan plan(const std::string& file, const std::vector<std::string>& vary, const std::string& reference,
          const std::vector<std::string>& quantities, double until)
{
    Plan out;
    out.scene = scene_of(file);
    std::vector<std::vector<Setting>> all;
    for (const std::string& text : vary) all.push_back(varied(text));
    out.combinations = combine({}, all), out.reference = parse_reference(reference);
    out.run.quantities = quantities, out.run.until = until, out.repeat = 1;
    return out;
}

std::vector<RecordedContact> impacts(std::initializer_list<double> times)
{
    std::vector<RecordedContact> out;
    for (const double t : times) out.push_back({"contact.impact", "a", "b", t});
    return out;
}

}  // namespace

TEST_CASE("all combinations: dt varies fastest, algorithms slowest")
{
    const auto algorithm = parse_algorithm("fast: contact.response=None");
    REQUIRE(algorithm.ok());
    const auto c =
        combine({*algorithm}, {varied("dt=1/60,1/120"), varied("gear=Assign,Constraint/AngularVelocity/Graph"), varied("a.mass=2")});
    REQUIRE(c.size() == 4);
    CHECK(c[0].label() == "fast + Assign + mass 2 at 1/60 s");
    CHECK(c[1].label() == "fast + Assign + mass 2 at 1/120 s");
    CHECK(c[3].label() == "fast + AngularVelocity/Graph + mass 2 at 1/120 s");
    CHECK(c[0].settings.size() == 4);
    CHECK(combine({}, {}).front().algorithm == "as written");
    CHECK(!parse_vary("dt").ok());
    CHECK(!parse_vary("dt=1/60,,1/30").ok());
    CHECK(!parse_algorithm("solver").ok());
}

TEST_CASE("each run has a name of its own, and no setting is overridden silently")
{
    const auto why = [](const std::vector<std::string>& algorithms, const std::vector<std::string>& vary)
    {
        std::vector<Algorithm> all;
        std::vector<std::vector<Setting>> of;
        for (const std::string& text : algorithms) all.push_back(*parse_algorithm(text));
        for (const std::string& text : vary) of.push_back(varied(text));
        const auto done = check_settings(all, of);
        return done ? "none" : done.error().text();
    };
    CHECK(why({"a: x=A", "b: x=B"}, {"dt=1/60,1/120", "y=A,B", "z=A,B"}) == "none");
    CHECK(has(why({}, {"dt=1/60", "dt=1/120"}), "--vary dt is given twice: write all values in one"));
    CHECK(has(why({}, {"dt=1/60,1/60"}), "'1/60' and '1/60' are the same value, given twice"));
    CHECK(has(why({}, {"dt=1/50,1/60,20 ms"}), "'1/50' and '20 ms' are the same value"));
    CHECK(has(why({}, {"x=Kind/A,A"}), "two runs would have the name 'A'"));
    CHECK(has(why({"x=A", "y=A"}, {}), "two runs would have the name 'A'"));
    CHECK(has(why({"a: x=A", "a: x=B"}, {}), "two runs would have the name 'a'"));
    CHECK(has(why({"a: x=A x=B"}, {}), "--algorithm sets x twice"));
    CHECK(has(why({"a: x=A dt=1/60"}, {"dt=1/60,1/30"}), "dt is set by --algorithm and varied"));
}

TEST_CASE("settings: types, parameters, entries of scripts; invalid ones are reported")
{
    const model::SceneSpec scene = scene_of("scenes/studies/bounce.xml");
    const auto done =
        apply(scene, library(), {{"contact.response.restitution", "0.5"}, {"contact.resolution", "LocalBisection"}, {"dt", "2 ms"}});
    REQUIRE(done.ok());
    CHECK(done->settings.dt.denominator == 500);
    CHECK(done->find("contact.resolution")->type == "Resolution/LocalBisection");
    const auto entry = apply(scene_of("scenes/studies/oscillator.xml"), library(), varied("spring.parameters.stiffness=7"));
    REQUIRE(entry.ok());
    CHECK(has(refused(scene, "contakt.response=None"), "no component has the id 'contakt.response', did you mean 'contact.response'"));
    CHECK(has(refused(scene, "contact.response=Nobody"), "unknown type 'Response/Nobody', did you mean 'Response/None'"));
    CHECK(has(refused(scene, "solver=Nope"), "unknown type 'Solver/Nope'"));
    CHECK(has(refused(scene, "solver=Nope"), "; it can be 'Solver/Articulated', 'Solver/Automatic'"));
    CHECK(!has(refused(scene, "solver=Nope"), "Resolution/None"));
    CHECK(has(refused(scene, "solver=RungeKuta4"), "did you mean 'Solver/RungeKutta4'"));
    CHECK(has(refused(scene, "contact.response.restitutoin=1"), "did you mean 'restitution'"));
    CHECK(has(refused(scene, "contact.response.restitution=2"), "at most 1"));
    CHECK(has(refused(scene, "contact.response=Resolution/None"), "cannot be exchanged"));
    CHECK(has(refused(scene, "dt=0"), "dt must be positive"));
}

TEST_CASE("instants that step lengths share")
{
    const auto shared = [](std::initializer_list<const char*> texts)
    {
        std::vector<model::StepLength> lengths;
        for (const char* text : texts) lengths.push_back(*model::parse_step_length(text));
        return *common_instants(lengths);
    };
    CHECK(shared({"1/30", "1/60", "1/240"}).seconds == 1.0 / 30);
    CHECK(shared({"1/60", "0.001"}).seconds == 0.05);
    CHECK(shared({"1/60", "1/50"}).seconds == 0.1);
    CHECK(shared({"2/3", "1/2"}).seconds == 2.0);
}

TEST_CASE("errors are mixed and relative to the range of the reference; attitudes are angles")
{
    Quantity q;
    q.width = 2;
    const TimeSeries reference{2, {10, 0, 14, 3}}, series{2, {10, 0.07, 14.18, 3}};
    CHECK(scale_of(reference) == 4);
    const Distance d = distance(q, series, reference, 4);
    CHECK(near(d.series, 0.0175, 1e-14));
    CHECK(near(d.last, 0.01, 1e-14));
    CHECK(near(d.last_absolute, 0.18, 1e-14));
    CHECK(scale_of(TimeSeries{1, {2, 2}}) == 2);
    CHECK(scale_of(TimeSeries{1, {0, 0}}) == 1);
    CHECK(std::isnan(distance(q, TimeSeries{2, {10, 0}}, reference, 4).last));
    CHECK(std::isnan(distance(q, TimeSeries{2, {10, 0, NAN, 3}}, reference, 4).series));
    const std::vector<double> identity{1, 0, 0, 0}, turned{-std::cos(0.1), 0, -std::sin(0.1), 0};
    CHECK(near(attitude_angle(turned, identity), 0.2, 1e-15));
    CHECK(digits(1e-7) == doctest::Approx(7));
}

TEST_CASE("impacts are matched by time: missed, extra, late")
{
    const ContactFigures same = compare_contacts(impacts({1, 2.01, 3}), impacts({1, 2, 3}));
    CHECK(same.missed == 0);
    CHECK(same.extra == 0);
    CHECK(near(same.worst_time_error, 0.01, 1e-12));
    const ContactFigures missed = compare_contacts(impacts({2, 3}), impacts({1, 2, 3}));
    CHECK(missed.missed == 1);
    CHECK(missed.worst_time_error == 0);
    const ContactFigures extra = compare_contacts(impacts({1, 1.5, 2, 3}), impacts({1, 2, 3}));
    CHECK(extra.extra == 1);
    CHECK(extra.missed == 0);
    const ContactFigures another = compare_contacts(impacts({1, 2, 5}), impacts({1, 2, 3}));  // too late to be the same one
    CHECK(another.missed == 1);
    CHECK(another.extra == 1);
    CHECK(another.worst_time_error == 0);
    CHECK(compare_contacts({}, impacts({1})).missed == 1);
    CHECK(compare_contacts(impacts({1}), {}).extra == 1);
    CHECK(compare_contacts(impacts({1, 1, 1}), impacts({1})).extra == 0);  // points of one impact
}

TEST_CASE("a study of a projectile: orders, energy, cost, findings")
{
    const StudyResult r = study_of(plan("scenes/studies/projectile.xml", {"solver=SemiImplicitEuler,RungeKutta4", "dt=1/60,1/120"},
                                        "exact:parabola", {"ball.position"}, 2));
    REQUIRE(r.points.size() == 4);
    // g dt T/2 at the end.
    CHECK(near(r.points[0].errors[0].last_absolute, 9.81 * 2 / 120, 1e-10));
    CHECK(near(r.points[0].errors[0].last_absolute / r.points[1].errors[0].last_absolute, 2, 1e-9));
    CHECK(r.points[2].error() < 1e-13);
    CHECK(r.points[2].energy_drift < 1e-13);
    CHECK(r.points[2].record.evaluations > 0);
    CHECK(r.points[2].cpu_min > 0);
    CHECK(r.points[2].record.steps == 120);
    CHECK(has(findings(r).front(), "RungeKutta4 at 1/60 s"));
}

TEST_CASE("auto: Richardson finds the order, and its uncertainty holds against the closed form")
{
    Plan p =
        plan("scenes/studies/oscillator.xml", {"solver=RungeKutta4", "dt=1/120"}, "auto", {"mass.position.x", "mass.linear_velocity.x"}, 2);
    const StudyResult r = study_of(p);
    p.reference = parse_reference("exact:oscillator");
    const StudyResult exact = study_of(p);
    CHECK(r.reference.converges);
    for (std::size_t k = 0; k < 2; ++k)
    {
        CHECK(r.reference.order[k] == doctest::Approx(4).epsilon(0.05));
        const Distance error =
            distance(r.quantities[k], r.reference.time_series[k], exact.reference.time_series[k], exact.reference.scale[k]);
        CHECK(error.series <= r.reference.uncertainty[k].series);
        CHECK(error.series > 0);
        CHECK(r.reference.uncertainty[k].series < 1e-7);
    }
    CHECK(r.points[0].error() == doctest::Approx(exact.points[0].error()).epsilon(0.01));
}

TEST_CASE("a reference from a file: the trajectory that a study wrote")
{
    const std::string file = std::string(PLAB_BINARY_DIR) + "/unit_study_reference.csv";
    Plan p = plan("scenes/studies/projectile.xml", {"solver=SemiImplicitEuler", "dt=1/60"}, "exact:parabola",
                  {"ball.position", "ball.orientation"}, 2);
    const StudyResult r = study_of(p);
    REQUIRE(program::write_file(file, time_series_csv(r, r.reference.times, r.reference.time_series)).ok());
    p.reference = parse_reference(file);
    const StudyResult again = study_of(p);
    CHECK(again.points[0].error() == r.points[0].error());
    p.combinations = combine({}, {varied("dt=1/59")});
    CHECK(has(run_study(library(), p).error().text(), "has no row at"));
    p.run.quantities = {"ball.linear_velocity"};
    CHECK(has(run_study(library(), p).error().text(), "has no column 'ball.linear_velocity.x'"));
}

TEST_CASE("bounces: exact with a resolution, late without")
{
    const StudyResult r = study_of(
        plan("scenes/studies/bounce.xml", {"contact.resolution=None,LocalBisection", "dt=1/120"}, "exact:bounce", {"ball.position.z"}, 2));
    CHECK(r.points[0].error() > 1e-3);
    CHECK(r.points[1].error() < 1e-9);
    CHECK(r.points[1].contacts.expected == 3);
    CHECK(r.points[1].contacts.missed == 0);
    CHECK(r.points[1].contacts.worst_time_error < 1e-10);
    CHECK(r.points[0].contacts.worst_time_error > 1e-3);
}

TEST_CASE("auto: the uncertainty is correct where the error is known, for order 2 and for round-off")
{
    for (const auto& [solver, order] : {std::pair<std::string, double>{"StoermerVerlet", 2}, {"Exponential", 0}})
    {
        CAPTURE(solver);
        Plan p = plan("scenes/studies/oscillator.xml", {"solver=" + solver, "dt=1/120"}, "auto", {"mass.position.x"}, 2);
        const StudyResult r = study_of(p);
        p.reference = parse_reference("exact:oscillator");
        const StudyResult exact = study_of(p);
        const Distance error =
            distance(r.quantities[0], r.reference.time_series[0], exact.reference.time_series[0], exact.reference.scale[0]);
        if (order > 0) CHECK(r.reference.order[0] == doctest::Approx(order).epsilon(0.05));
        CHECK(error.series <= std::max(r.reference.uncertainty[0].series, exact.reference.uncertainty[0].series));
    }
}

TEST_CASE("a list of numbers: all of it or one element, with the name in plabd's trace")
{
    const StudyResult r =
        study_of(plan("scenes/studies/robertson.xml", {"solver=Radau5", "dt=1/10"}, "none", {"reaction.values", "reaction.values.2"}, 1));
    REQUIRE(r.quantities.size() == 2);
    CHECK(r.quantities[0].width == 3);
    CHECK(r.quantities[0].column(2) == "reaction.values.3");
    CHECK(r.quantities[1].width == 1);
    const TimeSeries &all = r.points[0].record.time_series[0], &second = r.points[0].record.time_series[1];
    CHECK(all.at(all.samples() - 1)[1] == second.values.back());
    CHECK(near(all.at(all.samples() - 1)[0] + all.at(all.samples() - 1)[1] + all.at(all.samples() - 1)[2], 1, 1e-12));
    CHECK(has(run_study(library(), plan("scenes/studies/robertson.xml", {}, "none", {"reaction.values.4"}, 1)).error().text(), "values"));
}

TEST_CASE("the response by rows gets its manager, which can be selected and set")
{
    const model::SceneSpec scene = scene_of("scenes/studies/bounce.xml");
    const auto done = apply(scene, library(),
                            {{"contact.response", "Rows"},
                             {"contact.response.manager", "SoftStep"},
                             {"contact.response.manager.substeps", "4"},
                             {"contact.resolution", "None"}});
    REQUIRE_MESSAGE(done.ok(), (done ? "" : done.error().text()));
    REQUIRE(done->find("contact.response.manager") != nullptr);
    CHECK(done->find("contact.response.manager")->type == "Manager/SoftStep");
    simulation::Simulation s(library(), 1);
    CHECK(s.load(*done).ok());
}

TEST_CASE("a failed run does not count as a small error: it is named, left out of the front, and timed up to its failure")
{
    const StudyResult r = study_of(plan("scenes/studies/spring_stand.xml", {"solver=RungeKutta4,Exponential", "dt=1/60,1/7680"},
                                        "exact:oscillator", {"table.position.z"}, 0.1));
    CHECK(r.points[0].record.outcome == Outcome::BlewUp);
    CHECK(r.points[0].cpu_min > 0);
    CHECK(r.points[1].record.ok());
    CHECK(r.points[2].error() < 1e-9);
    CHECK(r.points[1].error() < 1e-3);
    const auto reported = findings(r);
    CHECK(std::any_of(reported.begin(), reported.end(),
                      [](const auto& s) { return has(s, "One run gave no result (blew up): RungeKutta4 at 1/60 s"); }));
}

TEST_CASE("one run has no range, and runs that agree have none either")
{
    const auto energy = [](const std::vector<double>& drifts)
    {
        StudyResult r;
        for (const double drift : drifts)
        {
            Point& p = r.points.emplace_back();
            p.combination.algorithm = "R" + std::to_string(r.points.size()), p.energy_drift = drift, p.record.energy.scale = 1;
        }
        for (const std::string& s : findings(r))
            if (s.starts_with("Energy") || s.starts_with("Unexplained energy")) return s;
        return std::string();
    };
    CHECK(energy({0.25}) == "Unexplained energy, relative to the largest energy of the run: 0.25 (R1).");
    CHECK(energy({0.25, 0.25}) == "Unexplained energy, relative to the largest energy of the run: 0.25 by all.");
    CHECK(energy({0.5, 0.25}) == "Unexplained energy, relative to the largest energy of the run: from 0.25 (R2) to 0.5 (R1).");
    CHECK(energy({0}) == "Energy is kept to round-off.");
    CHECK(energy({0, 0}) == "Energy is kept to round-off by all.");
}

TEST_CASE("a plan without anything to study is an error that says what would be right")
{
    const std::string file = "scenes/studies/projectile.xml";
    const auto why = [](const Plan& p)
    {
        const auto r = run_study(library(), p);
        return r ? "none" : r.error().text();
    };
    CHECK(has(why(plan(file, {"dt=1/60"}, "none", {"bell.position"}, 1)), "did you mean 'ball'"));
    CHECK(
        has(why(plan(file, {"dt=1/60"}, "none", {"ball.positoin"}, 1)), "ball has no number 'positoin', did you mean 'position'?; it has"));
    CHECK(has(why(plan(file, {"dt=1/60"}, "none", {"ball"}, 1)), "does not name a field of ball: write ID.field, such as ball."));
    CHECK(has(why(plan(file, {"dt=1/60"}, "none", {"bell"}, 1)), "did you mean 'ball'"));
    CHECK(
        has(why(plan("scenes/studies/bounce.xml", {"dt=1/60"}, "none", {"contact.respnse.sweeps"}, 1)), "did you mean 'contact.response'"));
    Plan scaled = plan(file, {"dt=1/60"}, "none", {"ball.position"}, 1);
    scaled.scales["ball.position"] = 1;
    CHECK(why(scaled) == "none");
    scaled.scales["ball.positon"] = 1;
    CHECK(has(why(scaled), "--scale ball.positon: no quantity of that name is compared, did you mean 'ball.position'"));
    CHECK(has(why(plan(file, {"dt=1/60"}, "exact:nothing", {"ball.position"}, 1)), "there is no closed form"));
    CHECK(has(why(plan(file, {"dt=1/7,1/9"}, "none", {"ball.position"}, 0.5)), "after --until"));
}
