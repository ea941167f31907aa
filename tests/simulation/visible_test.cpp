// Levels of detail are never seen: what is in a picture has its level already, and a change of level is less than half a pixel.
#include <algorithm>
#include <functional>

#include "support/scene.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::Scene;

namespace
{

constexpr double kBounds[] = {20, 60};  // pixels

/// 144 weights on springs, through which a viewer flies while it turns.
Scene field()
{
    std::string text =
        "<component id='ball' type='Shape/Sphere' radius='0.3'/><component id='gravity' type='Field/Gravity' between='*'/>"
        "<component id='drone' type='State/Kinematic' position='-12 15 2' linear_velocity='6 0 0' angular_velocity='0 0 0.4'/>"
        "<component id='eye' type='Viewer/Attached' body='drone'/>"
        "<component id='lod' type='Governor/Visibility' watches='bob.*.solver' pixels='20 60' every='0.1' dwell='0.3' "
        "levels='Solver/SemiImplicitEuler; Solver/RungeKutta4; Solver/DormandPrince54'/>";
    for (int i = 0; i < 144; ++i)
    {
        const std::string id = std::to_string(i), x = std::to_string(3 * (i % 12)), y = std::to_string(3 * (i / 12));
        text += "<component id='post." + id + "' type='State/Static' position='" + x + " " + y + " 3.5'/>";
        text += "<component id='bob." + id + "' type='State/RigidBody' mass='1' shape='ball' position='" + x + " " + y +
                " 2.5' linear_velocity='1 0.5 0' solver='Solver/RungeKutta4'/>";
        text += "<component id='spring." + id + "' type='Constraint/SpringDamper' a='post." + id + "' b='bob." + id +
                "' length='1' stiffness='400'/>";
    }
    return Scene(text, "dt='1/120'");
}

/// Where a point is in the picture: pixels from its middle, and m along the optical axis.
struct Place
{
    double right = 0, up = 0, depth = 0;
    bool in(const Viewpoint& eye) const { return depth > 0.05 && std::fabs(right) <= 0.5 * eye.width && std::fabs(up) <= 0.5 * eye.height; }
};

Place place_of(const Vec3& p, const Viewpoint& eye)
{
    const Vec3 d = p - eye.position, right = normalized(cross(eye.direction, eye.up)), up = cross(right, eye.direction);
    const double depth = dot(d, eye.direction), scale = 0.5 * eye.height / std::tan(0.5 * eye.field_of_view) / depth;
    return {scale * dot(d, right), scale * dot(d, up), depth};
}

/// Some point of the ball is in the picture.
bool is_seen(const Vec3& center, double radius, const Viewpoint& eye)
{
    for (int k = -1; k < 6; ++k)
    {
        Vec3 p = center;
        if (k >= 0) p[k / 2] += k % 2 == 0 ? radius : -radius;
        if (place_of(p, eye).in(eye)) return true;
    }
    return false;
}

Vec3 position(const Simulation& s, const std::string& id)
{
    const world::World& world = s.world();
    return world.host().bodies.position[world.component(world.find(id)).host_index];
}

}  // namespace

TEST_CASE("an object has the level that its picture asks for before it is in the picture")
{
    Scene s = field();
    REQUIRE_MESSAGE(s.loaded(), s.error());
    int seen = 0, finest = 0;
    std::vector<bool> before(144);
    int entered = 0;
    for (int k = 0; k < 900; ++k)
    {
        s.step();
        const Viewpoint eye = s.simulation().viewpoints().front();
        for (const LevelInfo& l : s.simulation().levels().levels())
        {
            const std::string solver = s.simulation().world().id_of(l.component), id = solver.substr(0, solver.rfind('.'));
            const Vec3 center = position(s.simulation(), id);
            const auto index = static_cast<std::size_t>(std::stoi(id.substr(4)));
            const bool is = is_seen(center, 0.3, eye);
            entered += is && !before[index] ? 1 : 0, before[index] = is;
            if (!is) continue;
            const double distance = length(center - eye.position);
            const double pixels = distance > 0.3 ? 0.6 / distance * 0.5 * eye.height / std::tan(0.5 * eye.field_of_view) : 1e9;
            const auto wanted = std::count_if(std::begin(kBounds), std::end(kBounds), [&](double b) { return pixels > b; });
            ++seen, finest += wanted == 2 ? 1 : 0;
            CHECK_MESSAGE(l.level >= wanted, id, " at step ", k, ": ", pixels, " pixels");
        }
    }
    CHECK(seen > 10000);
    CHECK(finest > 1000);
    CHECK(entered > 100);
}

