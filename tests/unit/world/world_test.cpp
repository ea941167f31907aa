// Rows, facets, backup and hash of a world; no step is made.
#include "support/scene.h"

using namespace plab;
using plab::test::distance;
using plab::test::Scene;

namespace
{

struct Things
{
    Column<double> number;
    Column<std::string> text;
    Column<Entries> record;
    Column<std::unique_ptr<int>> opaque;

    void describe(Schema& s)
    {
        s.param(number, "number", unit::metre, "a number").or_else(3);
        s.state(text, "text", unit::one, "a text").initially("hello");
        s.state(record, "record", unit::one, "a record");
        s.scratch(opaque, "opaque", "an object");
    }
};

}  // namespace

TEST_CASE("rows keep their indices, freed ones are used again with defaults")
{
    Registrar registrar;
    registrar.component<Things>("Thing/Plain", "a thing");
    model::TypeRegistry types;
    REQUIRE(types.add(std::move(registrar), "test").ok());
    world::Table table(*types.find("Thing/Plain"));
    const Row a = table.add(10, kNoIndex), b = table.add(11, kNoIndex);
    auto& rows = *static_cast<Things*>(table.rows());
    rows.number[a] = 7, rows.text[a] = "bye", rows.opaque[a] = std::make_unique<int>(5);
    table.remove(a);
    CHECK(rows.opaque[a] == nullptr);
    const Row c = table.add(12, kNoIndex);
    CHECK(c == a);
    CHECK(rows.number[c] == 3);
    CHECK(rows.text[c] == "hello");
    CHECK(table.component_of_row()[b] == 11);
    CHECK(table.component_of_row()[c] == 12);
}

TEST_CASE("a row's fields are written to bytes and read back")
{
    Registrar registrar;
    registrar.component<Things>("Thing/Plain", "a thing");
    model::TypeRegistry types;
    REQUIRE(types.add(std::move(registrar), "test").ok());
    world::Table table(*types.find("Thing/Plain"));
    const Row a = table.add(0, kNoIndex);
    auto& rows = *static_cast<Things*>(table.rows());
    rows.number[a] = -0.0, rows.text[a] = "x", rows.record[a] = {{"n", 1.5}, {"on", true}, {"who", std::string("me")}};
    const Entries record = rows.record[a];
    ByteWriter out;
    table.save(a, world::kLiveKinds, out);
    rows.number[a] = 1, rows.text[a] = "other", rows.record[a].clear();
    ByteReader in(out.bytes());
    table.load(a, world::kLiveKinds, in);
    CHECK(in.at_end());
    CHECK(std::signbit(rows.number[a]));
    CHECK(rows.text[a] == "x");
    CHECK(rows.record[a] == record);
}

TEST_CASE("position and velocity are those of the author's frame")
{
    Scene s(
        "<component id=\"b\" type=\"State/RigidBody\" mass=\"2\" inertia=\"1 1 1\" center_of_mass=\"0.5 0 0\" position=\"1 2 3\" "
        "orientation=\"axis 0 0 1 90 deg\" linear_velocity=\"1 0 0\" angular_velocity=\"0 0 2\"/>");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    CHECK(distance(s.vec("b", "position"), {1, 2, 3}) < 1e-15);
    CHECK(distance(s.vec("b", "linear_velocity"), {1, 0, 0}) < 1e-15);
    const Bodies& bodies = s.simulation().world().host().bodies;
    // C is at B + (0, 0.5, 0) in W, and moves with v + w x r = (1 - 1, 0, 0).
    CHECK(distance(bodies.position[0], {1, 2.5, 3}) < 1e-15);
    CHECK(distance(bodies.velocity[0], {0, 0, 0}) < 1e-15);
    s.run(1);
    // C does not move; B circles it.
    CHECK(distance(s.vec("b", "position"), Vec3{1, 2.5, 3} - rotate(s.quat("b", "orientation"), Vec3{0.5, 0, 0})) < 1e-12);
    REQUIRE(s.ask(simulation::SetOperation{"b", "position", std::string("0 0 0")}).done);
    CHECK(distance(s.vec("b", "position"), {}) < 1e-15);
}

TEST_CASE("a backup restores values and structure")
{
    Scene s(
        "<component id=\"a\" type=\"State/Shaft\" inertia=\"1\" angular_velocity=\"2\"/><component id=\"b\" type=\"State/Shaft\" "
        "inertia=\"1\"/>"
        "<component id=\"g\" type=\"Constraint/AngularVelocity/Graph\" driver=\"a\" driven=\"b\" velocity_factor=\"2\"/>");
    world::World& world = s.simulation().world();
    const std::uint64_t hash = world.state_hash(0);
    const world::Backup backup = world.backup();
    world.host().shafts.angle[0] = 5;
    world.remove(world.find("g"));
    CHECK(world.state_hash(0) != hash);
    CHECK(world.find("g") == kNoIndex);
    world.restore(backup);
    CHECK(world.state_hash(0) == hash);
    REQUIRE(world.find("g") != kNoIndex);
    CHECK(world.referrers(world.find("a")).size() == 1);
    CHECK(std::get<double>(world.get(world.find("g"), "velocity_factor")) == 2);
}
