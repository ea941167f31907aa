// Steps that locate impacts end also if bodies slide or lie on one another: a pair that touches for a whole step is a contact, not
// an event.
#include <algorithm>

#include "plab/random.h"
#include "reference/impacts.h"

using namespace plab;
using namespace plab::test;

namespace
{

const char* const kLocating[] = {"LocalRoot", "ConservativeAdvancement", "LocalBisection", "Bisection"};
const char* const kHalving[] = {"LocalBisection", "Bisection"};
const char* const kResponses[] = {"Impulse", "Rows"};

/// Bound on the number of detections of locating in one step of these scenes: a multiple of a few impacts. A test ends there.
constexpr int kMostTrials = 5000;

void run_bounded(Scene& s, double until)
{
    while (s.simulation().time() < until - 1e-9)
    {
        s.step();
        REQUIRE(s.simulation().stepper().report().trials < kMostTrials);
    }
}

std::string law(double restitution, double friction)
{
    return "response.restitution=\"" + text(restitution) + "\" response.friction=\"" + text(friction) + "\"";
}

std::string contact(const char* resolution, const char* response, const std::string& bodies, double restitution, double friction)
{
    return "<component id=\"contact\" type=\"CDetection/ODE\" between=\"" + bodies + "\" resolution=\"Resolution/" + resolution +
           "\" response=\"Response/" + response + "\" " + law(restitution, friction) + "/>";
}

template <class Test>
void for_all_laws(const Test& test)
{
    for (const char* resolution : kLocating)
        for (const char* response : kResponses)
            for (const double friction : {0.0, 0.4})
                for (const double restitution : {0.0, 0.5, 1.0})
                {
                    CAPTURE(resolution);
                    CAPTURE(response);
                    CAPTURE(friction);
                    CAPTURE(restitution);
                    test(resolution, response, restitution, friction);
                }
}

/// Floor and wall are planes of one static body; the wall is x = 0, to its right is free.
const char* const kRoom =
    "<component id=\"floor\" type=\"Shape/Plane\"/><component id=\"wall\" type=\"Shape/Plane\" orientation=\"axis 0 1 0 90 deg\"/>"
    "<component id=\"room\" type=\"State/Static\" shape=\"floor wall\"/>";

}  // namespace

TEST_CASE("a ball that falls along a wall and touches it bounces on the floor of the same body as if there were no wall")
{
    for (const double away : {0.0, 1e-15, 1e-12})
        for (const double speed : {0.0, 1e-9})
            for_all_laws(
                [&](const char* resolution, const char* response, double restitution, double friction)
                {
                    CAPTURE(away);
                    CAPTURE(speed);
                    Scene s(std::string(kRoom) + sphere("ball", 0.1, at({0.1 + away, 0, 0.6}, {speed, 0, 0})) + gravity("ball") +
                            contact(resolution, response, "ball room", restitution, friction));
                    REQUIRE_MESSAGE(s.loaded(), s.error());
                    run_bounded(s, 0.4);
                    const double fall = std::sqrt(2 * 0.5 / 9.81), up = restitution * 9.81 * fall, t = s.simulation().time() - fall;
                    CHECK(std::fabs(s.vec("ball", "position").z - (0.1 + up * t - (restitution > 0 ? 0.5 * 9.81 * t * t : 0.0))) < 1e-9);
                    CHECK(std::fabs(s.vec("ball", "position").x - 0.1) < 1e-8);
                });
}

TEST_CASE("bodies that touch a wall while they fall along it fall freely: compounds, boxes, capsules and cylinders")
{
    struct Body
    {
        const char* name;
        const char* shape;
        double half;  // m, towards the wall
    };
    const Body bodies[] = {
        {"dumbbell",
         "<component id=\"left\" type=\"Shape/Sphere\" radius=\"0.1\" position=\"-0.2 0 0\"/><component id=\"right\" type=\"Shape/Sphere\" "
         "radius=\"0.1\" position=\"0.2 0 0\"/><component id=\"b.shape\" type=\"Shape/Compound\" parts=\"left right\"/>",
         0.3},
        {"box", "<component id=\"b.shape\" type=\"Shape/Box\" half_extents=\"0.3 0.1 0.2\"/>", 0.3},
        {"capsule", "<component id=\"b.shape\" type=\"Shape/Capsule\" radius=\"0.1\" length=\"0.4\"/>", 0.1},
        {"cylinder", "<component id=\"b.shape\" type=\"Shape/Cylinder\" radius=\"0.1\" height=\"0.4\"/>", 0.1},
        {"ball", "<component id=\"b.shape\" type=\"Shape/Sphere\" radius=\"0.1\"/>", 0.1},
    };
    for (const Body& body : bodies)
        for (const double away : {0.0, 1e-15})
            for_all_laws(
                [&](const char* resolution, const char* response, double restitution, double friction)
                {
                    CAPTURE(body.name);
                    CAPTURE(away);
                    Scene s(box("wall", {0.5, 0.5, 5}, "position=\"0 0 0\"", "Static") + body.shape +
                            "<component id=\"b\" type=\"State/RigidBody\" shape=\"b.shape\" " + at({0.5 + body.half + away, 0, 1}) + "/>" +
                            gravity("b") + contact(resolution, response, "b wall", restitution, friction));
                    REQUIRE_MESSAGE(s.loaded(), s.error());
                    run_bounded(s, 0.25);
                    CHECK(std::fabs(s.vec("b", "position").z - (1 - 0.5 * 9.81 * 0.0625)) < 1e-9);
                    CHECK(std::fabs(s.vec("b", "position").x - (0.5 + body.half)) < 1e-9);
                });
}

