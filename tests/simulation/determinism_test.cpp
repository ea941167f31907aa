// The same hash for any number of threads, any observer, two worlds in one process. Other builds (-O0, clang) are
// compared by tests/golden.
#include <atomic>
#include <mutex>
#include <set>

#include "plab/parts.h"
#include "plab/random.h"
#include "simulation/threads/worker_pool.h"
#include "support/scene.h"

using namespace plab;
using plab::test::Scene;

namespace
{

/// Many independent things: springs of gears, falling and bouncing balls, scripts.
const char* const kCrowd = R"(
  <component id="ball_shape" type="Shape/Sphere" radius="0.05"/><component id="floor" type="Shape/Plane"/>
  <component id="ground" type="State/Static" shape="floor"/>
  <repeat id="balls" count="8 8" step="0.5 0.5 0" jitter="0.01">
    <component id="ball" type="State/RigidBody" mass="1" shape="ball_shape" position="0 0 0.5" angular_velocity="1 2 3"/>
  </repeat>
  <component id="g" type="Field/Gravity" between="balls"/>
  <component id="contact" type="CDetection/ODE" between="balls" against="ground" resolution="Resolution/LocalBisection"
             response="Response/Impulse" response.restitution="0.7" response.friction="0.2"/>
  <repeat id="wheels" count="10" step="0 1 0"><component id="wheel" type="State/Shaft" inertia="0.5" angular_velocity="2"/></repeat>)";

std::uint64_t hash_after(int threads, double t)
{
    Scene s(kCrowd, "dt=\"1/120\" seed=\"5\"", threads);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(t);
    return s.hash();
}

}  // namespace

TEST_CASE("one, two and three threads give the same hash")
{
    const std::uint64_t one = hash_after(1, 1);
    CHECK(hash_after(2, 1) == one);
    CHECK(hash_after(3, 1) == one);
    CHECK(hash_after(1, 1) == one);
}

TEST_CASE("so does the paper's scene, at every step, and two interleaved worlds equal two alone")
{
    Scene a = Scene::file("scenes/fan_and_balloons.xml", 1), b = Scene::file("scenes/fan_and_balloons.xml", 2);
    Scene crowd(kCrowd, "dt=\"1/120\" seed=\"5\"");
    for (int i = 0; i < 1200; ++i)
    {
        a.step(), b.step();
        if (i < 120) crowd.step();
        REQUIRE(a.hash() == b.hash());
    }
    CHECK(crowd.hash() == hash_after(1, 1));
}

TEST_CASE("pairwise couplings are swept train by train: the number of threads has no effect")
{
    std::string body;
    for (int train = 0; train < 7; ++train)
    {
        const std::string t = std::to_string(train);
        for (int i = 0; i < 4; ++i)
            body += "<component id=\"s" + t + std::to_string(i) + "\" type=\"State/Shaft\" inertia=\"" +
                    std::to_string(1 + 0.3 * train + i) + "\" angular_velocity=\"" + std::to_string(train - 2 * i) + "\"/>";
        for (int i = 0; i < 3; ++i)
            body += "<component id=\"g" + t + std::to_string(i) + "\" type=\"Constraint/AngularVelocity/Impulse\" driver=\"s" + t +
                    std::to_string(i) + "\" driven=\"s" + t + std::to_string(i + 1) + "\" velocity_factor=\"" +
                    std::to_string(-0.7 + 0.31 * i) + "\"/>";
        body += "<component id=\"m" + t + "\" type=\"Script/Lua\" driven=\"s" + t +
                "0\"><param name=\"code\">function force(t, state) "
                "driven:add_torque(1 - 0.1 * driven.speed) end</param></component>";
    }
    std::vector<std::uint64_t> hashes;
    for (int threads = 1; threads <= 4; ++threads)
    {
        Scene s(body, "dt=\"1/100\"", threads);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        hashes.push_back(s.hash());
    }
    for (const std::uint64_t h : hashes) CHECK(h == hashes.front());
}

