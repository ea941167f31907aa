// Events that report diverging motion while its numbers are finite, and none if nothing is wrong.
#include "plab/island.h"
#include "plab/registrar.h"
#include "support/ground.h"
#include "support/scene.h"

using namespace plab;
using plab::test::Scene;

namespace
{

/// 1 kg on a spring, pulled by 0.1 m.
std::string oscillator(const std::string& stiffness)
{
    return "<component id=\"mass\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\" position=\"1.1 0 0\"/>"
           "<component id=\"spring\" type=\"Constraint/SpringDamper\" b=\"mass\" anchor_a=\"0 0 0\" anchor_b=\"0 0 0\" length=\"1\" "
           "stiffness=\"" +
           stiffness + "\"/>";
}
std::string script(const std::string& force)
{
    return "<component id=\"mass\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\" linear_velocity=\"1 0 0\"/>"
           "<component id=\"push\" type=\"Script/Lua\" driven=\"mass\"><param name=\"code\">function force(t, state) driven:add_force(" +
           force + ") end</param></component>";
}
std::string flight(const std::string& resolution, const std::string& at)
{
    return "<component id=\"wall.shape\" type=\"Shape/Box\" half_extents=\"0.005 1 1\"/><component id=\"wall\" type=\"State/Static\" "
           "shape=\"wall.shape\"/><component id=\"ball.shape\" type=\"Shape/Sphere\" radius=\"0.05\"/>"
           "<component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" shape=\"ball.shape\" linear_velocity=\"1000 0 0\" position=\"" +
           at + "\"/><component id=\"contact\" type=\"CDetection/ODE\" between=\"*\" resolution=\"Resolution/" + resolution +
           "\" response=\"Response/Impulse\" response.restitution=\"1\"/>";
}

/// A defective manager: it satisfies no contact, and accelerates the bodies by 1 % per step.
struct WrongRows
{
    Column<double> gain;
    void describe(Schema& s) { s.param(gain, "gain", unit::one, "of speeds in a step").or_else(0.01); }
};
void solve_wrongly(const StepContext&, Row row, WrongRows& rows, Bodies& bodies, Shafts&, Island& island)
{
    island.motion->kick(island.h);
    for (const std::uint32_t b : island.bodies)
    {
        bodies.velocity[b].z = 0;
        bodies.velocity[b] *= 1 + rows.gain[row];
    }
    island.motion->move_mean(island.h);
}

/// The types of this build, and the defective manager.
class WithWrong final : public model::TypeSource
{
public:
    WithWrong()
    {
        Registrar registrar;
        registrar.component<WrongRows>("Manager/Wrong", "makes energy")
            .command<solve_wrongly>(Phase::Solve, "Manager/Solve", "makes energy");
        REQUIRE(own_.add(std::move(registrar), "wrong"));
    }
    Result<const model::ComponentType*> require(const std::string& name) override
    {
        if (const auto* type = own_.find(name)) return type;
        return test::library().require(name);
    }
    std::vector<std::string> names() const override { return test::library().names(); }

private:
    model::TypeRegistry own_;
};

const std::string kEuler = "dt=\"1/60\" solver=\"Solver/SemiImplicitEuler\"";

}  // namespace

TEST_CASE("a spring too stiff for its solver's step is reported once, with the energy that it gained")
{
    Scene s(oscillator("20000"), kEuler);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    s.run(1);
    REQUIRE(s.count("motion.diverged") == 1);
    for (const Event& e : s.events)
        if (e.kind == "motion.diverged")
        {
            REQUIRE(e.values.size() == 3);
            CHECK(s.simulation().world().id_of(e.component) == "mass");
            CHECK(e.values[1] == doctest::Approx(0.5 * 20000 * 0.01));  // J, the initial energy
            CHECK(e.values[0] > 10 * e.values[1]);
            CHECK(e.severity == Severity::Warning);
        }
}

TEST_CASE("a spring within the stability limit is not reported, however large its error")
{
    for (const char* k : {"100", "10000", "14000"})  // h w = 0.17, 1.7, 1.97
    {
        Scene s(oscillator(k), kEuler);
        s.run(10);
        CHECK(std::fabs(s.vec("mass", "position").x - 1) < 1);
    }
}

