// Many viewers at once: the one that sees an object best counts, whoever comes and goes.
#include "simulation/governed.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::kLadder;
using plab::test::level;
using plab::test::Scene;

namespace
{

/// Ten bodies in a row along x, 10 m apart.
std::string row(const std::string& governor)
{
    std::string out = "<component id='ball' type='Shape/Sphere' radius='0.5'/>";
    for (int k = 0; k < 10; ++k)
        out += "<component id='b" + std::to_string(k) + "' type='State/RigidBody' mass='1' shape='ball' position='" +
               std::to_string(10 * k) + " 0 0' solver='Solver/RungeKutta4'/>";
    return out + "<component id='lod' watches='*.solver' every='0.05' dwell='0' look_ahead='0' levels='" + kLadder + "' " + governor + "/>";
}

std::string eye(const std::string& id, double x, const std::string& more = "direction='0 1 0'")
{
    return "<component id='" + id + "' type='Viewer/Free' position='" + std::to_string(x) + " -3 0' " + more + "/>";
}

/// The level of each body, in their order.
std::string levels_of(const Scene& s)
{
    const auto levels = s.simulation().levels().levels();
    std::string out;
    for (int k = 0; k < 10; ++k) out += std::to_string(level(levels, s, "b" + std::to_string(k) + ".solver").level);
    return out;
}

}  // namespace

TEST_CASE("by distance: each object follows the viewer that is nearest to it, and the reason names that one")
{
    Scene s(row("type='Governor/Distance' distances='4 12'") + eye("left", 0) + eye("middle", 50) + eye("right", 90));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    CHECK(levels_of(s) == "2100121012");
    const auto levels = s.simulation().levels().levels();
    CHECK(level(levels, s, "b5.solver").reason.ends_with("from middle"));
    CHECK(level(levels, s, "b9.solver").reason.ends_with("from right"));
    REQUIRE(s.ask(RemoveOperation{"middle"}).done);
    s.run(0.2);
    CHECK(levels_of(s) == "2100000012");
    for (const char* id : {"left", "right"}) REQUIRE(s.ask(RemoveOperation{id}).done);
    s.run(0.4);
    CHECK(levels_of(s) == "0000000000");
}

TEST_CASE("by sight: sixty viewers, each of which sees one object, and what none of them sees is cheap")
{
    std::string text = row("type='Governor/Visibility' pixels='20 60' margin='0'");
    for (int k = 0; k < 60; ++k)
    {
        // All stand before one of the first five bodies; every other one looks away.
        const int body = k % 5;
        text += eye("eye" + std::to_string(k), 10 * body, k % 2 == 0 || body == 3 ? "direction='0 -1 0'" : "direction='0 1 0'");
    }
    Scene s(text);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    CHECK(levels_of(s).substr(0, 3) == "222");
    CHECK(levels_of(s)[3] < '2');  // all before it look away, and the others see it from 10 m to the side, if at all
    CHECK(levels_of(s)[4] == '2');
    CHECK(levels_of(s).substr(7) == "000");
    CHECK(std::get<std::int64_t>(s.get("lod", "in_view")) >= 4);
}
