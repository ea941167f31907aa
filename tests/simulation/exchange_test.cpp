// Requests between steps: what they change, what they leave unchanged, and that a failed one has no effect.
#include "support/scene.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::first_error;
using plab::test::near;
using plab::test::Scene;

namespace
{

constexpr const char* kPaper = "scenes/fan_and_balloons.xml";

SwapOperation swap(const std::string& id, const std::string& type, std::vector<NamedValue> values = {})
{
    return {id, type, std::move(values)};
}

model::SceneSpec fragment(Scene& s, const std::string& body)
{
    const auto scene = test::compile_text(test::whole_scene(body), "request.xml", &s.simulation().world().scene());
    REQUIRE_MESSAGE(scene.ok(), test::reasons(scene));
    return *scene;
}

FieldTransfer transfer_of(const SwapReport& report, const std::string& field)
{
    for (const TransferredField& f : report.fields)
        if (f.field == field) return f.transfer;
    FAIL("nothing reported about ", field);
    return FieldTransfer::Lost;
}

}  // namespace

TEST_CASE("exchanging anything for itself changes no bit, now or later")
{
    Scene alone = Scene::file(kPaper), swapped = Scene::file(kPaper);
    REQUIRE_MESSAGE(alone.loaded(), alone.error());
    alone.run(1), swapped.run(1);
    for (const std::uint32_t i : std::vector<std::uint32_t>(swapped.simulation().world().in_id_order()))
    {
        if (!swapped.simulation().world().type_of(i)) continue;
        const std::string id = swapped.simulation().world().id_of(i), type = swapped.simulation().world().type_of(i)->info.name;
        const Reply reply = swapped.ask(swap(id, type));
        CHECK_MESSAGE(reply.done, id, ": ", first_error(reply.errors));
        CHECK_MESSAGE(swapped.hash() == alone.hash(), id);
    }
    alone.run(6), swapped.run(6);
    CHECK(swapped.hash() == alone.hash());
}

TEST_CASE("a swap reports the fields that were kept, given, fresh and lost, and the cost of the first step")
{
    Scene s = Scene::file(kPaper);
    s.run(1);
    const Reply reply = s.ask(swap("contact.resolution", "Resolution/LocalBisection"));
    REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
    REQUIRE(reply.swaps.size() == 1);
    CHECK(reply.swaps[0].from == "Resolution/Bisection");
    CHECK(reply.step == s.simulation().tick());
    CHECK(reply.pause_ns > 0);
    CHECK(reply.swaps[0].with_new.energy == doctest::Approx(reply.swaps[0].with_old.energy).epsilon(1e-12));

    const Reply none = s.ask(swap("contact.response", "Response/None"));
    REQUIRE(none.done);
    CHECK(transfer_of(none.swaps[0], "restitution") == FieldTransfer::Lost);
    const Reply back = s.ask(swap("contact.response", "Response/Impulse", {{"restitution", std::string("0.25")}}));
    REQUIRE(back.done);
    CHECK(transfer_of(back.swaps[0], "restitution") == FieldTransfer::Given);
    CHECK(transfer_of(back.swaps[0], "friction") == FieldTransfer::Fresh);
    CHECK(s.real("contact.response", "restitution") == 0.25);
}

TEST_CASE("without the impulse response the red balloon goes through the green one")
{
    Scene s = Scene::file(kPaper);
    const Vec3 green = s.vec("green", "position");
    REQUIRE(s.ask(swap("contact.response", "Response/None")).done);
    s.keep_events = true;
    s.run(10);
    CHECK(s.count("contact.begin") == 1);
    CHECK(s.count("contact.impact") == 0);
    CHECK(s.vec("green", "position") == green);
    CHECK(s.vec("red", "position").x > green.x + 0.3);
}

TEST_CASE("gears are exchanged while they turn")
{
    Scene s = Scene::file(kPaper);
    s.run(1);
    const double before = s.spin("fan");
    REQUIRE(s.ask(swap("gears", "Constraint/AngularVelocity/Impulse")).done);
    CHECK(s.spin("fan") == before);
    s.run(2);
    CHECK(near(s.spin("large_gear"), -0.5 * s.spin("small_gear"), 1e-12));
    REQUIRE(s.ask(swap("gears", "Constraint/AngularVelocity/Assign")).done);
    s.run(3);
    CHECK(near(s.spin("large_gear"), -0.5 * s.spin("small_gear"), 1e-12));
    const Reply back = s.ask(swap("gears", "Constraint/AngularVelocity/Graph", {{"velocity_factor", std::string("-0.25")}}));
    REQUIRE_MESSAGE(back.done, first_error(back.errors));
    s.step();
    CHECK(near(s.spin("large_gear"), -0.25 * s.spin("small_gear"), 1e-15));
}

