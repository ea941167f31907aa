// Energy where contacts are answered at the ends of steps: bodies that tumble onto a plane, and spinning bodies that rest on it.
#include "drops.h"

using namespace plab;
using namespace plab::test;

namespace
{

const char* const kSpin = "30 35 20";

/// A ball of 0.1 m and 1 kg with three different moments of inertia, which rests on the ground and spins.
std::string spinning_ball(const Method& method, double friction)
{
    const bool impulse = method.manager == std::string("Impulse");
    return std::string(kGround) +
           ball("f", 0.1, 1, {0, 0, 0.1},
                std::string("center_of_mass=\"0 0 0\" inertia=\"0.002 0.004 0.006\" angular_velocity=\"") + kSpin + "\"") +
           gravity("f") + "<component id=\"contact\" type=\"CDetection/ODE\" between=\"f ground\" resolution=\"Resolution/" +
           method.resolution + "\" response=\"Response/" +
           (impulse ? "Impulse\"" : "Rows\" response.manager=\"Manager/" + std::string(method.manager) + "\"") + " response.friction=\"" +
           text(friction) + "\" response.restitution=\"0\"/>";
}

struct Spun
{
    double start = 0, highest = 0, rise = 0, last = 0;  ///< J, kinetic
};
Spun spin(const Method& method, double friction, double h, double until)
{
    Scene s(spinning_ball(method, friction), "dt=\"" + text(h) + "\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    Spun out;
    out.start = out.last = out.highest = s.simulation().totals().kinetic;
    while (s.simulation().time() < until - 0.5 * h)
    {
        s.step();
        const double now = s.simulation().totals().kinetic;
        out.highest = std::max(out.highest, now), out.rise = std::max(out.rise, now - out.last), out.last = now;
    }
    return out;
}

const Method kResting[] = {{"None", "Direct"},      {"None", "SequentialImpulse"}, {"None", "SoftStep"},     {"None", "Impulse"},
                           {"LocalRoot", "Direct"}, {"LocalRoot", "Impulse"},      {"Speculative", "Direct"}};

}  // namespace

TEST_CASE("tumbling bodies of any shape gain no energy from contacts at the ends of steps, with any response") { check_drops(11, 40); }
TEST_CASE("a thousand random drops gain no energy") { check_drops(12, 1000); }

TEST_CASE("the rod that tumbles on the floor at 1/240 starts with 104 J and never has more")
{
    Drop d;
    d.axis = {-0.9352, 0.0889, -0.7059}, d.angle = 1.3744, d.spin = {35.8005, -34.3680, -33.7218}, d.until = 0.5;
    for (const Method& method : kMethods)
    {
        CAPTURE(method.resolution);
        CAPTURE(method.manager);
        const Fall f = play(d, method);
        CHECK(f.start == doctest::Approx(104.088).epsilon(1e-5));
        CHECK(f.highest <= f.start * (1 + 1e-9) + allowance(d));
        if (method.manager != std::string("SoftStep")) CHECK(f.gained <= 1e-9 * f.start);
    }
}

TEST_CASE("a spinning ball of unequal inertia keeps its kinetic energy on a smooth plane, and never gains any on a rough one")
{
    for (const Method& method : kResting)
        for (const double h : {1.0 / 60, 1.0 / 240, 1.0 / 1000})
        {
            CAPTURE(method.resolution);
            CAPTURE(method.manager);
            CAPTURE(h);
            const Spun smooth = spin(method, 0, h, 10);
            CHECK(std::fabs(smooth.last / smooth.start - 1) < 1e-10);
            CHECK(smooth.highest <= smooth.start * (1 + 1e-10));
            const Spun rough = spin(method, 0.5, h, 2);
            CHECK(rough.rise <= 1e-9 * rough.start);
            CHECK(rough.last < rough.start);
        }
}
