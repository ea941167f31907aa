// After an exchange only what may have changed is derived again. The result is what a derivation of everything gives: the same run,
// restored from a snapshot after each request, has a new world and a new stepper.
#include <algorithm>
#include <sstream>

#include "plab/random.h"
#include "simulation/snapshot/compare.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::first_error;
using plab::test::Scene;

namespace
{

std::string component(const std::string& id, const std::string& type, const std::string& more = "")
{
    return "<component id=\"" + id + "\" type=\"" + type + "\" " + more + "/>\n";
}

/// A mechanism of each kind, with solvers of their own: weights on springs, a chain, trains of gears, and boxes that lie on the ground.
std::string scene()
{
    std::string out = component("gravity", "Field/Gravity", "between=\"*\"") + component("common", "Solver/RungeKutta4") +
                      component("box", "Shape/Box", "half_extents=\"0.25 0.25 0.25\"") + component("plane", "Shape/Plane") +
                      component("ground", "State/Static", "shape=\"plane\"") + component("manager", "Manager/SoftStep", "substeps=\"4\"") +
                      component("contact", "CDetection/ODE",
                                "between=\"*\" resolution=\"Resolution/None\" response=\"Response/Rows\" response.manager=\"manager\" "
                                "response.friction=\"0.6\"");
    for (int i = 0; i < 6; ++i)
    {
        const std::string n = std::to_string(i), at = std::to_string(3 * i), engine = "solver=\"engine" + n + "\"";
        out += component("engine" + n, "Solver/RungeKutta4") + component("hook" + n, "State/Static", "position=\"" + at + " 9 8\"") +
               component("weight" + n, "State/RigidBody", "mass=\"1\" inertia=\"1 1 1\" position=\"" + at + " 9 6.8\" " + engine) +
               component("spring" + n, "Constraint/SpringDamper",
                         "a=\"hook" + n + "\" b=\"weight" + n + "\" length=\"1\" stiffness=\"" + std::to_string(40 + 60 * i) + "\"") +
               component("link" + n, "State/RigidBody", "mass=\"1\" inertia=\"1 1 1\" position=\"" + at + " 12 6\" " + engine) +
               component("ball" + n, "Constraint/Ball", "a=\"hook" + n + "\" b=\"link" + n + "\" anchor_a=\"0 3 -1\" anchor_b=\"0 0 1\"");
        for (int k = 0; k < 3; ++k)
            out += component("shaft" + n + std::to_string(k), "State/Shaft", "inertia=\"" + std::to_string(1 + k) + "\" " + engine);
        for (int k = 0; k < 2; ++k)
            out += component(
                "gear" + n + std::to_string(k), "Constraint/AngularVelocity/Graph",
                "driver=\"shaft" + n + std::to_string(k) + "\" driven=\"shaft" + n + std::to_string(k + 1) + "\" velocity_factor=\"-0.5\"");
        out += component("load" + n, "Field/Load", "between=\"shaft" + n + "0\" shaft_torque=\"1\"");
        for (int k = 0; k < 2; ++k)
            out +=
                component("box" + n + std::to_string(k), "State/RigidBody",
                          "shape=\"box\" mass=\"1\" solver=\"common\" position=\"" + at + " 0 " + std::to_string(0.251 + 0.501 * k) + "\"");
    }
    return out;
}

/// Requests that follow from a number.
class Requests
{
public:
    explicit Requests(std::uint64_t seed) : seed_(seed), types_(test::library().names()) {}