TEST_CASE("a refused request leaves everything as it was, bit for bit")
{
    Scene s = Scene::file(kPaper), alone = Scene::file(kPaper);
    s.run(1), alone.run(1);
    const auto refused = [&](std::vector<Operation> ops, const std::string& why)
    {
        const Reply reply = s.ask_all(std::move(ops));
        CHECK(!reply.done);
        CHECK_MESSAGE(first_error(reply.errors).find(why) != std::string::npos, first_error(reply.errors));
        CHECK(s.hash() == alone.hash());
    };
    refused({swap("nobody", "Response/None")}, "no component has the id 'nobody'");
    refused({swap("contact.respons", "Response/None")}, "contact.response");
    refused({swap("contact.response", "Response/Nope")}, "Response/None");
    refused({swap("contact.response", "Resolution/Bisection")}, "cannot be exchanged");
    refused({swap("contact.response", "Response/Impulse", {{"restitution", std::string("2")}})}, "restitution");
    refused({swap("contact.response", "Response/Impulse", {{"bounce", std::string("1")}})}, "has no parameter 'bounce'");
    refused({SetOperation{"red", "mass", std::string("-1")}}, "mass");
    refused({SetOperation{"red", "mas", std::string("1")}}, "mass");
    refused({SetOperation{"wind", "code", std::string("function force(t) oops")}}, "line");
    refused({SetOperation{"wind", "code", std::string("function force(t, s) error('at once') end")}}, "first step failed");
    refused({RemoveOperation{"red"}}, "is still used by");
    // The first operation of a transaction is taken back when the second fails.
    refused({SetOperation{"red", "mass", std::string("5")}, swap("gears", "Response/None")}, "cannot be exchanged");
    refused({AddOperation{fragment(s,
                                   "<component id=\"clash\" type=\"Constraint/AngularVelocity/Graph\" driver=\"axle\" "
                                   "driven=\"large_gear\" velocity_factor=\"3\"/>")}},
            "clash");
    s.run(6), alone.run(6);
    CHECK(s.hash() == alone.hash());
    CHECK(s.simulation().revision() == 0);
}

TEST_CASE("set changes the named fields and nothing else; also entries")
{
    Scene s = Scene::file(kPaper);
    s.run(0.5);
    const Vec3 v = s.vec("red", "linear_velocity");
    CHECK(!s.ask(SetOperation{"red", "position", std::string("1.5 0.3 1 kg")}).done);
    REQUIRE(s.ask(SetOperation{"red", "position", std::string("150 30 100 cm")}).done);
    CHECK(test::distance(s.vec("red", "position"), {1.5, 0.3, 1}) < 1e-15);
    CHECK(s.vec("red", "linear_velocity") == v);
    REQUIRE(s.ask(SetOperation{"wind", "parameters.strength", std::string("0")}).done);
    s.run(1);
    CHECK(s.vec("red", "linear_velocity") == v);
    const double spin = s.spin("axle");
    REQUIRE(s.ask(SetOperation{"fan", "inertia", std::string("0.05")}).done);
    CHECK(s.spin("axle") == spin);
}

TEST_CASE("push, add, remove")
{
    Scene s = Scene::file(kPaper);
    const Vec3 before = s.simulation().totals().momentum;
    REQUIRE(s.ask(PushOperation{"green", {0, 0, 0.01}, {}}).done);
    CHECK(test::distance(s.simulation().totals().momentum - before, {0, 0, 0.01}) < 1e-16);
    CHECK(near(s.vec("green", "linear_velocity").z, 0.5, 1e-15));
    CHECK(!s.ask(PushOperation{"motor", {1, 0, 0}, {}}).done);

    REQUIRE(s.ask(AddOperation{fragment(s, "<component id=\"drag\" type=\"Field/Drag\" between=\"*\" linear=\"0.05\"/>")}).done);
    CHECK(s.simulation().revision() == 1);
    s.run(1);
    CHECK(s.vec("green", "linear_velocity").z == doctest::Approx(0.5 * std::exp(-0.05 / 0.02)).epsilon(1e-8));
    REQUIRE(s.ask(RemoveOperation{"drag"}).done);
    const double vz = s.vec("green", "linear_velocity").z;
    s.run(1.5);
    CHECK(s.vec("green", "linear_velocity").z == vz);
    // An added component joins roles that mean everyone.
    REQUIRE(s.ask(AddOperation{fragment(s, "<component id=\"g\" type=\"Field/Gravity\" between=\"*\"/>")}).done);
    REQUIRE(s.ask(AddOperation{
                      fragment(s, "<component id=\"third\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\" position=\"0 5 9\"/>")})
                .done);
    s.run(2);
    CHECK(near(s.vec("third", "linear_velocity").z, -9.81 * 0.5, 1e-12));
}

