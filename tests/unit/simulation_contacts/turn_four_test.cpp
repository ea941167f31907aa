// Four bodies that turn freely at once turn as they would one after the other, bit for bit.
#include <doctest/doctest.h>

#include <random>

#include "plab/rotation.h"
#include "simulation/contacts/kicked_bodies.h"
#include "simulation/contacts/turn_four.h"

using namespace plab;
using namespace plab::simulation;

namespace
{

constexpr double kTime = 1.0 / 240;

/// Bodies with spins of random directions, at most `most` rad/s; cubes, or boxes with inertias about axes that are not theirs.
Bodies spinning_bodies(int count, bool cubes, double most)
{
    std::mt19937 random{11};
    const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
    const auto direction = [&] { return normalized(Vec3{draw(-1, 1), draw(-1, 1), draw(-1, 1)}); };
    Bodies b;
    for (int i = 0; i < count; ++i)
    {
        const Mat3 R = rotation_matrix(exp_rotation(direction() * draw(0, 3)));
        const Mat3 I = cubes ? Mat3::diagonal(0.4, 0.4, 0.4) : R * Mat3::diagonal(0.2, 0.5, 0.6) * transposed(R);
        b.motion.push_back(Motion::Dynamic), b.position.push_back({}), b.velocity.push_back({});
        b.orientation.push_back(exp_rotation(direction() * draw(0, 3)));
        b.mass.push_back(1), b.inverse_mass.push_back(1), b.needle.push_back(0);
        b.inertia_B.push_back(I), b.inverse_inertia_B.push_back(inverse(I));
        b.center_B.push_back({}), b.material.push_back(0), b.shapes.push_back({});
        b.angular_velocity.push_back({}), b.angular_momentum.push_back(direction() * draw(0, 0.2 * most));
        b.refresh_spin(static_cast<std::uint32_t>(i));
    }
    return b;
}

void check_same_turn(Bodies four, std::uint32_t first)
{
    Bodies one = four;
    for (std::uint32_t b = first; b < first + 4; ++b) turn_freely(one, b, {}, kTime);
    REQUIRE(turn_four(four, {first, first + 1, first + 2, first + 3}, kTime));
    CHECK(four.orientation == one.orientation);
    CHECK(four.angular_velocity == one.angular_velocity);
}

}  // namespace

TEST_CASE("cubes that turn by up to half a radian")
{
    Bodies bodies = spinning_bodies(64, true, 100);
    bodies.angular_momentum[5] = bodies.angular_velocity[5] = {};  // this one keeps its bits
    for (std::uint32_t first = 0; first < 64; first += 4) check_same_turn(bodies, first);
    const Quat before = bodies.orientation[5];
    CHECK(turn_four(bodies, {4, 5, 6, 7}, kTime));
    CHECK(bodies.orientation[5] == before);
    CHECK(bodies.orientation[6] != spinning_bodies(64, true, 100).orientation[6]);
}

TEST_CASE("boxes that turn slowly")
{
    const Bodies bodies = spinning_bodies(64, false, 0.02);
    for (std::uint32_t first = 0; first < 64; first += 4) check_same_turn(bodies, first);
}

TEST_CASE("what needs more than a series is left alone")
{
    Bodies fast = spinning_bodies(4, true, 1), mixed = spinning_bodies(4, false, 0.02), needle = mixed;
    fast.angular_momentum[2] = {0, 0, 200};  // 2 rad
    mixed.inverse_inertia_B[1] = Mat3::identity();
    needle.needle[3] = 1;
    const Bodies quick = spinning_bodies(4, false, 100);
    for (const Bodies& bodies : {fast, mixed, needle, quick})
    {
        Bodies turned = bodies;
        CHECK(!turn_four(turned, {0, 1, 2, 3}, kTime));
        CHECK(turned.orientation == bodies.orientation);
        CHECK(turned.angular_velocity == bodies.angular_velocity);
    }
}