TEST_CASE("a released stack is at rest in its first step after one event, and neighbouring bodies do not hold one another")
{
    constexpr int kHigh = 40;
    const auto cubes_at = [](const std::vector<Vec3>& places, const char* resolution)
    {
        std::string cubes, bodies;
        for (std::size_t i = 0; i < places.size(); ++i)
            cubes += box("c" + std::to_string(i), {0.5, 0.5, 0.5}, at(places[i], {})), bodies += "c" + std::to_string(i) + " ";
        return "<component id=\"plane\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"plane\"/>" + cubes +
               gravity(bodies) + contact(resolution, "Impulse", bodies + "ground", 0.3, 0.5);
    };
    for (const char* resolution : {"LocalRoot", "ConservativeAdvancement"})
    {
        CAPTURE(std::string(resolution));
        std::vector<Vec3> tower;
        for (int i = 0; i < kHigh; ++i) tower.push_back({0, 0, i + 0.5});
        Scene s(cubes_at(tower, resolution));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.step();
        CHECK(s.simulation().stepper().report().events == 1);
        CHECK(s.simulation().stepper().report().trials < 20 * kHigh);
        // Each on the one below, or on the ground; four points, of which the first identifies the pair.
        CHECK(s.count("contact.begin") == kHigh);
        CHECK(s.count("contact.rest") == kHigh);

        Scene row(cubes_at({{0, 0, 0.5}, {1, 0, 0.5}, {2, 0, 0.5}}, resolution));
        REQUIRE_MESSAGE(row.loaded(), row.error());
        row.keep_events = true;
        row.step();
        CHECK(row.count("contact.begin") == 3);
        CHECK(row.count("contact.rest") == 3);
    }
}

TEST_CASE("bisection: a released stack is at rest in its first step, each cube in an event when it is released")
{
    constexpr int kHigh = 10;
    const auto stack = [](double half, const char* resolution, const char* response)
    {
        std::string cubes, bodies;
        for (int i = 0; i < kHigh; ++i)
        {
            cubes += box("c" + std::to_string(i), {half, half, half}, at({0, 0, (2 * i + 1) * half}));
            bodies += "c" + std::to_string(i) + " ";
        }
        return kGround + cubes + gravity(bodies) + contact(resolution, response, bodies + "ground", 0, 0.8);
    };
    // m: with 0.15 and 0.05, rounding of the positions lets some of the cubes overlap and leaves a gap to others.
    for (const double half : {0.5, 0.15, 0.05})
        for (const char* resolution : kHalving)
            for (const char* response : kResponses)
            {
                CAPTURE(half);
                CAPTURE(std::string(resolution));
                CAPTURE(std::string(response));
                Scene s(stack(half, resolution, response), "dt=\"1/60\"");
                REQUIRE_MESSAGE(s.loaded(), s.error());
                s.keep_events = true;
                s.step();
                CHECK(s.simulation().stepper().report().events == kHigh);
                // One trial at the beginning finds that a pair is clear there, and another one that it touches.
                CHECK(s.simulation().stepper().report().trials <= 2 * kHigh);
                CHECK(s.count("contact.rest") == kHigh);
                for (const Event& e : s.events) CHECK(e.time == 0);
                s.step();
                CHECK(s.simulation().stepper().report().events == 0);
                CHECK(distance(s.vec("c" + std::to_string(kHigh - 1), "position"), {0, 0, (2 * kHigh - 1) * half}) < 2e-4);
            }
}

