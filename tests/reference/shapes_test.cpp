// scenes/shapes.xml: every kind of colliding shape comes to rest where its geometry requires.
#include "support/scene.h"

using namespace plab;
using plab::test::Scene;

TEST_CASE("all kinds of shapes fall on a plate and come to rest on it, each at the height of its geometry")
{
    Scene s = Scene::file("scenes/shapes.xml");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(8);  // the penny rolls on its rim for 7 s
    // The plate's upper side is at 0.1 m.
    const auto height = [&](const char* id) { return s.vec(id, "position").z - 0.1; };
    CHECK(std::fabs(height("ball") - 0.12) < 1e-4);
    CHECK(std::fabs(height("block") - 0.1) < 1e-4);    // on a side of 0.36 x 0.12
    CHECK(std::fabs(height("tablet") - 0.07) < 1e-4);  // lies
    CHECK(std::fabs(height("tin") - 0.12) < 1e-4);     // stands
    CHECK(std::fabs(height("penny") - 0.015) < 1e-4);  // lies flat
    CHECK(std::fabs(height("stone") - 0.1) < 1e-4);    // on its upper face
    CHECK(std::fabs(height("weights") - 0.1) < 1e-4);  // on both balls
    CHECK(std::fabs(height("tool") - 0.06) < 1e-3);    // on its head and the end of the handle
    for (const char* id : {"block", "tin", "penny", "stone", "stop", "tool"})
    {
        CAPTURE(std::string(id));
        CHECK(length(s.vec(id, "linear_velocity")) < 1e-3);
    }
}
