// Meshes with hollows: as hulls they are filled, which a scene is told of where it matters; as triangles they hold what falls into them.
#include <algorithm>

#include "support/gravity.h"
#include "support/scene.h"

namespace plab::test
{
namespace
{

/// An open box without a lid, from 0 to 0.5 m, its walls 2 m apart: seen from inside, as triangles are, or closed by a lid.
std::string tub(bool closed, const std::string& collides)
{
    const std::string lid = closed ? " 4 5 6 4 6 7" : "";
    // Counter-clockwise from inside where it is open, from outside where it is closed.
    const std::string inside = "0 1 2 0 2 3 0 4 5 0 5 1 1 5 6 1 6 2 2 6 7 2 7 3 3 7 4 3 4 0";
    const std::string outside = "0 2 1 0 3 2 0 5 4 0 1 5 1 6 5 1 2 6 2 7 6 2 3 7 3 4 7 3 0 4";
    return "<component id='mesh' type='Shape/Mesh' " + collides +
           " vertices='-1 -1 0  1 -1 0  1 1 0  -1 1 0  -1 -1 0.5  1 -1 0.5  1 1 0.5  -1 1 0.5' triangles='" + (closed ? outside : inside) +
           lid + "'/>";
}

std::string scene(const std::string& mesh, const std::string& state)
{
    return mesh + "<component id='tub' type='State/" + state +
           "' shape='mesh'/><component id='ball.shape' type='Shape/Sphere' radius='0.1'/>"
           "<component id='ball' type='State/RigidBody' mass='1' shape='ball.shape' position='0.2 0.1 0.8'/>"
           "<component id='contact' type='CDetection/ODE' between='*'/><component id='weight' type='Field/Gravity' between='ball'/>";
}

std::size_t hulls_told(const Scene& s)
{
    return static_cast<std::size_t>(std::ranges::count_if(s.events, [](const Event& e) { return e.kind == "detection.hull"; }));
}

TEST_CASE("a tub that stands still and collides as its hull is told of, once; as triangles it holds a ball")
{
    Scene filled(scene(tub(false, ""), "Static"));
    REQUIRE_MESSAGE(filled.loaded(), filled.error());
    filled.keep_events = filled.warnings_expected = true;
    filled.run(1);
    CHECK(hulls_told(filled) == 1);
    CHECK(filled.vec("ball", "position").z == doctest::Approx(0.6));

    Scene hollow(scene(tub(false, "surface_collides='true'"), "Static"));
    REQUIRE_MESSAGE(hollow.loaded(), hollow.error());
    hollow.keep_events = true;
    hollow.run(1);
    CHECK(hulls_told(hollow) == 0);
    CHECK(hollow.vec("ball", "position").z == doctest::Approx(0.1));
}

TEST_CASE("nothing is told of a closed convex mesh, nor of one that moves, which collides as its hull anyway")
{
    for (const auto& [mesh, state] : {std::pair(tub(true, ""), "Static"), std::pair(tub(false, "hull_collides='false'"), "Static"),
                                      std::pair(tub(false, ""), "RigidBody' mass='5' inertia='1 1 1")})
    {
        Scene s(scene(mesh, state));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.run(0.1);
        CHECK(hulls_told(s) == 0);
    }
}

}  // namespace
}  // namespace plab::test