TEST_CASE("bisection: the impulse passes through touching balls at the time of the first impact, without a search for each pair")
{
    constexpr int kBalls = 5;
    constexpr double kRadius = 0.125, kSpeed = 1.1;  // positions without rounding
    std::string row = sphere("b0", kRadius, at({-2 * kRadius, 0, 0}, {kSpeed, 0, 0})), bodies = "b0 ";
    for (int i = 1; i < kBalls; ++i)
        row += sphere("b" + std::to_string(i), kRadius, at({2 * kRadius * i, 0, 0})), bodies += "b" + std::to_string(i) + " ";
    for (const char* resolution : kHalving)
    {
        CAPTURE(std::string(resolution));
        Scene s(row + contact(resolution, "Impulse", bodies, 1, 0));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        int trials = 0;
        for (; s.simulation().time() < 0.25; trials += s.simulation().stepper().report().trials) s.step();
        const std::vector<Event> impacts = events_of(s, "contact.impact");
        REQUIRE(impacts.size() == kBalls - 1);
        CHECK(near(impacts.front().time, 2 * kRadius / kSpeed, 1e-15));
        for (const Event& e : impacts) CHECK(e.time == impacts.front().time);
        CHECK(trials <= 50 + 2 * (kBalls - 1));
        for (int i = 0; i < kBalls; ++i)
            CHECK(near(s.vec("b" + std::to_string(i), "linear_velocity").x, i == kBalls - 1 ? kSpeed : 0, 1e-15));
    }
}

TEST_CASE("bisection: a ball that leaves the floor when its piece begins meets it when it comes back")
{
    constexpr double kUp = 0.015;
    for (const char* resolution : kHalving)
    {
        CAPTURE(std::string(resolution));
        Scene s(kGround + sphere("ball", 0.125, at({0, 0, 0.125}, {0, 0, kUp})) + gravity("ball") +
                contact(resolution, "Impulse", "ball ground", 1, 0));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.step();
        const std::vector<Event> impacts = events_of(s, "contact.impact");
        REQUIRE(impacts.size() == 1);
        CHECK(near(impacts.front().time, 2 * kUp / 9.81, 1e-12));
    }
}

TEST_CASE("a wall of touching bricks is released: its first step takes bounded work, with any response")
{
    // Rows of contacts and joints processed in all: 9.2 million, and 28.9 million without a bound on the sweeps of an impact.
    constexpr std::uint64_t kMostRows = 10'000'000;
    constexpr int kBricks = 400, kRow = 20;
    for (const char* response : kResponses)
    {
        CAPTURE(std::string(response));
        std::string bricks, bodies;
        for (int i = 0; i < kBricks; ++i)
        {
            const int row = i / kRow;
            const std::string id = "b" + std::to_string(i);
            bricks += box(id, {0.5, 0.25, 0.25}, at({i % kRow + (row % 2 == 0 ? 0.0 : 0.5), 0, 0.5 * row + 0.25}));
            bodies += id + " ";
        }
        Scene s("<component id=\"plane\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"plane\"/>" + bricks +
                    gravity(bodies) + contact("LocalRoot", response, bodies + "ground", 0, 0.5),
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        s.step();
        MESSAGE(std::string(response), ": ", s.simulation().stepper().report().swept_rows, " rows, ",
                s.simulation().stepper().report().trials, " trials");
        CHECK(s.simulation().stepper().report().swept_rows < kMostRows);
    }
}

TEST_CASE("a heap of falling bodies: each step's work is bounded, the state stays finite, and repeats bit for bit")
{
    constexpr int kBodies = 64;
    const auto heap = [](const char* resolution, const char* response)
    {
        std::uint64_t seed = 5;
        std::string out = kGround, all;
        for (int i = 0; i < kBodies; ++i)
        {
            const auto jitter = [&] { return 0.06 * next_uniform(seed) - 0.03; };
            const std::string id = "b" + std::to_string(100 + i);
            const double x = 0.26 * (i % 4) + jitter(), y = 0.26 * (i / 4 % 4) + jitter(), z = 0.15 + 0.3 * (i / 16) + jitter();
            out += i % 2 == 0 ? sphere(id, 0.1, at({x, y, z})) : box(id, {0.1, 0.1, 0.1}, at({x, y, z}));
            all += id + " ";
        }
        // Hardly more than the bound on the work of every step, which these heaps reach.
        return out + gravity(all) + "<component id=\"contact\" type=\"CDetection/ODE\" between=\"" + all +
               "ground\" resolution=\"Resolution/" + resolution + "\" resolution.max_work=\"0.01\" response=\"Response/" + response +
               "\" response.restitution=\"0.5\"/>";
    };
    for (const char* resolution : kLocating)
        for (const char* response : kResponses)
        {
            CAPTURE(resolution);
            CAPTURE(response);
            std::uint64_t hash = 0;
            for (int run = 0; run < (std::string(response) == "Impulse" ? 2 : 1); ++run)
            {
                Scene s(heap(resolution, response), "dt=\"1/60\"");
                REQUIRE_MESSAGE(s.loaded(), s.error());
                s.warnings_expected = true, s.keep_events = true;
                for (int i = 0; i < 24; ++i)
                {
                    s.step();
                    REQUIRE(s.simulation().stepper().report().trials < 60000);
                }
                CHECK(s.count("resolution.over_budget") > 0);
                for (int i = 0; i < kBodies; ++i) CHECK(std::isfinite(length(s.vec("b" + std::to_string(100 + i), "position"))));
                if (run == 0) hash = s.hash();
                CHECK(s.hash() == hash);
            }
        }
}
