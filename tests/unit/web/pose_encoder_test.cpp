#include "web/pose_encoder.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

using namespace plab::web;

namespace
{

struct MadeFrame
{
    std::vector<plab_v2_BodyState> bodies;
    std::vector<plab_v2_ShaftState> shafts;
    plab_v2_Frame frame{};

    explicit MadeFrame(std::uint32_t count) : bodies(count), shafts(2)
    {
        for (std::uint32_t i = 0; i < count; ++i)
        {
            bodies[i].handle = 100 + i;
            bodies[i].position = {0.1 * i, 2, 3};
            bodies[i].orientation = {0.5, -0.5, 0.5, 0.5};
            bodies[i].linear_velocity = {1, 2, 3};
        }
        shafts[0] = {7, 1e6 + 0.25, 40}, shafts[1] = {8, -1, 2};
        frame.run = 3, frame.revision = 4, frame.step = 5, frame.time = 1.5, frame.stamp_ns = 1'000'000'000;
    }
    const plab_v2_Frame& view()
    {
        frame.bodies = {static_cast<std::uint32_t>(bodies.size()), static_cast<std::uint32_t>(bodies.size()), bodies.data(), false};
        frame.shafts = {static_cast<std::uint32_t>(shafts.size()), static_cast<std::uint32_t>(shafts.size()), shafts.data(), false};
        return frame;
    }
};

template <class T>
T number_at(const Message& message, std::size_t offset)
{
    T out{};
    REQUIRE(offset + sizeof out <= message.size());
    std::memcpy(&out, message.content() + offset, sizeof out);
    return out;
}

}  // namespace

TEST_CASE("a key frame has all poses, at the places that README.md states")
{
    MadeFrame made(40);
    PoseEncoder encoder;
    const Poses poses = encoder.encode(made.view(), {102});
    REQUIRE(poses.key != nullptr);
    CHECK(poses.delta == nullptr);
    const Message& m = *poses.key;
    CHECK(m.is_binary());
    CHECK(number_at<std::uint8_t>(m, 0) == 1);
    CHECK(number_at<std::uint32_t>(m, 4) == 3);
    CHECK(number_at<double>(m, 8) == 1.5);
    CHECK(number_at<double>(m, 16) == 1000.0);
    CHECK(number_at<double>(m, 24) == 5.0);
    CHECK(number_at<std::uint32_t>(m, 40) == 4);
    CHECK(number_at<std::uint32_t>(m, 44) == 40);
    CHECK(number_at<std::uint32_t>(m, 48) == 2);
    CHECK(number_at<std::uint32_t>(m, 52) == 1);
    CHECK(number_at<std::uint32_t>(m, 56 + 4 * 39) == 139);
    const std::size_t positions = 56 + 4 * 40, rotations = positions + 12 * 40, shafts = rotations + 8 * 40;
    CHECK(number_at<float>(m, positions + 12 * 39) == static_cast<float>(0.1 * 39));
    CHECK(number_at<std::int16_t>(m, rotations + 8 * 39 + 2) == -16384);
    CHECK(number_at<std::uint32_t>(m, shafts + 4) == 8);
    // An angle that grows forever keeps its digits.
    const std::size_t angles = (shafts + 8 + 7) / 8 * 8;
    CHECK(number_at<double>(m, angles) == 1e6 + 0.25);
    CHECK(number_at<double>(m, angles + 24) == 2.0);
    CHECK(number_at<std::uint32_t>(m, angles + 32) == 102);
    CHECK(number_at<double>(m, angles + 40) == 0.1 * 2);
    CHECK(number_at<double>(m, angles + 40 + 8 * 7) == 1.0);
    CHECK(m.size() == angles + 40 + 13 * 8);
}

TEST_CASE("a delta has what moved since its key frame, and a moment later everything is sent again")
{
    MadeFrame made(100);
    PoseEncoder encoder;
    const Poses first = encoder.encode(made.view(), {});
    made.frame.stamp_ns += 16'000'000;
    made.bodies[42].position.z = 9;
    const Poses second = encoder.encode(made.view(), {});
    CHECK(second.key == first.key);
    REQUIRE(second.delta != nullptr);
    CHECK(number_at<std::uint8_t>(*second.delta, 0) == 2);
    CHECK(number_at<std::uint32_t>(*second.delta, 44) == 1);
    CHECK(number_at<std::uint32_t>(*second.delta, 56) == 42);  // the place in the key frame
    CHECK(number_at<float>(*second.delta, 60 + 8) == 9.0F);
    CHECK(second.delta->size() < first.key->size() / 10);
    // Back at where the key frame has it: the delta has nothing.
    made.bodies[42].position.z = 3;
    CHECK(number_at<std::uint32_t>(*encoder.encode(made.view(), {}).delta, 44) == 0);
    made.frame.stamp_ns += 1'000'000'000;
    CHECK(encoder.encode(made.view(), {}).delta == nullptr);
}

TEST_CASE("another run, another set of bodies and a scene that moves as a whole begin with a key frame")
{
    MadeFrame made(100);
    PoseEncoder encoder;
    (void)encoder.encode(made.view(), {});
    SUBCASE("run") { made.frame.run = 9; }
    SUBCASE("revision") { made.frame.revision = 9; }
    SUBCASE("bodies") { made.bodies.pop_back(); }
    SUBCASE("another body at the same place") { made.bodies[3].handle = 9999; }
    SUBCASE("shafts") { made.shafts.pop_back(); }
    SUBCASE("all move")
    {
        for (auto& body : made.bodies) body.position.x += 1;
    }
    const Poses poses = encoder.encode(made.view(), {});
    CHECK(poses.delta == nullptr);
    CHECK(poses.key_number == 2);
}

TEST_CASE("numbers that are not finite do not leave")
{
    MadeFrame made(40);
    made.bodies[0].position = {std::nan(""), HUGE_VAL, -HUGE_VAL};
    made.bodies[0].orientation.w = std::nan("");
    PoseEncoder encoder;
    const Poses poses = encoder.encode(made.view(), {});
    for (std::size_t i = 0; i < 3; ++i) CHECK(number_at<float>(*poses.key, 56 + 160 + 4 * i) == 0.0F);
}
