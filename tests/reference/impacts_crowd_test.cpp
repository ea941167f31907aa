// Many bodies of several shapes in a closed room, with long steps: no body leaves the room, none sinks in, and energy is
// conserved.
#include <algorithm>

#include "impacts.h"
#include "plab/random.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string wall(const std::string& id, const Vec3& p, const std::string& turn)
{
    return "<component id=\"" + id + "\" type=\"State/Static\" shape=\"floor\" position=\"" + text(p) + "\" orientation=\"" + turn + "\"/>";
}

/// A room of 2 m with `n` bodies that fly and spin.
std::string room(int n, bool boxes, double speed, double spin, std::uint64_t seed, const std::string& resolution,
                 const std::string& restitution)
{
    const auto uniform = [&](double low, double high) { return low + (high - low) * next_uniform(seed); };
    std::string out = "<component id=\"floor\" type=\"Shape/Plane\"/>" + wall("w0", {0, 0, -1}, "axis 1 0 0 0 deg") +
                      wall("w1", {0, 0, 1}, "axis 1 0 0 180 deg") + wall("w2", {-1, 0, 0}, "axis 0 1 0 90 deg") +
                      wall("w3", {1, 0, 0}, "axis 0 1 0 -90 deg") + wall("w4", {0, -1, 0}, "axis 1 0 0 -90 deg") +
                      wall("w5", {0, 1, 0}, "axis 1 0 0 90 deg");
    std::string all;
    for (int i = 0; i < n; ++i)
    {
        const std::string id = "b" + std::to_string(i);
        // On a grid of 4 x 4 x 4, so that no two bodies overlap at the start.
        const Vec3 p{-0.75 + 0.5 * (i % 4), -0.75 + 0.5 * (i / 4 % 4), -0.75 + 0.5 * (i / 16)};
        const double vx = uniform(-speed, speed), vy = uniform(-speed, speed), vz = uniform(-speed, speed);
        const double wx = uniform(-spin, spin), wy = uniform(-spin, spin), wz = uniform(-spin, spin);
        const std::string motion = at(p, {vx, vy, vz}) + " solver=\"exact\" angular_velocity=\"" + text(Vec3{wx, wy, wz}) + "\"";
        const double size = uniform(0.05, 0.15);
        out += boxes && i % 2 == 0 ? box(id, {size, 0.6 * size, 0.3 * size}, motion) : sphere(id, size, motion);
        all += id + " ";
    }
    return out + "<component id=\"exact\" type=\"Solver/Exact\"/>" + contact(all, resolution, restitution, "against=\"w0 w1 w2 w3 w4 w5\"");
}

struct Outcome
{
    double worst_energy = 0, furthest = 0;
    std::size_t impacts = 0;
    std::uint64_t hash = 0;
};
Outcome play(Scene& s, int n, double t)
{
    const auto kinetic = [&]
    {
        const Bodies& bodies = s.simulation().world().host().bodies;
        double sum = 0;
        for (std::uint32_t b = 0; b < bodies.size(); ++b) sum += bodies.kinetic_energy(b);
        return sum;
    };
    Outcome out;
    const double e0 = kinetic();
    while (s.simulation().time() < t)
    {
        s.step();
        out.worst_energy = std::max(out.worst_energy, std::fabs(kinetic() / e0 - 1));
        for (int i = 0; i < n; ++i)
        {
            const Vec3 p = s.vec("b" + std::to_string(i), "position");
            out.furthest = std::max({out.furthest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        }
        for (const Event& e : s.simulation().events()) out.impacts += e.kind == "contact.impact";
        CHECK(s.simulation().stepper().report().deepest < 1e-9);
    }
    out.hash = s.hash();
    return out;
}

}  // namespace

TEST_CASE("balls in a room keep their energy to rounding at 30 steps per second, whatever the step")
{
    for (const char* dt : {"1/240", "1/30", "1/4"})
    {
        CAPTURE(dt);
        Scene s(room(40, false, 3, 10, 3, "LocalRoot", "1"), std::string("dt=\"") + dt + "\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const Outcome o = play(s, 40, 3);
        CHECK(o.worst_energy < 1e-12);
        CHECK(o.furthest < 1);
        CHECK(o.impacts > 200);
    }
}

TEST_CASE("boxes that spin among balls: no body leaves the room or sinks, and no contact is invented")
{
    for (const char* resolution : {"LocalRoot", "ConservativeAdvancement"})
    {
        CAPTURE(resolution);
        Scene s(room(30, true, 3, 20, 5, resolution, "1"), "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        // Steps of gap / closing speed are numerous where a corner spins past a wall.
        s.warnings_expected = std::string(resolution) == "ConservativeAdvancement";
        const Outcome o = play(s, 30, 2);
        CHECK(o.worst_energy < 1e-9);
        CHECK(o.furthest < 1);
        CHECK(o.impacts > 100);
        MESSAGE(std::string(resolution), ": ", o.impacts, " impacts, energy ", o.worst_energy);
    }
}

TEST_CASE("a repeated run, and a run from a saved step, give the same bits")
{
    Outcome first;
    for (int run = 0; run < 2; ++run)
    {
        Scene s(room(24, true, 3, 10, 9, "LocalRoot", "0.7"), "dt=\"1/60\"", run == 0 ? 1 : 2);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const Outcome o = play(s, 24, 1);
        if (run == 0) first = o;
        CHECK(o.hash == first.hash);
    }
}
