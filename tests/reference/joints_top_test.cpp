// Tops on a ball joint that turn far in a step, with nothing named.
#include <cmath>

#include "support/gravity.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using plab::test::Scene;
using plab::test::text;

TEST_CASE("a heavy top that turns by several radians in a step keeps its energy")
{
    for (const auto& [spin, dt] : {std::pair(300.0, "1/60"), std::pair(1000.0, "1/240"), std::pair(60.0, "1/60")})
    {
        CAPTURE(spin);
        // It leans by 0.5 rad and turns about its axis; its centre of mass is 0.1 m from the joint.
        const Vec3 w{spin * std::sin(0.5), 0, spin * std::cos(0.5)};
        Scene s(
            "<component id='b' type='State/RigidBody' mass='1' inertia='0.002 0.002 0.001' center_of_mass='0 0 0.1' orientation='axis 0 "
            "1 0 0.5 rad' angular_velocity='" +
                text(w) + "'/><component id='j' type='Constraint/Ball' b='b' anchor='0 0 0'/>" + plab::test::kGravity,
            std::string("dt=\"") + dt + "\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const auto energy = [&] { return s.simulation().totals().kinetic + s.simulation().totals().stored; };
        const double before = energy();
        s.run(1);
        CHECK(std::fabs(energy() - before) < 1e-6 * before);
    }
}
