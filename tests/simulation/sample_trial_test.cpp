// A swap that acts on more objects than its trial may have is tried on a sample of them: whole islands, spread evenly; of an island that is
// larger than its share, a part whose neighbours are held still.
#include <cmath>

#include "simulation/requests/request_words.h"
#include "simulation/snapshot/compare.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::first_error;
using plab::test::Scene;

namespace
{

/// Tries the swap on at most so many objects; 0: on all that it acts on.
Reply ask(Scene& s, const SwapOperation& swap, std::size_t most)
{
    Request request;
    request.operations = {swap}, request.trial.most = most;
    return s.simulation().carry_out_now(request);
}

std::string component(const std::string& id, const std::string& type, const std::string& more)
{
    return "<component id=\"" + id + "\" type=\"" + type + "\" " + more + "/>\n";
}

/// Columns of `high` boxes each on a plane. At a distance of 0.5 m they touch and are one island.
std::string columns(int count, int high, double distance)
{
    std::string out = component("gravity", "Field/Gravity", "between=\"*\"") +
                      component("q", "Shape/Box", "half_extents=\"0.25 0.25 0.25\"") + component("plane", "Shape/Plane", "") +
                      component("ground", "State/Static", "shape=\"plane\"") +
                      component("contact", "CDetection/ODE",
                                "between=\"*\" resolution=\"Resolution/None\" response=\"Response/Rows\" response.friction=\"0.6\"");
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < high; ++k)
            out += component("b" + std::to_string(i) + "." + std::to_string(k), "State/RigidBody",
                             "shape=\"q\" mass=\"1\" position=\"" + test::text(Vec3{distance * i, 0, 0.25 + 0.5 * k}) + "\"");
    return out;
}

/// Trains of `length` shafts each, all of them turning.
std::string trains(int count, int length)
{
    std::string out;
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < length; ++k)
        {
            const std::string n = std::to_string(i) + "." + std::to_string(k);
            out += component("s" + n, "State/Shaft", "inertia=\"1\" angular_velocity=\"" + std::to_string(k % 2 == 0 ? 1 : -1) + "\"");
            if (k == 0) continue;
            const std::string before = "s" + std::to_string(i) + "." + std::to_string(k - 1);
            out += component("gear" + n, "Constraint/AngularVelocity/Graph",
                             "driver=\"" + before + "\" driven=\"s" + n + "\" velocity_factor=\"-1\"");
        }
    return out;
}

const SwapOperation kResponse{"contact.response", "Response/Impulse", {}};
const SwapOperation kGears{"gear*", "Constraint/AngularVelocity/Impulse", {}};

std::string difference(const Snapshot& a, const Snapshot& b)
{
    Comparison all;
    all.outputs = all.ledger = true;
    const auto found = compare(a, b, all);
    return found ? found->text() : std::string();
}

}  // namespace

TEST_CASE("islands are tried as a whole, and their figures are those that they have in a trial of everything")
{
    const std::string scene = columns(40, 3, 2.0);
    Scene some(scene, "dt='1/120'"), all(scene, "dt='1/120'");
    REQUIRE_MESSAGE(some.loaded(), some.error());
    some.step(10), all.step(10);
    const Reply of_some = ask(some, kResponse, 24), of_all = ask(all, kResponse, 0);
    REQUIRE_MESSAGE(of_some.done, first_error(of_some.errors));
    REQUIRE_MESSAGE(of_all.done, first_error(of_all.errors));
    CHECK(of_some.trial.outcome == TrialReport::Outcome::Made);
    CHECK(of_some.trial.objects == 24);
    CHECK(of_some.trial.sample_of == 120);
    CHECK(!of_some.trial.held);
    CHECK(of_all.trial.objects == 120);
    CHECK(of_all.trial.sample_of == 0);
    CHECK(text_of(of_some.trial).find("made: a sample of 24 of 120 objects, ") == 0);
    // All columns are alike.
    const SwapReport &s = of_some.swaps[0], &a = of_all.swaps[0];
    CHECK(5 * s.energy_before == doctest::Approx(a.energy_before).epsilon(1e-9));
    CHECK(5 * s.with_old.energy == doctest::Approx(a.with_old.energy).epsilon(1e-9));
    CHECK(5 * s.with_new.energy == doctest::Approx(a.with_new.energy).epsilon(1e-9));
    CHECK(s.with_new.error == doctest::Approx(a.with_new.error).epsilon(1e-6));
    // The trial has left no trace, and the swap acts on all of them.
    CHECK(difference(some.simulation().capture(), all.simulation().capture()) == "");
    some.step(5), all.step(5);
    CHECK(some.hash() == all.hash());
}

