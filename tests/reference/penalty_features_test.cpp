// Spring contacts whose points come, go and change their names while bodies overlap: without damping they keep the energy.
#include <algorithm>
#include <cmath>

#include "support/gravity.h"
#include "support/ground.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using plab::test::kGround;
using plab::test::Scene;
using plab::test::text;

namespace
{

std::string lossless(const std::string& law)
{
    return "<component id='contact' type='CDetection/ODE' between='*' response='Response/" + law + "' response.restitution='1'/>";
}

/// J: kinetic, of the weights and of the springs.
double whole_energy(const Scene& s)
{
    const auto totals = s.simulation().totals();
    return totals.kinetic + totals.stored;
}

}  // namespace

TEST_CASE("a capsule that falls upright on a box keeps the energy, whether its end counts as corner or as nearest point")
{
    // The box is hit beside its middle and turns, so the two are parallel at first, or in between.
    for (const char* law : {"Penalty", "HuntCrossley"})
        for (const double tilt : {0.0, 1e-9, 1e-7, 1e-5, 1e-3, -1e-3})
        {
            CAPTURE(std::string(law));
            CAPTURE(tilt);
            const Quat q{std::cos(tilt / 2), 0, std::sin(tilt / 2), 0};
            Scene s(
                "<component id='brick' type='Shape/Box' half_extents='0.1 0.08 0.06'/><component id='pill' type='Shape/Capsule' "
                "radius='0.06' length='0.14'/><component id='a' type='State/RigidBody' density='500' shape='brick'/><component id='b' "
                "type='State/RigidBody' density='500' shape='pill' position='0.03 0 0.3' linear_velocity='0 0 -2' orientation='" +
                text(q) + "'/>" + lossless(law));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            const double before = whole_energy(s);
            s.run(0.2);
            CHECK(length(s.vec("a", "angular_velocity")) > 1);
            CHECK(std::fabs(whole_energy(s) - before) < 1e-8 * before);
        }
}

TEST_CASE("two cylinders that fall flat on one another gain no energy, though points appear in their overlap")
{
    double most = 0;
    for (int i = 0; i < 8; ++i)
    {
        CAPTURE(i);
        const double x = 0.01 * i;
        Scene s(kGround +
                std::string("<component id='coin' type='Shape/Cylinder' radius='0.12' height='0.02'/><component id='tin' "
                            "type='Shape/Cylinder' radius='0.08' height='0.12'/><component id='a' type='State/RigidBody' density='500' "
                            "shape='tin' position='0 0 0.25' angular_velocity='0 0 3'/><component id='b' type='State/RigidBody' "
                            "density='500' shape='coin' position='") +
                text(x) + " 0.01 0.55' angular_velocity='0 0 -2'/>" + lossless("Penalty") + test::kGravity);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        double least = whole_energy(s), kinetic = 0;
        for (int k = 0; k < 120; ++k)
        {
            s.step();
            kinetic = std::max(kinetic, s.simulation().totals().kinetic);
            least = std::min(least, whole_energy(s));
            most = std::max(most, (whole_energy(s) - least) / kinetic);
        }
    }
    MESSAGE("largest rise of the energy, relative to the kinetic energy: ", most);
    CHECK(most < 1e-6);
}