TEST_CASE("what is added later takes part where a pattern matches its id, and may be removed")
{
    const std::string body = " type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\"/>";
    Scene s("<component id=\"a\"" + body + "<component id=\"b1\"" + body + "<component id=\"g\" type=\"Field/Gravity\" between=\"b* a\"/>");
    REQUIRE(s.ask(AddOperation{fragment(s, "<component id=\"b2\"" + body)}).done);
    REQUIRE(s.ask(AddOperation{fragment(s, "<component id=\"c\"" + body)}).done);
    s.run(0.5);
    for (const char* falls : {"a", "b1", "b2"}) CHECK(near(s.vec(falls, "linear_velocity").z, -9.81 * 0.5, 1e-12));
    CHECK(s.vec("c", "linear_velocity").z == 0);
    CHECK(s.ask(RemoveOperation{"b2"}).done);
    CHECK(!s.ask(RemoveOperation{"a"}).done);  // it is named
    s.run(1);
    CHECK(near(s.vec("b1", "linear_velocity").z, -9.81, 1e-12));
}

TEST_CASE("requests for a step: in time, late, and by revision")
{
    Scene s = Scene::file(kPaper);
    Request at;
    at.id = 7, at.at = 10, at.operations = {swap("contact.response", "Response/None")};
    s.simulation().post(at);
    s.step(10);
    CHECK(s.simulation().take_replies().empty());
    s.step();
    auto replies = s.simulation().take_replies();
    REQUIRE(replies.size() == 1);
    CHECK(replies[0].done);
    CHECK(replies[0].step == 10);
    CHECK(replies[0].request == 7);
    s.simulation().post(at);
    s.step();
    replies = s.simulation().take_replies();
    REQUIRE(replies.size() == 1);
    CHECK(replies[0].late);
    Request old;
    old.revision = 0, old.operations = {swap("contact.response", "Response/Impulse")};
    s.simulation().post(old);
    s.step();
    replies = s.simulation().take_replies();
    REQUIRE(replies.size() == 1);
    CHECK(!replies[0].done);
}

TEST_CASE("pause, step, resume, reset")
{
    Scene s = Scene::file(kPaper);
    const std::uint64_t start = s.hash();
    s.run(1);
    const std::uint64_t first_run = s.simulation().run();
    const Tick at = s.simulation().tick();
    REQUIRE(s.ask(PauseOperation{}).done);
    CHECK(!s.simulation().step());
    CHECK(s.simulation().tick() == at);
    REQUIRE(s.ask(StepOperation{3}).done);
    int made = 0;
    while (made < 10 && s.simulation().step()) ++made;
    CHECK(made == 3);
    REQUIRE(s.ask(ResumeOperation{}).done);
    CHECK(s.simulation().step());
    REQUIRE(s.ask(ResetOperation{}).done);
    CHECK(s.simulation().tick() == 0);
    CHECK(s.hash() == start);
    CHECK(s.simulation().run() == first_run + 1);
}

TEST_CASE("a change of the step length keeps the simulated time")
{
    Scene s("", "dt=\"1/10\"");
    s.step(10);
    REQUIRE(s.ask(StepLengthOperation{model::StepLength{0.01, 1, 100}}).done);
    s.step(25);
    CHECK(s.simulation().time() == 1.25);
}

TEST_CASE("the response of a resting contact is swapped: the box is neither thrown up nor does it sink")
{
    Scene s(
        "<component id=\"ground\" type=\"State/Static\" shape=\"floor\"/><component id=\"floor\" type=\"Shape/Plane\"/>"
        "<component id=\"cube\" type=\"Shape/Box\" half_extents=\"0.5 0.5 0.5\"/>"
        "<component id=\"box\" type=\"State/RigidBody\" mass=\"1\" shape=\"cube\" position=\"0 0 0.5\"/>"
        "<component id=\"g\" type=\"Field/Gravity\" between=\"box\"/>"
        "<component id=\"contact\" type=\"CDetection/ODE\" between=\"box ground\" resolution=\"Resolution/LocalBisection\" "
        "response=\"Response/Impulse\"/>",
        "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    REQUIRE(s.ask(swap("contact.response", "Response/Impulse", {{"friction", std::string("0.3")}})).done);
    REQUIRE(s.ask(swap("contact.resolution", "Resolution/Bisection")).done);
    REQUIRE(s.ask(swap("contact", "CDetection/ODE", {{"space", std::string("sweep_and_prune")}})).done);
    double most = 0;
    for (int i = 0; i < 60; ++i)
    {
        s.step();
        most = std::max(most, length(s.vec("box", "linear_velocity")));
    }
    CHECK(most < 1e-12);
    CHECK(std::fabs(s.vec("box", "position").z - 0.5) < 1e-9);
}