    Request next(const Simulation& s)
    {
        Request request;
        // A proof takes time, so most requests go without.
        request.trial.budget = pick(8) == 0 ? TrialChoice::Budget::Unlimited : TrialChoice::Budget::None;
        const std::size_t kind = pick(10);
        if (kind < 4)
            for (std::size_t k = 1 + pick(4); k > 0; --k) request.operations.push_back(swap_of(s, "engine"));
        else if (kind < 5)
            request.operations.push_back(SetOperation{"engine" + std::to_string(pick(6)), "max_substeps", std::string("900")});
        else if (kind < 8)
            request.operations.push_back(swap_of(s, ""));
        else if (kind < 9)
            request.operations.push_back(change(s));
        else
            request.operations.push_back(add_or_remove(s));
        return request;
    }
    std::size_t pick(std::size_t n) { return next_random(seed_) % n; }

private:
    /// For another type of the family, of a component whose id begins in this way.
    Operation swap_of(const Simulation& s, const std::string& beginning)
    {
        std::vector<std::uint32_t> all;
        for (const std::uint32_t i : s.world().in_id_order())
            if (s.world().type_of(i) && s.world().id_of(i).rfind(beginning, 0) == 0) all.push_back(i);
        const std::uint32_t chosen = all[pick(all.size())];
        std::vector<std::string> choices;
        for (const std::string& t : types_)
            if (const auto type = test::library().require(t); type && (*type)->why_not_exchangeable(*s.world().type_of(chosen)).empty())
                choices.push_back(t);
        return SwapOperation{s.world().id_of(chosen), choices[pick(choices.size())], {}};
    }
    Operation change(const Simulation&)
    {
        const std::string n = std::to_string(pick(6));
        switch (pick(5))
        {
            case 0:
                return SetOperation{"spring" + n, "stiffness", std::to_string(30 + pick(90))};
            case 1:
                return SetOperation{"shaft" + n + "1", "inertia", std::to_string(1 + pick(5))};
            case 2:
                return SetOperation{"box" + n + "1", "mass", std::to_string(1 + pick(3))};
            case 3:
                return PushOperation{"box" + n + "1", {0.4, 0, 0}, {}};
            default:
                return SetOperation{"contact.response", "friction", "0." + std::to_string(2 + pick(7))};
        }
    }
    Operation add_or_remove(const Simulation& s)
    {
        const std::string id = "guest" + std::to_string(pick(3));
        if (s.world().find(id) != kNoIndex) return RemoveOperation{id};
        const auto fragment = test::compile_text(
            test::whole_scene(component(id, "State/RigidBody", "mass=\"1\" inertia=\"1 1 1\" position=\"0 20 0\" solver=\"engine1\"")),
            "request.xml", &s.world().scene());
        REQUIRE_MESSAGE(fragment.ok(), test::reasons(fragment));
        return AddOperation{*fragment};
    }

    std::uint64_t seed_;
    std::vector<std::string> types_;
};

/// What a stepper has derived, in words, with ids in place of rows and indices.
std::string structure_of(const Simulation& s)
{
    const world::World& world = s.world();
    const Stepper& stepper = s.stepper();
    std::string out;
    const auto name = [&](std::uint32_t component) { out += component == kNoIndex ? " -" : " " + world.id_of(component); };
    for (int p = 0; p < kPhaseCount; ++p)
        for (const Block& block : stepper.schedule().of(static_cast<Phase>(p)))
        {
            out += "\nphase " + std::to_string(p) + " " + std::string(block.command->name) + (block.alone ? " alone:" : ":");
            for (const Row row : block.rows) name(world.tables()[block.table]->component_of_row()[row]);
        }
    for (const Group& group : stepper.groups().all)
    {
        out += "\ngroup of cluster " + std::to_string(group.cluster) + (group.mixed_solvers ? ", mixed:" : ":");
        name(group.solver);
        for (const auto* bodies : {&group.bodies, &group.prescribed_bodies})
            for (const std::uint32_t b : *bodies) name(world.host().component_of({Facet::Body, b}));
        for (const auto* shafts : {&group.shafts, &group.prescribed_shafts})
            for (const std::uint32_t x : *shafts) name(world.host().component_of({Facet::Shaft, x}));
        for (const std::uint32_t up : group.upstream) out += " reads " + std::to_string(up);
        for (const auto& [phase, rows] :
             {std::pair(Phase::Force, &group.forces), std::pair(Phase::Couple, &group.couplings), std::pair(Phase::Constrain, &group.rows)})
            for (const BlockRow& r : *rows) name(world.tables()[stepper.schedule().of(phase)[r.block].table]->component_of_row()[r.row]);
    }
    for (const ShaftNode& n : stepper.graph().nodes())
    {
        out +=
            "\nshaft " + world.id_of(Ref{Facet::Shaft, n.shaft}) + " " + std::to_string(n.ratio) + " " + std::to_string(n.inertia_inside);
        name(n.component);
    }
    for (const Detector& d : stepper.detectors())
    {
        out += "\ndetector:";
        for (const std::uint32_t part : {d.component, d.resolution, d.response, d.manager}) name(part);
    }
    out += "\nsplit:";
    for (const std::uint32_t part : stepper.split()) out += " " + std::to_string(part);
    return out;
}

/// The first line in which the structures differ.
std::string difference_of_structure(const Simulation& a, const Simulation& b)
{
    std::istringstream x(structure_of(a)), y(structure_of(b));
    for (std::string one, other; std::getline(x, one) && std::getline(y, other);)
        if (one != other) return one + "\nin place of " + other;
    return structure_of(a) == structure_of(b) ? std::string() : "one of them has further lines";
}

/// Between the states, outputs and works of two runs.
std::string difference(const Simulation& a, const Simulation& b)
{
    Comparison all;
    all.outputs = true;
    if (const auto found = compare(a.capture(), b.capture(), all)) return found->text();
    for (const std::uint32_t i : a.world().in_id_order())
        if (a.stepper().work()[i] != b.stepper().work()[b.world().find(a.world().id_of(i))]) return "work of " + a.world().id_of(i);
    return {};
}

}  // namespace

