// scenes/surfaces.xml: bodies inside concave surfaces stay inside.
#include "support/scene.h"

using namespace plab;
using plab::test::Scene;

TEST_CASE("bodies in the bowl, the pipe and the drum stay there; nothing sinks into the waves")
{
    Scene s = Scene::file("scenes/surfaces.xml");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const auto at = [&](const char* id) { return s.vec(id, "position"); };
    for (int i = 0; i < 8; ++i)
    {
        s.run(0.5 * (i + 1));
        for (const char* id : {"in_bowl_ball", "in_bowl_box", "in_bowl_gem"})
        {
            CAPTURE(std::string(id));
            CHECK(length(at(id) - Vec3{-1.6, -0.5, 0.75}) < 0.6);
            CHECK(at(id).z < 0.9);
        }
        for (const char* id : {"in_drum_can", "in_drum_ball"}) CHECK(std::hypot(at(id).x - 1.4, at(id).z - 0.8) < 0.56);
        for (const char* id : {"on_ground_box", "on_ground_can", "on_ground_pill", "on_stairs", "in_pipe_ball"}) CHECK(at(id).z > -0.05);
    }
    CHECK(length(at("in_bowl_ball") - Vec3{-1.6, -0.5, 0.75}) > 0.45);
    CHECK(at("on_stairs").x > 0.1);  // down three stairs of 0.4 m
    CHECK(std::fabs(at("on_ground_box").z) < 0.2);
}
