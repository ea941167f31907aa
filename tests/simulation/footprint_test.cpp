// A scene uses only what it needs: libraries, phases, memory, time.
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>

#include <malloc.h>

#include "plab/random.h"
#include "support/allocation_counter.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using plab::test::allocations;
using plab::test::has;
using plab::test::quoted;
using plab::test::Scene;

namespace
{

/// Runs the real daemon on a scene and asks which libraries it has mapped when it is done stepping.
std::string mapped_libraries(const std::string& scene)
{
    const std::string file = std::string(PLAB_BINARY_DIR) + "/footprint_scene.xml";
    std::ofstream(file) << "<plab version=\"1\"><scene dt=\"1/100\"/>" << scene << "</plab>";
    const std::string command =
        quoted(std::string(PLAB_BINARY_DIR) + "/bin/plabd") + " " + quoted(file) + " --until 0.1 --no-bus --maps 2>&1";
    std::FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::string out;
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, n);
    CHECK_MESSAGE(pclose(pipe) == 0, out);
    return out;
}

/// Makes steps, none of which may allocate unless it emits an event, which has a text. Returns how many emitted none.
int quiet_steps(Scene& scene, int steps)
{
    int quiet = 0;
    for (int i = 0; i < steps; ++i)
    {
        const long before = allocations;
        scene.simulation().step();
        const long made = allocations - before;
        if (!scene.simulation().events().empty()) continue;
        ++quiet;
        REQUIRE(made == 0);
    }
    return quiet;
}

const char* const kShafts = R"(<component id="a" type="State/Shaft" inertia="1"/><component id="b" type="State/Shaft" inertia="1"/>
  <component id="g" type="Constraint/AngularVelocity/Graph" driver="a" driven="b" velocity_factor="-0.5"/>)";
const char* const kScript =
    R"(<component id="m" type="Script/Lua" driven="a"><param name="code">function force(t, state) driven:add_torque(1) end</param></component>)";
const char* const kBall = R"(<component id="s" type="Shape/Sphere" radius="0.1"/><component id="floor" type="Shape/Plane"/>
  <component id="ball" type="State/RigidBody" mass="1" shape="s" position="0 0 1"/><component id="ground" type="State/Static" shape="floor"/>
  <component id="gravity" type="Field/Gravity" between="ball"/>
  <component id="contact" type="CDetection/ODE" between="ball ground" resolution="Resolution/LocalBisection" response="Response/Impulse" response.restitution="1"/>)";

long allocations_of(Scene& s, int steps)
{
    s.step(500);
    const long before = allocations;
    for (int i = 0; i < steps; ++i) s.simulation().step();
    return allocations - before;
}

}  // namespace

TEST_CASE("without scripts no Lua, without collisions no ODE: only named libraries are mapped")
{
    const std::string shafts = mapped_libraries(kShafts), script = mapped_libraries(std::string(kShafts) + kScript),
                      ball = mapped_libraries(kBall);
    CHECK(!has(shafts, "liblua"));
    CHECK(!has(shafts, "libode"));
    CHECK(has(shafts, "constraints.so"));
    CHECK(!has(shafts, "shapes.so"));
    CHECK(has(script, "liblua"));
    CHECK(!has(script, "libode"));
    CHECK(has(ball, "libode"));
    CHECK(!has(ball, "liblua"));
    CHECK(!has(ball, "constraints.so"));
    for (const std::string* text : {&shafts, &script, &ball}) CHECK(!has(*text, "libddsc"));
}

TEST_CASE("a scene of shafts has no 3-D state, and runs no phase of collisions")
{
    Scene s(kShafts);
    CHECK(s.simulation().world().host().bodies.size() == 0);
    CHECK(!s.simulation().stepper().anything_collides());
    CHECK(!s.simulation().stepper().anything_drives());
}