TEST_CASE("of an island that is too large parts are tried, and the reply says that what touches them was held still")
{
    const std::string scene = columns(60, 3, 0.5);
    Scene some(scene, "dt='1/120'"), all(scene, "dt='1/120'");
    REQUIRE_MESSAGE(some.loaded(), some.error());
    some.step(10), all.step(10);
    const Reply of_some = ask(some, kResponse, 48), of_all = ask(all, kResponse, 0);
    REQUIRE_MESSAGE(of_some.done, first_error(of_some.errors));
    CHECK(of_some.trial.objects >= 48);
    CHECK(of_some.trial.objects < 100);
    CHECK(of_some.trial.sample_of == 180);
    CHECK(of_some.trial.held);
    CHECK(text_of(of_some.trial).find(" with what touches them held still") != std::string::npos);
    CHECK(std::isfinite(of_some.swaps[0].with_old.energy));
    CHECK(std::isfinite(of_some.swaps[0].with_new.energy));
    CHECK(difference(some.simulation().capture(), all.simulation().capture()) == "");
    some.step(5), all.step(5);
    CHECK(some.hash() == all.hash());
    // A change of one body in it reaches the whole island, too.
    const Reply one = ask(some, {"b30.1", "State/RigidBody", {{"mass", std::string("2")}}}, 48);
    REQUIRE_MESSAGE(one.done, first_error(one.errors));
    CHECK(one.trial.sample_of == 1);
    CHECK(one.trial.objects >= 48);
    CHECK(one.trial.objects < 100);
    CHECK(one.trial.held);
}

TEST_CASE("what is coupled is tried together, even where that is more than was asked for")
{
    Scene s(trains(30, 3)), one(trains(1, 60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    REQUIRE_MESSAGE(one.loaded(), one.error());
    s.step(3), one.step(3);
    const Reply many = ask(s, kGears, 10);
    REQUIRE_MESSAGE(many.done, first_error(many.errors));
    CHECK(many.swaps.size() == 60);
    CHECK(many.trial.objects == 12);
    CHECK(many.trial.sample_of == 90);
    CHECK(!many.trial.held);
    const double w = 1;  // rad/s, of each shaft
    CHECK(many.swaps[0].with_old.energy == doctest::Approx(12 * 0.5 * w * w).epsilon(1e-9));
    CHECK(many.swaps[0].with_new.energy == doctest::Approx(12 * 0.5 * w * w).epsilon(1e-9));
    // A part of one train would be no train.
    const Reply long_one = ask(one, kGears, 10);
    REQUIRE_MESSAGE(long_one.done, first_error(long_one.errors));
    CHECK(long_one.trial.objects == 60);
    CHECK(long_one.trial.sample_of == 0);
}

TEST_CASE("a swap whose sample creates energy is refused before it takes effect, and leaves every bit")
{
    std::string scene;
    const auto pushing = [](const std::string& newtons)
    { return "function force(t, state) driven:add_force(vec(" + newtons + ", 0, 0)) end"; };
    for (int i = 0; i < 100; ++i)
    {
        const std::string n = std::to_string(i), body = "mass=\"1\" inertia=\"1 1 1\" linear_velocity=\"0 3 0\" position=\"" + n + " 0 0\"";
        scene += component("a" + n, "State/RigidBody", body) + "<component id=\"s" + n + "\" type=\"Script/Lua\" driven=\"a" + n +
                 "\"><param name=\"code\">" + pushing("1") + "</param></component>";
    }
    Scene s(scene);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(3);
    const Snapshot before = s.simulation().capture();
    const Reply no = ask(s, {"s*", "Script/Lua", {{"code", pushing("1e5")}}}, 16);
    CHECK(!no.done);
    CHECK_MESSAGE(first_error(no.errors).find("kinetic energy") != std::string::npos, first_error(no.errors));
    CHECK(difference(before, s.simulation().capture()) == "");
}
