// Bodies that slide from one body to the next one, whose surface is flush: over tiles they move as over a plane, whatever rounding makes
// of the edges on their way.
#include <algorithm>
#include <cmath>

#include "plab/rotation.h"
#include "slide.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kTile = 0.37;  // m: places of tiles are rounded
constexpr int kTiles = 9;       // along each side
const std::string kResolutions[] = {"None", "Speculative", "Bisection", "LocalRoot", "ConservativeAdvancement", "Automatic"};

/// A frame in which the floor is level: its places are rounded in each coordinate. The tiles are bodies, or the parts of one body.
struct Floor
{
    Vec3 p;
    Quat q;
    bool one_body = false;
    Vec3 at(const Vec3& local) const { return p + rotate(q, local); }
};
const Quat kTurn{std::cos(0.55), 0.3 * std::sin(0.55), -0.4 * std::sin(0.55), std::sqrt(0.75) * std::sin(0.55)};
const Floor kWorld, kTurned{{0.3, -0.7, 0.2}, kTurn}, kOneBody{{}, {}, true}, kTurnedBody{{0.3, -0.7, 0.2}, kTurn, true};

std::string tile_ids()
{
    std::string ids;
    for (int i = 0; i < kTiles; ++i)
        for (int k = 0; k < kTiles; ++k) ids += (ids.empty() ? "tile" : " tile") + std::to_string(10 * i + k);
    return ids;
}

/// `higher`, m: of the tiles ahead of the middle.
std::string tiles(const Floor& floor, double higher = 0)
{
    std::string out = "<component id=\"tile\" type=\"Shape/Box\" half_extents=\"" + text(Vec3{0.5 * kTile, 0.5 * kTile, 0.1}) + "\"/>";
    const auto pose = [](const Vec3& p, const Quat& q) { return " position=\"" + text(p) + "\" orientation=\"" + text(q) + "\"/>"; };
    for (int i = 0; i < kTiles; ++i)
        for (int k = 0; k < kTiles; ++k)
        {
            const Vec3 place{(i - kTiles / 2) * kTile, (k - kTiles / 2) * kTile, -0.1 + (i > kTiles / 2 ? higher : 0)};
            out += "<component id=\"tile" + std::to_string(10 * i + k) +
                   (floor.one_body ? "\" type=\"Shape/Placed\" of=\"tile\"" + pose(place, {})
                                   : "\" type=\"State/Static\" shape=\"tile\"" + pose(floor.at(place), floor.q));
        }
    if (!floor.one_body) return out;
    return out + "<component id=\"floor.shape\" type=\"Shape/Compound\" parts=\"" + tile_ids() +
           "\"/><component id=\"floor\" type=\"State/Static\" shape=\"floor.shape\"" + pose(floor.p, floor.q);
}

struct Slide
{
    Vec3 from, velocity, spin;
    double friction = 0;
};

std::string slides(const std::string& shape, const Floor& floor, const Slide& m, const std::string& resolution)
{
    return shape + "<component id=\"a\" type=\"State/RigidBody\" shape=\"s\" mass=\"1\" position=\"" + text(floor.at(m.from)) +
           "\" orientation=\"" + text(floor.q) + "\" linear_velocity=\"" + text(rotate(floor.q, m.velocity)) + "\" angular_velocity=\"" +
           text(rotate(floor.q, m.spin)) + "\"/>" + gravity("a", rotate(floor.q, {0, 0, -kG})) +
           "<component id=\"contact\" type=\"CDetection/ODE\" between=\"a\" against=\"" + (floor.one_body ? "floor" : tile_ids()) +
           "\" resolution=\"Resolution/" + resolution + "\" response.friction=\"" + text(m.friction) + "\"/>";
}

const std::string kBrick = "<component id=\"s\" type=\"Shape/Box\" half_extents=\"0.1 0.08 0.06\"/>",
                  kPuck = "<component id=\"s\" type=\"Shape/Cylinder\" radius=\"0.1\" height=\"0.12\"/>",
                  kPrism =
                      "<component id=\"s\" type=\"Shape/ConvexHull\" points=\"0.1 0 -0.06 -0.05 0.08 -0.06 -0.05 -0.08 -0.06 "
                      "0.1 0 0.06 -0.05 0.08 0.06 -0.05 -0.08 0.06\"/>";

}  // namespace

TEST_CASE("a box slides over flush tiles as far as on a plane, slow or fast, wherever it starts")
{
    // The last one starts with its front flush with a seam.
    const Slide motions[] = {{{-1, -0.6, 0.06}, {2.5, 1.1, 0}, {}, 0.15},
                             {{-0.29, -0.1, 0.06}, {1e-3, 0, 0}, {}, 0},
                             {{-0.33, -0.1, 0.06}, {0.3, 0.1, 0}, {}, 0},
                             {{-0.285, -0.15, 0.06}, {1, 0.3, 0}, {}, 0}};
    for (const Floor& floor : {kWorld, kTurned, kOneBody, kTurnedBody})
        for (const std::string& resolution : kResolutions)
            for (const Slide& m : motions)
            {
                CAPTURE(resolution);
                CAPTURE(m.velocity.x);
                CAPTURE(floor.p.x);
                CAPTURE(floor.one_body);
                Scene s(tiles(floor) + slides(kBrick, floor, m, resolution), step_of(1.0 / 240));
                REQUIRE_MESSAGE(s.loaded(), s.error());
                s.run(0.6);
                const double speed = length(m.velocity), slowed = m.friction * kG;
                const Vec3 way = m.velocity * ((speed - 0.5 * slowed * 0.6) * 0.6 / speed);
                CHECK(distance(s.vec("a", "position"), floor.at(m.from + way)) < 1e-9);
                CHECK(near(length(s.vec("a", "linear_velocity")), speed - slowed * 0.6, 1e-9));
                CHECK(length(s.vec("a", "angular_velocity")) < 1e-8);
            }
}

TEST_CASE("bodies that spin on smooth tiles keep their speed and their spin over all seams")
{
    for (const Floor& floor : {kWorld, kOneBody})
        for (const std::string& shape : {kBrick, kPuck, kPrism})
            for (const std::string& resolution : kResolutions)
            {
                CAPTURE(shape);
                CAPTURE(resolution);
                CAPTURE(floor.one_body);
                const Slide m{{-1, -0.6, 0.06}, {2, 1, 0}, {0, 0, 9}, 0};
                Scene s(tiles(floor) + slides(shape, floor, m, resolution), step_of(1.0 / 240));
                REQUIRE_MESSAGE(s.loaded(), s.error());
                s.run(0.75);
                CHECK(distance(s.vec("a", "position"), m.from + 0.75 * m.velocity) < 1e-7);
                CHECK(distance(s.vec("a", "angular_velocity"), m.spin) < 1e-6);
            }
}

TEST_CASE("a tile that is a little higher stops a box")
{
    for (const Floor& floor : {kWorld, kOneBody})
        for (const std::string& resolution : kResolutions)
        {
            CAPTURE(resolution);
            CAPTURE(floor.one_body);
            const Slide m{{-0.3, 0, 0.06}, {1, 0, 0}, {}, 0};
            // What is less high than the box moves in a step lifts it, where nothing is located: also another part of what it lies on.
            Scene s(tiles(floor, resolution == "None" || floor.one_body ? 0.01 : 1e-5) + slides(kBrick, floor, m, resolution),
                    step_of(1.0 / 240));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(0.6);
            CHECK(s.vec("a", "position").x < 0.5 * kTile);
        }
}
