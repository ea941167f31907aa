// The types of the constraints plugin: declarations, ratios, outputs.
#include <cmath>

#include "angular_velocity/ratio.h"
#include "train.h"

using namespace plab;
using namespace plab::test;
using constraints::ratio_of;
using constraints::simple_ratio;

TEST_CASE("factors written as decimals or quotients are the rationals that they mean")
{
    struct Case
    {
        double factor;
        std::int64_t numerator, denominator;
    };
    const Case cases[] = {{-0.5, -1, 2},
                          {1, 1, 1},
                          {1.0 / 3, 1, 3},
                          {0.1, 1, 10},
                          {1e-6, 1, 1000000},
                          {1e6, 1000000, 1},
                          {6.0001, 60001, 10000},
                          {1 / 6.0001, 10000, 60001},
                          {-22.0 / 7, -22, 7},
                          {0x1p-19, 1, 524288},
                          {999983.0 / 999979, 999983, 999979},
                          {0x1p52, 4503599627370496, 1}};
    for (const Case& c : cases)
    {
        const Ratio r = simple_ratio(c.factor);
        CAPTURE(c.factor);
        CHECK(r.exact);
        CHECK(r.numerator == c.numerator);
        CHECK(r.denominator == c.denominator);
        CHECK(r.value == c.factor);
    }
    for (const double f : {M_PI, std::sqrt(2.0), 1e-7, 1e300, 1e-300, -0.333333333333, 0.10000000000001})
    {
        const Ratio r = simple_ratio(f);
        CHECK_MESSAGE(!r.exact, f, " = ", r.numerator, "/", r.denominator);
        CHECK(r.value == f);
    }
}

TEST_CASE("teeth give the factor, with the sign of the mesh")
{
    const Ratio external = *ratio_of({1, 20, 40, "external"});
    CHECK(external.exact);
    CHECK(external.numerator == -1);
    CHECK(external.denominator == 2);
    CHECK(external.value == -0.5);
    CHECK(ratio_of({1, 20, 40, "internal"})->value == 0.5);
    CHECK(ratio_of({1, 30, 20, "belt"})->value == 1.5);
}

TEST_CASE("impossible factors are refused with the reason")
{
    const auto why = [](const constraints::FactorGiven& g)
    {
        const auto r = ratio_of(g);
        return r.ok() ? std::string("accepted") : r.error().reason;
    };
    CHECK(why({2, 20, 40, "external"}) == "the ratio is given twice; give either velocity_factor or driver_teeth and driven_teeth");
    CHECK(why({1, -20, 40, "external"}) == "driver_teeth must be positive, not -20");
    CHECK(why({1, 20, -40, "external"}) == "driven_teeth must be positive, not -40");
    CHECK(why({1, 20, 0, "external"}) == "driver_teeth and driven_teeth must be given together and positive; driven_teeth is missing or 0");
    CHECK(why({1, 0, 20, "external"}) == "driver_teeth and driven_teeth must be given together and positive; driver_teeth is missing or 0");
    CHECK(why({2, 0, 0, "internal"}) == "mesh 'internal' needs driver_teeth and driven_teeth; a velocity_factor has its own sign");
    CHECK(why({0, 0, 0, "external"}) == "velocity_factor must be finite and other than 0");
    CHECK(why({NAN, 0, 0, "external"}) == "velocity_factor must be finite and other than 0");
}

TEST_CASE("the three algorithms can replace one another")
{
    const CouplingTable assign("Assign"), impulse("Impulse"), graph("Graph");
    for (const CouplingTable* t : {&assign, &impulse, &graph})
    {
        CAPTURE(t->type().name);
        CHECK(t->type().family == "Constraint/AngularVelocity");
        REQUIRE(t->schema().roles().size() == 2);
        for (const char* name : {"driver", "driven"})
        {
            const Role* role = t->schema().find_role(name);
            REQUIRE(role != nullptr);
            CHECK(role->facets == std::vector<Facet>{Facet::Shaft});
            CHECK(role->min == 1);
            CHECK(role->max == 1);
        }
        CHECK(t->schema().find_role("driven")->writes);
        CHECK(t->schema().find_role("driven")->exclusive == (t == &assign));
        CHECK(t->schema().find_role("driver")->writes == (t != &assign));
        REQUIRE(t->schema().fields().size() == assign.schema().fields().size());
        for (std::size_t i = 0; i < assign.schema().fields().size(); ++i)
            CHECK(t->schema().fields()[i].name == assign.schema().fields()[i].name);
        bool couples = false;
        for (const CommandInfo& c : t->type().commands)
            couples = couples || (c.name == "Constraint/AngularVelocity" && c.phase == Phase::Couple);
        CHECK(couples);
    }
}

TEST_CASE("Prepare refuses a row with the reason")
{
    CouplingTable t("Graph");
    const Row row = t.add(0, 0, 1, 2.0);
    CHECK(t.prepare().ok());
    t.set(row, "driver_teeth", std::int64_t{10});
    t.set(row, "driven_teeth", std::int64_t{20});
    const auto r = t.prepare();
    REQUIRE_FALSE(r.ok());
    CHECK(r.error().reason.find("given twice") != std::string::npos);
}

TEST_CASE("Finish measures errors and torque; the phase counts from the engagement, and again with another factor")
{
    Train t;
    t.add_shaft(10, 4), t.add_shaft(100, -0.5);
    t.shafts.angle = {2, 7};
    CouplingTable rows("Graph");
    const Row row = rows.add(0, 0, 1, -0.1);
    REQUIRE(rows.prepare().ok());
    rows.connect(t.graph);
    t.build();
    t.begin_accelerations({6, 0});
    t.react();
    rows.finish(t);
    CHECK(rows.get(row, "phase_offset") == doctest::Approx(7.2).epsilon(1e-15));
    CHECK(rows.get(row, "phase_error") == 0);
    CHECK(rows.get(row, "velocity_error") == doctest::Approx(-0.1).epsilon(1e-15));
    CHECK(relative_error(rows.get(row, "torque"), -60.0 / 11) < 1e-15);

    t.shafts.angle = {12, 6.25};
    rows.finish(t);
    CHECK(rows.get(row, "phase_error") == doctest::Approx(0.25).epsilon(1e-14));

    rows.set(row, "velocity_factor", 0.5);
    REQUIRE(rows.prepare().ok());
    rows.finish(t);
    CHECK(rows.get(row, "phase_error") == 0);
    CHECK(rows.get(row, "phase_offset") == 0.25);
}