TEST_CASE("joints of motion that diverged do much work on one another, which does not hide it")
{
    // Two links with a limit between them, and a weight on a spring: h w = 6 for RungeKutta4, which is stable up to 2.8.
    const auto link = [](const char* id, const char* x, const char* mass)
    {
        const std::string inertia = std::string(mass) + "e-2";
        return "<component id=\"" + std::string(id) + "\" type=\"State/RigidBody\" mass=\"" + mass + "\" inertia=\"" + inertia + " " +
               inertia + " " + inertia + "\" position=\"" + x + " 0 0\"/>";
    };
    Scene s(
        link("upper", "0", "1") + link("lower", "0.3", "1") + link("weight", "0.6", "0.3") +
            "<component id=\"top\" type=\"Constraint/Hinge\" b=\"upper\" anchor=\"-0.15 0 0\" axis=\"0 1 0\"/>"
            "<component id=\"knee\" type=\"Constraint/Hinge\" a=\"upper\" b=\"lower\" anchor=\"0.15 0 0\" axis=\"0 1 0\"/>"
            "<component id=\"stop\" type=\"Constraint/Limit\" a=\"upper\" b=\"lower\" anchor=\"0.15 0 0\" axis=\"0 1 0\" "
            "lower=\"-0.3\" upper=\"0.3\"/>"
            "<component id=\"spring\" type=\"Constraint/SpringDamper\" a=\"lower\" b=\"weight\" anchor_a=\"0.1 0 0\" "
            "anchor_b=\"0 0 0.05\" stiffness=\"40000\" damping=\"10\"/><component id=\"gravity\" type=\"Field/Gravity\" between=\"*\"/>",
        "dt=\"1/60\" solver=\"Solver/RungeKutta4\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    s.run(0.5);
    CHECK(s.count("motion.diverged") == 1);
}

TEST_CASE("a speed that doubles every few steps is reported; one that grows by a steady force, or slowly, is not")
{
    Scene away(script("50 * driven.velocity"), kEuler);
    away.warnings_expected = away.keep_events = true;
    away.run(1);
    CHECK(away.count("motion.diverged") == 1);
    Scene(script("vec(1e6, 0, 0)"), kEuler).run(10);
    Scene(script("driven.velocity"), kEuler).run(10);
}

TEST_CASE("a request that adds energy is not a divergence")
{
    Scene s(oscillator("100"), kEuler);
    s.run(1);
    REQUIRE(s.ask(simulation::SetOperation{"mass", "linear_velocity", std::string("1e5 0 0")}).done);
    s.run(2);
    REQUIRE(s.ask(simulation::SetOperation{"mass", "position", std::string("1e4 0 0")}).done);
    s.run(3);
}

TEST_CASE("a ball that flies through a wall between two detections is reported; one that bounces or flies past is not")
{
    Scene through(flight("None", "-50.3 0 0"), "dt=\"1/60\"");
    through.warnings_expected = through.keep_events = true;
    through.run(0.1);
    CHECK(through.count("contact.missed") == 1);
    Scene bounces(flight("LocalRoot", "-50.3 0 0"), "dt=\"1/60\"");
    bounces.run(0.1);
    CHECK(bounces.vec("ball", "linear_velocity").x == doctest::Approx(-1000));
    Scene past(flight("None", "-50.3 1.2 0"), "dt=\"1/60\"");
    past.run(0.1);
}

TEST_CASE("bodies that remain sunk into one another are reported; an overlap that is corrected is not")
{
    const auto pair = [](const std::string& mass, const std::string& manager)
    {
        return "<component id=\"floor\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"floor\"/>"
               "<component id=\"cube\" type=\"Shape/Box\" half_extents=\"0.5 0.5 0.5\"/>"
               // So wide that the low one does not slip out under it.
               "<component id=\"slab\" type=\"Shape/Box\" half_extents=\"5 5 0.5\"/>"
               "<component id=\"low\" type=\"State/RigidBody\" mass=\"1\" shape=\"cube\" position=\"0 0 0.45\"/>"
               "<component id=\"high\" type=\"State/RigidBody\" mass=\"" +
               mass +
               "\" shape=\"slab\" position=\"0 0 1.45\"/><component id=\"g\" type=\"Field/Gravity\" between=\"*\"/>"
               "<component id=\"contact\" type=\"CDetection/ODE\" between=\"*\" response=\"Response/Rows\" response.manager=\"Manager/" +
               manager + "\" resolution=\"Resolution/None\"/>";
    };
    Scene sinks(pair("1e6", "SequentialImpulse"), "dt=\"1/60\"");
    sinks.warnings_expected = sinks.keep_events = true;
    sinks.run(1);
    CHECK(sinks.count("contact.deep") >= 1);
    CHECK(sinks.count("contact.deep") <= 2);
    Scene(pair("1e6", "Direct"), "dt=\"1/60\"").run(1);
}

TEST_CASE("a manager that adds energy is reported, and this energy stays unexplained")
{
    WithWrong types;
    const auto run = [&](const std::string& gain)
    {
        const auto blueprint = blueprint::read_blueprint(
            test::whole_scene(std::string(test::kGround) +
                                  "<component id=\"box.shape\" type=\"Shape/Box\" half_extents=\"0.1 0.1 0.1\"/>"
                                  "<component id=\"box\" type=\"State/RigidBody\" shape=\"box.shape\" mass=\"1\" position=\"0 0 0.1\" "
                                  "linear_velocity=\"1 0 0\"/><component id=\"weight\" type=\"Field/Gravity\" between=\"box\"/>"
                                  "<component id=\"contact\" type=\"CDetection/ODE\" between=\"box ground\" resolution=\"Resolution/None\" "
                                  "response=\"Response/Rows\" response.manager=\"Manager/Wrong\" response.manager.gain=\"" +
                                  gain + "\"/>",
                              "dt=\"1/240\""),
            "wrong.xml");
        REQUIRE(blueprint);
        const auto spec = model::compile(*blueprint, types);
        REQUIRE_MESSAGE(spec, test::reasons(spec));
        simulation::Simulation s(types);
        REQUIRE(s.load(*spec));
        int reported = 0;
        for (int i = 0; i < 240; ++i)
        {
            REQUIRE(s.step());
            for (const Event& e : s.events())
                reported += e.kind == "contact.gains_energy" && s.world().id_of(e.component) == "contact.response.manager" ? 1 : 0;
        }
        const simulation::Totals t = s.totals();
        const double made = s.stepper().contact_energy()[s.world().find("contact.response.manager")].created;
        // Any energy beyond the initial one is not the work of a force: the manager has added it.
        CHECK(made == doctest::Approx(t.kinetic - 0.5));
        CHECK(t.kinetic - s.kinetic_at_start() - t.work == doctest::Approx(made));
        return reported;
    };
    CHECK(run("0.01") == 1);
    CHECK(run("0") == 0);
}
