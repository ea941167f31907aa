// Random swaps of every family while gears turn and balls bounce: nothing may be lost or leak, and invariants hold.
#include "plab/random.h"
#include "support/scene.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::Scene;

namespace
{

const char* const kStorm = R"(
  <component id="motor" type="State/Shaft" inertia="1" angular_velocity="4"/><component id="wheel" type="State/Shaft" inertia="2"/>
  <component id="gear" type="Constraint/AngularVelocity/Graph" driver="motor" driven="wheel" velocity_factor="-0.5"/>
  <component id="s" type="Shape/Sphere" radius="0.1"/><component id="floor" type="Shape/Plane"/>
  <component id="ground" type="State/Static" shape="floor"/>
  <repeat id="balls" count="3" step="0.5 0 0.2"><component id="ball" type="State/RigidBody" mass="1" shape="s" position="0 0 0.6"/></repeat>
  <component id="gravity" type="Field/Gravity" between="balls"/>
  <component id="drag" type="Field/Drag" between="balls" linear="0.01"/>
  <component id="wind" type="Script/Lua" driven="ball.0"><param name="state"><entry name="n">0</entry></param>
    <param name="code">function drive(step) state.n = state.n + 1 end function force(t, state) driven:add_force(vec(0.1, 0, 0)) end</param></component>
  <component id="contact" type="CDetection/ODE" between="balls" against="ground" resolution="Resolution/LocalBisection" response="Response/Impulse"
             response.restitution="0.8"/>)";

}  // namespace

TEST_CASE("five hundred random swaps")
{
    Scene s(std::string(kStorm), "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    std::vector<std::string> types = test::library().names(), ids;
    for (const std::uint32_t i : s.simulation().world().in_id_order())
        if (s.simulation().world().type_of(i)) ids.push_back(s.simulation().world().id_of(i));
    std::uint64_t seed = 2026;
    int done = 0, refused = 0;
    while (done < 500)
    {
        const std::string& id = ids[next_random(seed) % ids.size()];
        const model::ComponentType* now = s.simulation().world().type_of(s.simulation().world().find(id));
        // Mostly types of the same family, sometimes any.
        std::vector<std::string> choices;
        for (const std::string& t : types)
        {
            const auto type = test::library().require(t);
            REQUIRE(type.ok());
            if ((*type)->why_not_exchangeable(*now).empty() || next_random(seed) % 40 == 0) choices.push_back(t);
        }
        const std::uint64_t before = s.hash();
        const Reply reply = s.ask(SwapOperation{id, choices[next_random(seed) % choices.size()], {}});
        if (reply.done)
            ++done;
        else
        {
            ++refused;
            CHECK(s.hash() == before);
            CHECK(!reply.errors.empty());
        }
        s.step(static_cast<std::int64_t>(next_random(seed) % 3));
    }
    CHECK(refused > 0);
    CHECK(s.real("wind", "state.n") == static_cast<double>(s.simulation().tick()));
    for (const char* ball : {"ball.0", "ball.1", "ball.2"})
    {
        const Vec3 p = s.vec(ball, "position");
        CHECK(is_finite(p));
    }
    CHECK(std::isfinite(s.spin("wheel")));
}
