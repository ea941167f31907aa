// One error for each interaction that can be compared along its ladder: by a shadow step, which leaves the run as it is.
#include "publish/error_probe.h"

#include "model/ladders.h"
#include "support/scene.h"

using namespace plab;
using namespace plab::test;

namespace
{

const char* const kGears =
    "<component id='a' type='State/Shaft' inertia='1' angular_velocity='2'/><component id='b' type='State/Shaft' inertia='4'/>"
    "<component id='push' type='Field/Load' between='a' shaft_torque='3'/>"
    "<component id='mesh' type='Constraint/AngularVelocity/Assign' driver='a' driven='b' velocity_factor='-0.5'/>";

publish::ErrorFigure shadow(const Scene& s, const std::string& id)
{
    const std::uint32_t i = s.simulation().world().find(id);
    auto figure = publish::shadow_error(s.simulation(), i, model::finer_than(s.simulation().world().type_of(i)->info.name));
    REQUIRE_MESSAGE(figure.ok(), reasons(figure));
    return *figure;
}

}  // namespace

TEST_CASE("the error of Assign, which reports no residual, is the reaction torque that it omits")
{
    Scene s(kGears);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(10);
    const publish::ErrorFigure figure = shadow(s, "mesh");
    // Closed form: alone, the driver gains torque / inertia = 3 rad/s2; with the gear 3 / (1 + 0.25 * 4) = 1.5. Positions: half of that.
    CHECK(figure.value == doctest::Approx(1.5).epsilon(1e-6));
    CHECK(figure.unit == "rad/s2");
    CHECK(figure.meaning == "per second of a step, against Constraint/AngularVelocity/Graph");
}

TEST_CASE("the error of a solver of order 1 is its difference in one step from one of order 4, whose own error is far smaller")
{
    // w' = -2 w from w = 1, x = 0, over one step: semi-implicit Euler against RungeKutta4.
    const std::string spring =
        "<component id='s' type='State/Shaft' inertia='1' angular_velocity='1'/><component id='air' type='Field/Drag' between='s' "
        "rotational='2'/>";
    const auto error = [&](const char* solver)
    {
        Scene s(spring + std::string("<component id='x' type='Solver/") + solver + "'/>", std::string("dt='1/100' solver='x'"));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        return shadow(s, "x").value;
    };
    // Speeds are 0.019867 rad/s2 apart: (exp(-2 h) - (1 - 2 h)) / h at h = 0.01. Angles more: ((1 - exp(-2 h)) / 2 - h (1 - 2 h)) / h^2.
    CHECK(error("SemiImplicitEuler") == doctest::Approx(1.00663346).epsilon(1e-5));
    CHECK(error("RungeKutta4") < 1e-6);
}

TEST_CASE("shadow steps leave the run bit for bit as it is")
{
    const auto hashes = [](bool measured)
    {
        Scene s = Scene::file("scenes/fan_and_balloons.xml");
        s.warnings_expected = true;
        publish::ErrorProbe probe(0.5);
        std::vector<std::uint64_t> out;
        for (int i = 0; i < 200; ++i)
        {
            s.step();
            out.push_back(s.hash());
            if (measured) probe.follow(s.simulation(), std::int64_t{1} << (40 + i / 10));  // always due
        }
        return out;
    };
    CHECK(hashes(true) == hashes(false));
}

TEST_CASE("the finest algorithm reports that none is finer and gives its own residual; without a residual no error is given")
{
    Scene s(std::string(kGears) +
            "<component id='c' type='State/Shaft' inertia='1'/>"
            "<component id='fine' type='Constraint/AngularVelocity/Graph' driver='a' driven='c' velocity_factor='2'/>");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(5);
    publish::ErrorProbe probe(0.5);
    const auto figure = [&](const char* id) { return probe.of(s.simulation(), s.simulation().world().find(id)); };
    CHECK(figure("fine").unit.starts_with("rad"));
    CHECK(figure("fine").meaning.find("_error: ") != std::string::npos);
    CHECK(figure("fine").meaning.find("no algorithm of its family is finer") != std::string::npos);
    CHECK(std::isnan(figure("push").value));
    for (std::int64_t i = 1; i < 10; ++i) probe.follow(s.simulation(), i << 40);
    CHECK(figure("mesh").meaning.find("against Constraint/AngularVelocity/Graph") != std::string::npos);
    // The driver also carries c: inertia 5 without the reaction of the mesh, 6 with it. Driven: 0.5 (3 / 5 - 3 / 6), driver 3 / 5 -
    // 3 / 6.
    CHECK(figure("mesh").value == doctest::Approx(0.1).epsilon(1e-3));
}

TEST_CASE("with a share of 0 no shadow step is made")
{
    Scene s(kGears);
    s.step(5);
    publish::ErrorProbe probe(0);
    probe.follow(s.simulation(), std::int64_t{1} << 50);
    CHECK(probe.of(s.simulation(), s.simulation().world().find("mesh")).meaning.find("against") == std::string::npos);
}
