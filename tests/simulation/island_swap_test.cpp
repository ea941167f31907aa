// A swap costs what it touches: its trial steps the islands of what it acts on and gives the figures of a trial of the whole scene, and a
// refused swap leaves no trace in them or anywhere else.
#include <cmath>
#include <functional>

#include "simulation/snapshot/compare.h"
#include "simulation/snapshot/format.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::first_error;
using plab::test::Scene;

namespace
{

std::string component(const std::string& id, const std::string& type, const std::string& more)
{
    return "<component id=\"" + id + "\" type=\"" + type + "\" " + more + "/>\n";
}

const std::string kGears = component("own", "Solver/RungeKutta4", "") + component("s0", "State/Shaft", "inertia=\"1\" solver=\"own\"") +
                           component("s1", "State/Shaft", "inertia=\"2\" solver=\"own\" angular_velocity=\"0.5\"") +
                           component("load", "Field/Load", "between=\"s0\" shaft_torque=\"1\"") +
                           component("gear", "Constraint/AngularVelocity/Graph", "driver=\"s0\" driven=\"s1\" velocity_factor=\"-1\"");

/// Pairs of bodies with a spring each, "x<k>" and "y<k>" joined by "spring<k>", all with one solver, which keeps what it measures between
/// its systems.
std::string springs(const std::string& solver)
{
    std::string out = component("solver", solver, "") + component("gravity", "Field/Gravity", "between=\"*\"");
    for (int k = 0; k < 6; ++k)
    {
        const std::string n = std::to_string(k), body = "mass=\"1\" inertia=\"1 1 1\" position=\"";
        out += component("x" + n, "State/RigidBody", body + test::text(Vec3{2.0 * k, 0, 0}) + "\" linear_velocity=\"0 0.1 0\"") +
               component("y" + n, "State/RigidBody", body + test::text(Vec3{2.0 * k + 0.7, 0, 0}) + "\"") +
               component("spring" + n, "Constraint/SpringDamper",
                         "a=\"x" + n + "\" b=\"y" + n + "\" length=\"0.5\" stiffness=\"" + std::to_string(20 + 300 * k) + "\"");
    }
    return out;
}

/// Stacks of `high` boxes on a plane, bodies "b<stack>.<place>". The uppermost of each still falls.
std::string stacks(int count, int high, const std::string& resolution, const std::string& response, const std::string& more = "")
{
    std::string out = component("gravity", "Field/Gravity", "between=\"*\"") +
                      component("q", "Shape/Box", "half_extents=\"0.25 0.25 0.25\"") + component("plane", "Shape/Plane", "") +
                      component("ground", "State/Static", "shape=\"plane\"") +
                      component("contact", "CDetection/ODE",
                                "between=\"*\" resolution=\"Resolution/" + resolution + "\" response=\"Response/" + response +
                                    "\" response.friction=\"0.6\"" + more);
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < high; ++k)
            out += component("b" + std::to_string(i) + "." + std::to_string(k), "State/RigidBody",
                             "shape=\"q\" mass=\"1\" position=\"" +
                                 test::text(Vec3{0.9 * i, 0.02 * (k % 2), 0.251 + 0.501 * k + (k + 1 == high ? 0.3 : 0)}) + "\"");
    return out;
}

/// Stacks, of which one is tall, that are too large islands for `Resolution/Automatic` to locate their impacts; bodies that fall on them,
/// which are apart; and a fast body, because of which gaps that may close count as contacts.
std::string stacks_and_a_tall_one(int count, int high)
{
    std::string out = stacks(count, high, "Automatic", "Rows", " resolution.max_bodies=\"2\"");
    for (int k = 0; k < 7; ++k)
        out += component("tall." + std::to_string(k), "State/RigidBody",
                         "shape=\"q\" mass=\"1\" position=\"" + test::text(Vec3{-3, 0, 0.251 + 0.501 * k}) + "\"");
    return out + component("fast", "State/RigidBody", "shape=\"q\" mass=\"1\" position=\"-9 0 3\" linear_velocity=\"0 0 40\"");
}

struct Asked
{
    const char* name;
    std::string scene;
    SwapOperation swap;
    std::size_t objects;  ///< that the swap acts on, directly or through others
    int before = 12;      ///< steps before the swap
};

std::string spring(const std::string& a, const std::string& b)
{
    return component("spring", "Constraint/SpringDamper", "a=\"" + a + "\" b=\"" + b + "\" length=\"0.5\" stiffness=\"40\" damping=\"1\"");
}