namespace
{

/// A wall that ends at y = 0, and an eye close to it that flies beyond its edge: what is far behind comes out much faster than the eye
/// moves.
Scene behind_a_wall(const std::string& wall, const std::string& eye)
{
    std::string text =
        "<component id='ball' type='Shape/Sphere' radius='0.3'/><component id='slab' type='Shape/Box' half_extents='0.1 20 20'/>"
        "<component id='wall' shape='slab' " +
        wall + "/><component id='drone' type='State/Kinematic' " + eye +
        "/><component id='eye' type='Viewer/Attached' body='drone'/>"
        "<component id='lod' type='Governor/Visibility' watches='bob.*.solver' pixels='5 10' every='0.05' dwell='0.1' look_ahead='0.2' "
        "occluders='wall' levels='Solver/SemiImplicitEuler; Solver/RungeKutta4; Solver/DormandPrince54'/>";
    for (int i = 0; i < 40; ++i)
        text += "<component id='bob." + std::to_string(i) + "' type='State/RigidBody' mass='1' shape='ball' position='14 " +
                std::to_string(0.5 * (i - 20)) + " 0' solver='Solver/RungeKutta4'/>";
    return Scene(text, "dt='1/120'");
}

/// Of the balls that no wall hides from the eye, how many there were, and how many lacked the most exact level. The wall reaches to y =
/// edge.
std::pair<int, int> unhidden(Scene& s, const std::function<double()>& edge)
{
    int seen = 0, wrong = 0;
    for (int k = 0; k < 240; ++k)
    {
        s.step();
        const Viewpoint eye = s.simulation().viewpoints().front();
        for (const LevelInfo& l : s.simulation().levels().levels())
        {
            const std::string solver = s.simulation().world().id_of(l.component), id = solver.substr(0, solver.rfind('.'));
            const Vec3 p = position(s.simulation(), id);
            const double share = (1.1 - eye.position.x) / (p.x - eye.position.x), y = eye.position.y + share * (p.y - eye.position.y);
            if (y <= edge() || !is_seen(p, 0.3, eye)) continue;
            ++seen, wrong += l.level == 2 ? 0 : 1;
        }
    }
    return {seen, wrong};
}

}  // namespace

TEST_CASE("what comes out from behind a wall has its level before it is seen, however near to the wall the eye is")
{
    Scene s = behind_a_wall("type='State/Static' position='1 -20 0'", "position='0 -1 0' linear_velocity='0 1.5 0'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const auto [seen, wrong] = unhidden(s, [] { return 0.0; });
    CHECK(seen > 1000);
    CHECK(wrong == 0);
}

TEST_CASE("a wall that moves hides nothing")
{
    Scene s = behind_a_wall("type='State/Kinematic' position='1 -20 0' linear_velocity='0 -2 0'", "position='0 -1 0'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const auto [seen, wrong] = unhidden(s, [&] { return position(s.simulation(), "wall").y + 20; });
    CHECK(seen > 1000);
    CHECK(wrong == 0);
}

TEST_CASE("the jump in the picture of an object that changes its level is below half a pixel")
{
    Scene s = field();
    REQUIRE_MESSAGE(s.loaded(), s.error());
    Simulation old(test::library());
    old.let_decide(false);
    int changes = 0;
    double largest = 0;
    for (int k = 0; k < 900; ++k)
    {
        const Snapshot boundary = s.simulation().capture();
        s.keep_events = true, s.events.clear();
        s.step();
        if (s.count("level.changed") == 0) continue;
        REQUIRE(old.restore(boundary).ok());
        REQUIRE(old.step_once());  // the same step with the old levels
        const Viewpoint eye = s.simulation().viewpoints().front();
        for (const Event& e : s.events)
        {
            if (e.kind != "level.changed") continue;
            const std::string solver = s.simulation().world().id_of(e.component), id = solver.substr(0, solver.rfind('.'));
            const Vec3 now = position(s.simulation(), id);
            if (!is_seen(now, 0.3, eye)) continue;
            const Place with_new = place_of(now, eye), with_old = place_of(position(old, id), eye);
            ++changes;
            largest = std::max(largest, std::hypot(with_new.right - with_old.right, with_new.up - with_old.up));
        }
    }
    MESSAGE("largest jump ", largest, " pixels, of ", changes, " changes");
    CHECK(changes > 50);
    CHECK(largest > 0);
    CHECK(largest < 0.5);
}