TEST_CASE("a warm step allocates nothing")
{
    Scene shafts(std::string(kShafts) + kScript);
    CHECK(allocations_of(shafts, 1000) == 0);
    Scene free_body(
        "<component id=\"b\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 2 2.5\" angular_velocity=\"1 2 3\"/><component id=\"g\" "
        "type=\"Field/Gravity\" between=\"*\"/>");
    CHECK(allocations_of(free_body, 1000) == 0);
    // At rest: the contact persists, no event is made.
    Scene resting(
        "<component id=\"s\" type=\"Shape/Sphere\" radius=\"0.1\"/><component id=\"floor\" type=\"Shape/Plane\"/>"
        "<component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" shape=\"s\" position=\"0 0 0.1001\"/><component id=\"ground\" "
        "type=\"State/Static\" shape=\"floor\"/>"
        "<component id=\"gravity\" type=\"Field/Gravity\" between=\"ball\"/>"
        "<component id=\"contact\" type=\"CDetection/ODE\" between=\"ball ground\" resolution=\"Resolution/LocalBisection\" "
        "response=\"Response/Impulse\"/>");
    CHECK(allocations_of(resting, 1000) == 0);
}

TEST_CASE("a warm step of a sliding stack allocates nothing, with any manager")
{
    std::string body =
        "<component id=\"floor\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"floor\"/>"
        "<component id=\"cube\" type=\"Shape/Box\" half_extents=\"0.5 0.5 0.2\"/>";
    for (const char* id : {"0", "1", "2", "3"})
        body += "<component id=\"b" + std::string(id) + "\" type=\"State/RigidBody\" mass=\"1\" shape=\"cube\" position=\"0 0 " +
                std::to_string(0.2 + 0.4 * (id[0] - '0')) + "\"/>";
    body += "<component id=\"gravity\" type=\"Field/Gravity\" between=\"b0 b1 b2 b3\" acceleration=\"3 0 -9.81\"/>";
    for (const char* manager : {"Direct", "SequentialImpulse", "SoftStep"})
    {
        CAPTURE(manager);
        Scene s(body +
                "<component id=\"contact\" type=\"CDetection/ODE\" between=\"b0 b1 b2 b3 ground\" resolution=\"Resolution/None\" "
                "response=\"Response/Rows\" response.friction=\"0.25\" response.manager=\"Manager/" +
                manager + "\"/>");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(500);
        CHECK(quiet_steps(s, 500) > 400);
    }
}

TEST_CASE("a warm step of a stack that slides beside boxes whose impacts are located allocates nothing")
{
    std::string body =
        R"(<component id="floor" type="Shape/Plane"/><component id="ground" type="State/Static" shape="floor"/>
        <component id="cube" type="Shape/Box" half_extents="0.5 0.5 0.02"/>
        <component id="g" type="Field/Gravity" between="*" acceleration="3 0 -9.81"/>
        <component id="contact" type="CDetection/ODE" between="*" response.friction="0.25"/>)";
    for (int k = 0; k < 16; ++k)
        body += "<component id=\"b" + std::to_string(k) + "\" type=\"State/RigidBody\" mass=\"1\" shape=\"cube\" position=\"0 " +
                (k < 10 ? "0 " + std::to_string(0.02 + 0.04 * k) : std::to_string(2 * k) + " 0.02") + "\"/>";
    Scene s(body);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(500);
    CHECK(quiet_steps(s, 500) > 400);
    CHECK(std::get<std::string>(s.get("contact.resolution", "resolved")).starts_with("LocalRoot and "));
}

TEST_CASE("a warm step of many islands allocates nothing, with 1, 2 and 4 threads")
{
    std::string body =
        R"(<component id="floor" type="Shape/Plane"/><component id="ground" type="State/Static" shape="floor"/>
        <component id="cube" type="Shape/Box" half_extents="0.5 0.5 0.2"/><component id="g" type="Field/Gravity" between="*"/>
        <component id="manager" type="Manager/SoftStep" substeps="4"/>
        <component id="contact" type="CDetection/ODE" between="*" resolution="Resolution/None" response="Response/Rows"
                   response.manager="manager" response.friction="0.25"/>)";
    for (int i = 0; i < 60; ++i)
        for (int k = 0; k < 2 + i % 7; ++k)
            body += "<component id=\"b" + std::to_string(i) + "_" + std::to_string(k) +
                    "\" type=\"State/RigidBody\" mass=\"1\" shape=\"cube\" position=\"" + std::to_string(3 * i) + " 0 " +
                    std::to_string(0.2 + 0.4 * k) + "\" linear_velocity=\"0 " + std::to_string(i % 5) + " 0\"/>";
    for (const int threads : {1, 2, 4})
    {
        CAPTURE(threads);
        Scene s(body, "dt=\"1/60\"", threads);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(400);
        CHECK(quiet_steps(s, 120) > 80);
    }
}