std::vector<Asked> cases()
{
    const SwapOperation gear{"gear", "Constraint/AngularVelocity/Impulse", {}};
    const SwapOperation stiff{"spring", "Constraint/SpringDamper", {{"stiffness", std::string("70")}}};
    const SwapOperation stiffer{"spring3", "Constraint/SpringDamper", {{"stiffness", std::string("700")}}};
    const std::string piles = stacks(5, 4, "None", "Rows");
    return {
        {"gear beside piles", kGears + piles, gear, 2},
        {"response of the piles, beside gears", kGears + piles, {"contact.response", "Response/Impulse", {}}, 20},
        {"response of the piles that becomes a spring", kGears + piles, {"contact.response", "Response/Penalty", {}}, 20},
        {"response of the piles that becomes a sensor", kGears + piles, {"contact.response", "Response/None", {}}, 20},
        {"spring between two of the piles", piles + spring("b1.1", "b2.2"), stiff, 6},
        {"spring between piles, contacts are springs", stacks(5, 4, "None", "Penalty") + spring("b1.1", "b2.2"), stiff, 6},
        {"spring between piles, impacts are located", stacks(5, 4, "LocalRoot", "Rows") + spring("b1.1", "b2.2"), stiff, 6},
        {"spring between piles, gaps may close", stacks(5, 4, "Speculative", "Rows") + spring("b1.1", "b2.2"), stiff, 6},
        {"spring between piles that are too large to locate their impacts", stacks_and_a_tall_one(5, 4) + spring("b1.1", "b2.2"), stiff, 6},
        {"the same as boxes land", stacks_and_a_tall_one(5, 4) + spring("b1.1", "b2.2"), stiff, 8, 29},
        {"body in a pile", kGears + piles, {"b1.1", "State/Kinematic", {}}, 3},
        {"shaft of the gears", kGears + piles, {"s0", "State/Shaft", {{"inertia", std::string("3")}}}, 2},
        {"field on all bodies", kGears + piles, {"gravity", "Field/Gravity", {{"acceleration", std::string("0 0 -8")}}}, 20},
        {"one of many springs, adaptive solver", springs("Solver/DormandPrince54"), stiffer, 2},
        {"one of many springs, implicit solver", springs("Solver/Radau5"), stiffer, 2},
        {"one of many springs, chosen solver", springs("Solver/Automatic"), stiffer, 2},
        {"solver of the gears", kGears + piles, {"own", "Solver/DormandPrince54", {}}, 2},
    };
}

Reply ask(Scene& s, std::vector<Operation> operations, bool everything = false)
{
    Request request;
    request.operations = std::move(operations), request.trial.everything = everything;
    return s.simulation().carry_out_now(request);
}

/// N s, of some bodies in the order of ids.
Vec3 momentum_of(const Scene& s, const std::vector<std::string>& ids)
{
    Vec3 sum;
    const world::World& world = s.simulation().world();
    for (const std::string& id : ids)
    {
        const std::uint32_t b = world.component(world.find(id)).host_index;
        sum += world.host().bodies.velocity[b] * world.host().bodies.mass[b];
    }
    return sum;
}

std::string difference(const Snapshot& a, const Snapshot& b)
{
    Comparison all;
    all.outputs = all.ledger = true;
    const auto found = compare(a, b, all);
    return found ? found->text() : std::string();
}

}  // namespace

TEST_CASE("the trial of the islands that a swap touches gives the figures of a trial of the whole scene")
{
    for (const Asked& c : cases())
    {
        CAPTURE(c.name);
        Scene part(c.scene, "dt='1/120'"), whole(c.scene, "dt='1/120'");
        REQUIRE_MESSAGE(part.loaded(), part.error());
        part.step(c.before), whole.step(c.before);
        const Reply of_part = ask(part, {c.swap}), of_whole = ask(whole, {c.swap}, true);
        REQUIRE_MESSAGE(of_part.done, first_error(of_part.errors));
        REQUIRE_MESSAGE(of_whole.done, first_error(of_whole.errors));
        CHECK(of_part.trial.objects == c.objects);
        CHECK(!of_part.trial.everything);
        CHECK(of_whole.trial.everything);
        const SwapReport &p = of_part.swaps[0], &w = of_whole.swaps[0];
        // What the swap changes is the same. The whole scene has more energy, of which its sums are rounded.
        const double scale = std::fmax(1.0, std::fabs(w.with_old.energy)) + std::fabs(w.energy_before);
        CHECK(std::fabs((p.with_new.energy - p.with_old.energy) - (w.with_new.energy - w.with_old.energy)) <= 1e-13 * scale);
        const Vec3 jump = (p.with_new.momentum - p.with_old.momentum) - (w.with_new.momentum - w.with_old.momentum);
        CHECK(length(jump) <= 1e-13 * std::fmax(1.0, length(w.with_old.momentum)));
        CHECK(p.with_new.error == w.with_new.error);
        CHECK(p.with_old.error == w.with_old.error);
        // Neither of them has left a trace.
        CHECK(difference(part.simulation().capture(), whole.simulation().capture()) == "");
        part.step(5), whole.step(5);
        CHECK(part.hash() == whole.hash());
    }
}