TEST_CASE("a heap of mixed shapes has the same hash with 1 to 16 threads: detection is divided among them")
{
    std::string body =
        R"(<component id="q" type="Shape/Box" half_extents="0.1 0.12 0.1"/><component id="s" type="Shape/Sphere" radius="0.11"/>
        <component id="c" type="Shape/Capsule" radius="0.08" length="0.14"/><component id="floor" type="Shape/Plane"/>
        <component id="ground" type="State/Static" shape="floor"/><component id="g" type="Field/Gravity" between="*"/>
        <component id="contact" type="CDetection/ODE" between="*" resolution="Resolution/None" response="Response/Rows"
                   response.friction="0.4"/>)";
    const char* const shapes[] = {"q", "s", "c"};
    std::uint64_t seed = 9;
    for (int i = 0; i < 300; ++i)
    {
        const auto at = [&](int cell) { return std::to_string(0.23 * cell + 0.02 * next_uniform(seed)); };
        body += "<component id=\"b" + std::to_string(i) + "\" type=\"State/RigidBody\" mass=\"1\" shape=\"" + shapes[i % 3] +
                "\" position=\"" + at(i % 6) + " " + at(i / 6 % 6) + " " + at(1 + i / 36) + "\"/>";
    }
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3, 4, 16})
    {
        Scene s(body, "dt=\"1/120\"", threads);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(0.2);
        hashes.push_back(s.hash());
    }
    for (const std::uint64_t h : hashes) CHECK(h == hashes.front());
}

TEST_CASE("the order of a blueprint's components does not matter")
{
    const std::string
        x = "<component id=\"x\" type=\"State/Shaft\" inertia=\"1\" angular_velocity=\"3\"/>",
        y = "<component id=\"y\" type=\"State/Shaft\" inertia=\"2\"/>",
        g = "<component id=\"g\" type=\"Constraint/AngularVelocity/Graph\" driver=\"x\" driven=\"y\" velocity_factor=\"0.3\"/>";
    Scene one(x + y + g), two(g + y + x);
    one.run(1), two.run(1);
    CHECK(one.hash() == two.hash());
}

TEST_CASE("what bodies do does not depend on others that they never meet")
{
    // A ball leaves the top of a round hill. A far larger one, far away, has gaps that are far larger in the middle of a step.
    const std::string ball = R"(
  <component id="g" type="Field/Gravity" between="*"/>
  <component id="hill" type="State/Static" shape="Shape/Sphere" shape.radius="1"/>
  <component id="ball" type="State/RigidBody" mass="1" position="0 0 1.1" linear_velocity="0.5 0 0.05"
             shape="Shape/Sphere" shape.radius="0.1"/>)";
    const std::string other = R"(
  <component id="other_hill" type="State/Static" position="100 0 0" shape="Shape/Sphere" shape.radius="10"/>
  <component id="other" type="State/RigidBody" mass="1" position="100 0 15" linear_velocity="8 0 0.05"
             shape="Shape/Sphere" shape.radius="5"/>)";
    for (const char* resolution : {"None", "LocalRoot", "Speculative"})
    {
        CAPTURE(std::string(resolution));
        const std::string contact = std::string("<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/") +
                                    resolution + "' response.friction='0.5'/>";
        Scene alone(ball + contact, "dt='1/60'"), among(ball + other + contact, "dt='1/60'");
        REQUIRE_MESSAGE(alone.loaded(), alone.error());
        REQUIRE_MESSAGE(among.loaded(), among.error());
        for (int i = 0; i < 60; ++i)
        {
            alone.step(), among.step();
            REQUIRE(alone.vec("ball", "position") == among.vec("ball", "position"));
        }
    }
}

TEST_CASE("reading energies, hashes and events changes nothing")
{
    Scene watched = Scene::file("scenes/fan_and_balloons.xml"), alone = Scene::file("scenes/fan_and_balloons.xml");
    for (int i = 0; i < 1000; ++i)
    {
        watched.step();
        (void)watched.simulation().totals();
        (void)watched.hash();
        alone.simulation().step();
    }
    CHECK(watched.hash() == alone.hash());
}

TEST_CASE("the hash depends on every single bit of the state")
{
    Scene s = Scene::file("scenes/fan_and_balloons.xml");
    const std::uint64_t before = s.hash();
    auto& shafts = s.simulation().world().host().shafts;
    shafts.angle[0] = std::nextafter(shafts.angle[0], 1.0);
    CHECK(s.hash() != before);
}