TEST_CASE("after any request, what is derived again and what is kept give the run in which everything is derived")
{
    for (const int threads : {1, 3})
    {
        CAPTURE(threads);
        Scene kept(scene(), "dt='1/120'", threads), derived(scene(), "dt='1/120'", threads);
        REQUIRE_MESSAGE(kept.loaded(), kept.error());
        kept.warnings_expected = derived.warnings_expected = true;
        Requests requests(2026 + static_cast<std::uint64_t>(threads));
        int done = 0, refused = 0;
        for (int i = 0; i < 160; ++i)
        {
            const Request request = requests.next(kept.simulation());
            const Reply reply = kept.simulation().carry_out_now(request), other = derived.simulation().carry_out_now(request);
            CAPTURE(i);
            REQUIRE(reply.done == other.done);
            ++(reply.done ? done : refused);
            const Result<void> restored = derived.simulation().restore(derived.simulation().capture());
            REQUIRE_MESSAGE(restored.ok(), test::reasons(restored));
            REQUIRE(difference_of_structure(kept.simulation(), derived.simulation()) == "");
            const auto steps = static_cast<std::int64_t>(requests.pick(3));
            kept.step(steps), derived.step(steps);
            REQUIRE(difference(kept.simulation(), derived.simulation()) == "");
            REQUIRE(kept.hash() == derived.hash());
        }
        CHECK(done > 100);
        CHECK(refused > 0);
    }
}

TEST_CASE("an exchange of solvers or answers leaves the locator of events as it is, and impacts are what a new one finds")
{
    std::string balls = component("weight", "Field/Gravity", "between=\"*\"") + component("plane", "Shape/Plane") +
                        component("ground", "State/Static", "shape=\"plane\"") + component("form", "Shape/Sphere", "radius=\"0.1\"");
    for (const char* n : {"0", "1", "2"})
        balls +=
            component(std::string("ball") + n, "State/RigidBody",
                      std::string("shape=\"form\" mass=\"1\" linear_velocity=\"0.3 0 0\" solver=\"Solver/RungeKutta4\" position=\"0.") + n +
                          "5 0 0.3\"");
    balls += component("contact", "CDetection/ODE",
                       "between=\"ball0 ball1 ball2\" against=\"ground\" resolution=\"Resolution/LocalRoot\" response=\"Response/Impulse\" "
                       "response.restitution=\"0.9\" response.friction=\"0.2\"");
    Scene kept(balls, "dt='1/120'"), derived(balls, "dt='1/120'");
    REQUIRE_MESSAGE(kept.loaded(), kept.error());
    kept.keep_events = true;
    for (int i = 0; i < 12; ++i)
    {
        const char* const solver = i % 2 == 0 ? "Solver/DormandPrince54" : "Solver/RungeKutta4";
        const char* const answer = i % 4 == 1 ? "Resolution/LocalBisection" : "Resolution/LocalRoot";
        const SwapOperation swap = i % 3 == 2 ? SwapOperation{"contact.resolution", answer, {}}
                                              : SwapOperation{"ball" + std::to_string(i % 3) + ".solver", solver, {}};
        for (Scene* s : {&kept, &derived})
        {
            const Reply reply = s->ask(swap);
            REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
        }
        REQUIRE(derived.simulation().restore(derived.simulation().capture()).ok());
        kept.step(17), derived.step(17);
        REQUIRE(difference(kept.simulation(), derived.simulation()) == "");
    }
    CHECK(kept.vec("ball0", "position").x > 0.15);  // it rolls from 0.05 m, and bounces
    CHECK(kept.vec("ball0", "position").z < 0.35);
}

TEST_CASE("an exchange of solvers leaves the blocks of forces where they are, and one of a force does not")
{
    Scene s(scene(), "dt='1/120'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(2);
    const auto forces = [&] { return s.simulation().stepper().schedule().of(Phase::Force).data(); };
    const Block* before = forces();
    const Reply solver = s.ask(SwapOperation{"engine1", "Solver/DormandPrince54", {}});
    REQUIRE_MESSAGE(solver.done, first_error(solver.errors));
    CHECK(forces() == before);
    const Reply spring =
        s.ask_all({SwapOperation{"spring1", "Constraint/SpringDamper", {}}, SwapOperation{"engine1", "Solver/RungeKutta4", {}}});
    REQUIRE_MESSAGE(spring.done, first_error(spring.errors));
    CHECK(forces() != before);
}