TEST_CASE("an empty step costs less than a microsecond")
{
    Scene s("");
    s.step(1000);
    double best = 1e9;
    for (int round = 0; round < 20; ++round)
    {
        const auto before = std::chrono::steady_clock::now();
        for (int i = 0; i < 10000; ++i) s.simulation().step();
        best = std::min(best, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - before).count() / 10000);
    }
    MESSAGE("empty step: ", best, " ns");
    CHECK(best < 1000);
}

TEST_CASE("memory grows with the number of trains, not with its square")
{
    const auto most_kB = []
    {
        rusage use{};
        getrusage(RUSAGE_SELF, &use);
        return use.ru_maxrss;
    };
    std::string pairs;
    for (int i = 0; i < 2000; ++i)
    {
        const std::string n = std::to_string(i);
        pairs += "<component id=\"a" + n + "\" type=\"State/Shaft\" inertia=\"1\" angular_velocity=\"1\"/><component id=\"b" + n +
                 "\" type=\"State/Shaft\" inertia=\"1\"/><component id=\"g" + n +
                 "\" type=\"Constraint/AngularVelocity/Impulse\" driver=\"a" + n + "\" driven=\"b" + n + "\" velocity_factor=\"-2\"/>\n";
    }
    const long before = most_kB();
    Scene s(pairs);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(3);
    MESSAGE("2000 pairs of shafts: ", most_kB() - before, " kB");
    CHECK(most_kB() - before < 100'000);
}

TEST_CASE("ten thousand bodies load in seconds")
{
    const auto before = std::chrono::steady_clock::now();
    Scene s(
        "<component id=\"s\" type=\"Shape/Sphere\" radius=\"0.1\"/><repeat id=\"all\" count=\"100 100\" step=\"1 1 0\">"
        "<component id=\"b\" type=\"State/RigidBody\" mass=\"1\" shape=\"s\"/></repeat><component id=\"g\" type=\"Field/Gravity\" "
        "between=\"*\"/>");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(2);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    MESSAGE("10,000 bodies: ", seconds, " s");
    CHECK(seconds < 20);
    CHECK(s.simulation().world().host().bodies.size() == 10000);
}

TEST_CASE("a heap whose islands change in each step does not gather memory")
{
    std::string body = R"(<component id="s" type="Shape/Sphere" radius="0.11"/><component id="floor" type="Shape/Plane"/>
        <component id="ground" type="State/Static" shape="floor"/><component id="g" type="Field/Gravity" between="*"/>
        <component id="contact" type="CDetection/ODE" between="*" resolution="Resolution/None" response="Response/Rows"/>)";
    std::uint64_t seed = 9;
    for (int i = 0; i < 500; ++i)
    {
        const auto at = [&](int cell) { return std::to_string(0.23 * cell + 0.02 * next_uniform(seed)); };
        body += "<component id=\"b" + std::to_string(i) + "\" type=\"State/RigidBody\" mass=\"1\" shape=\"s\" position=\"" + at(i % 10) +
                " " + at(i / 10 % 10) + " " + at(1 + i / 100) + "\"/>";
    }
    Scene s(body, "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.6);
    const std::size_t before = mallinfo2().uordblks;
    s.run(1.8);
    const double grown = static_cast<double>(mallinfo2().uordblks) - static_cast<double>(before);
    CHECK(grown < 4e6);  // bytes; without reuse of the systems, each of which takes 0.3e6, it is 4.8e6
}