TEST_CASE("the trial's momentum is, to the last bit, that of these bodies after the next step of the whole scene")
{
    for (const Asked& c : cases())
    {
        if (c.swap.id.rfind("spring", 0) != 0) continue;
        CAPTURE(c.name);
        std::vector<std::string> ids = {"x3", "y3"};
        if (c.swap.id == "spring")
        {
            ids.clear();  // the stacks that the spring joins, without the boxes that fall
            for (const char* stack : {"b1.", "b2."})
                for (std::size_t k = 0; k < c.objects / 2; ++k) ids.push_back(stack + std::to_string(k));
        }
        Scene s(c.scene, "dt='1/120'");
        s.step(c.before);
        const Reply reply = ask(s, {c.swap});
        REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
        s.step();
        const Vec3 after = momentum_of(s, ids), tried = reply.swaps[0].with_new.momentum;
        CHECK(after.x == tried.x);
        CHECK(after.y == tried.y);
        CHECK(after.z == tried.z);
    }
}

TEST_CASE("a refused swap leaves every bit of the scene as it was: of the islands that it touches, of all others, and of the ledger")
{
    for (const Asked& c : cases())
    {
        CAPTURE(c.name);
        Scene s(c.scene, "dt='1/120'"), without(c.scene, "dt='1/120'");
        s.step(c.before), without.step(c.before);
        const Snapshot before = s.simulation().capture();
        const auto check = [&](std::vector<Operation> operations, const char* what)
        {
            CAPTURE(what);
            const Reply reply = ask(s, std::move(operations));
            CHECK(!reply.done);
            const Snapshot after = s.simulation().capture();
            CHECK(difference(before, after) == "");
            CHECK(*encode(before) == *encode(after));
        };
        check({c.swap, SetOperation{"nobody", "x", std::string("1")}}, "the second operation fails");
        for (const char* object : {"b1.1", "x1", "s1"})
            if (const std::uint32_t i = s.simulation().world().find(object); i != kNoIndex)
                check(
                    {PushOperation{object, {0.5, 0, 0}, {}},
                     SetOperation{object, s.simulation().world().component(i).facet == Facet::Shaft ? "inertia" : "mass", std::string("3")},
                     c.swap, SetOperation{"nobody", "x", std::string("1")}},
                    "a push and a set before it");
        SwapOperation back = c.swap;
        back.type = s.simulation().world().type_of(s.simulation().world().find(c.swap.id))->info.name;
        check({c.swap, back, SetOperation{"nobody", "x", std::string("1")}}, "there and back, then a failure");
        // An addition and a removal make a full backup in the middle of the request.
        const auto fragment = test::compile_text(test::whole_scene(component("late", "Shape/Sphere", "radius=\"0.1\"")), "request.xml",
                                                 &s.simulation().world().scene());
        REQUIRE(fragment.ok());
        check({c.swap, AddOperation{*fragment}, SetOperation{"late", "radius", std::string("0.2")}, RemoveOperation{"late"},
               SetOperation{"nobody", "x", std::string("1")}},
              "an addition and a removal after the swap");
        s.step(5), without.step(5);
        CHECK(s.hash() == without.hash());
    }
}

TEST_CASE("what lies beside a swap keeps every bit through swaps with trials, also where gaps may close")
{
    for (const char* resolution : {"None", "Speculative", "Automatic", "LocalRoot"})
    {
        CAPTURE(resolution);
        // Located impacts need no crowd.
        const int count = std::string(resolution) == "LocalRoot" ? 3 : 12, high = std::string(resolution) == "LocalRoot" ? 3 : 4;
        const std::string scene = kGears + (std::string(resolution) == "Automatic" ? stacks_and_a_tall_one(count, high)
                                                                                   : stacks(count, high, resolution, "Rows"));
        Scene with(scene, "dt='1/60'"), without(scene, "dt='1/60'");
        REQUIRE_MESSAGE(with.loaded(), with.error());
        const auto piles = [](Scene& s)
        {
            ByteWriter out;
            const world::World& world = s.simulation().world();
            for (const std::uint32_t i : world.in_id_order())
                if (world.component(i).facet == Facet::Body) world.save_state(i, out);
            for (const PairState& p : s.simulation().stepper().contacts().pairs())
                for (const KnownContact& k : p.all()) write(out, k.impulse), write(out, k.id);
            return out.bytes();
        };
        bool gaps = false;  // that may close were known at a swap
        const char* const gears[] = {"Constraint/AngularVelocity/Impulse", "Constraint/AngularVelocity/Graph"};
        const char* const solvers[] = {"Solver/DormandPrince54", "Solver/RungeKutta4"};
        for (int i = 0; i < 24; ++i)
        {
            with.step(), without.step();
            for (const PairState& p : without.simulation().stepper().contacts().pairs()) gaps = gaps || p.ahead;
            REQUIRE(piles(with) == piles(without));
            const Reply reply = with.ask_all({SwapOperation{"gear", gears[i % 2], {}}, SwapOperation{"own", solvers[i % 2], {}}});
            REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
            CHECK(reply.trial.objects == 2);
            CHECK(piles(with) == piles(without));
        }
        CHECK(gaps == (std::string(resolution) == "Speculative" || std::string(resolution) == "Automatic"));
        CHECK(with.simulation().stepper().contacts().pairs().size() >= static_cast<unsigned>(count * (high - 1)));
    }
}