namespace
{

/// Balls on a floor in columns of `high`, `apart` (m) from one another; a ball is 0.2 m wide.
std::string columns(int side, int high, double apart)
{
    std::string out = R"(<component id="s" type="Shape/Sphere" radius="0.1"/><component id="floor" type="Shape/Plane"/>
        <component id="ground" type="State/Static" shape="floor"/><component id="g" type="Field/Gravity" between="*"/>
        <component id="manager" type="Manager/SoftStep" substeps="4"/>
        <component id="contact" type="CDetection/ODE" between="*" resolution="Resolution/None" response="Response/Rows"
                   response.manager="manager" response.friction="0.3"/>)";
    for (int i = 0; i < side * side * high; ++i)
    {
        const double x = apart * (i % side) + 0.003 * (i % 7), y = apart * (i / side % side) + 0.003 * (i % 5);
        out += "<component id=\"b" + std::to_string(i) + "\" type=\"State/RigidBody\" shape=\"s\" mass=\"1\" position=\"" +
               std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(0.1 + 0.199 * (i / side / side)) + "\"/>";
    }
    return out;
}

void check_threads(const std::string& heap)
{
    std::uint64_t alone = 0;
    for (const int threads : {1, 2, 3, 4, 16})
    {
        Scene s(heap, "dt=\"1/60\"", threads);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(0.25);
        if (threads == 1) alone = s.hash();
        CHECK_MESSAGE(s.hash() == alone, threads);
    }
}

}  // namespace

TEST_CASE("a heap that is one large island, and many islands: 1 to 16 threads give the same hash")
{
    check_threads(columns(12, 6, 0.199));
    check_threads(columns(8, 4, 0.4));
}

namespace
{

/// Columns of boxes far from one another, of different heights, under a manager.
std::string towers(const char* manager, int side)
{
    std::string out = R"(<component id="s" type="Shape/Box" half_extents="0.1 0.12 0.1"/><component id="floor" type="Shape/Plane"/>
        <component id="ground" type="State/Static" shape="floor"/><component id="g" type="Field/Gravity" between="*"/>
        <component id="manager" type="Manager/)" +
                      std::string(manager) + R"("/>
        <component id="contact" type="CDetection/ODE" between="*" resolution="Resolution/None" response="Response/Rows"
                   response.manager="manager" response.friction="0.5" response.restitution="0.3"/>)";
    int n = 0;
    for (int i = 0; i < side * side; ++i)
        for (int k = 0; k < 1 + i * i % 11; ++k)
            out += "<component id=\"b" + std::to_string(n++) + "\" type=\"State/RigidBody\" shape=\"s\" mass=\"1\" position=\"" +
                   std::to_string(i % side + 0.003 * (k % 7)) + " " + std::to_string(i / side + 0.003 * (k % 5)) + " " +
                   std::to_string(0.1 + 0.199 * k) + "\" linear_velocity=\"0.3 0 0\"/>";
    return out;
}

}  // namespace

TEST_CASE("many small islands of different sizes, which threads advance side by side: 1 to 16 threads give the same hash")
{
    for (const char* manager : {"SoftStep", "SequentialImpulse", "Direct", "Automatic"})
    {
        CAPTURE(manager);
        check_threads(towers(manager, 6));
    }
}

TEST_CASE("the parts of a loop are the same for any number of threads")
{
    using Parts = std::set<std::pair<std::size_t, std::size_t>>;
    const auto parts_with = [](Workers* workers)
    {
        Parts out;
        std::mutex mutex;
        for_parts(workers, 1000, 16,
                  [&](std::size_t begin, std::size_t end)
                  {
                      const std::lock_guard lock(mutex);
                      CHECK(out.insert({begin, end}).second);
                  });
        return out;
    };
    const Parts alone = parts_with(nullptr);
    CHECK(alone.size() == 63);
    for (const int threads : {1, 2, 3, 16})
    {
        simulation::WorkerPool pool(threads);
        CHECK(parts_with(&pool) == alone);
    }
}

TEST_CASE("a pool does each job of many short calls once, with and without a processor for each thread")
{
    for (const int threads : {2, 16})
    {
        simulation::WorkerPool pool(threads);
        std::vector<std::atomic<int>> done(7);
        constexpr int kCalls = 3000;
        for (int call = 1; call <= kCalls; ++call)
        {
            pool.run(done.size(), [&](std::size_t i) { ++done[i]; });
            for (const auto& d : done) REQUIRE(d == call);
        }
    }
}
