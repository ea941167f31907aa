// What a viewer sees of a ball, against closed forms and against rays.
#include "interactions/governors/sight.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "plab/random.h"

using namespace plab;
using namespace plab::governors;

namespace
{

constexpr double kPi = std::numbers::pi;

Viewpoint eye_at_origin()
{
    Viewpoint eye;
    eye.direction = {1, 0, 0}, eye.up = {0, 0, 1}, eye.field_of_view = kPi / 2, eye.width = 2000, eye.height = 1000;
    return eye;
}

class Dice
{
public:
    double between(double low, double high)
    {
        state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
        return low + (high - low) * static_cast<double>(state_ >> 11) * 0x1p-53;
    }
    Vec3 vector(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }

private:
    std::uint64_t state_ = 7;
};

/// Whether the segment from a to b meets the box.
bool meets(const Vec3& a_W, const Vec3& b_W, const Occluder& box)
{
    const Vec3 a = rotate_back(box.pose.q, a_W - box.pose.p), d = rotate_back(box.pose.q, b_W - a_W);
    double from = 0, to = 1;
    for (int k = 0; k < 3; ++k)
    {
        if (d[k] == 0)
        {
            if (std::fabs(a[k]) > box.half[k]) return false;
            continue;
        }
        const double s = (-box.half[k] - a[k]) / d[k], t = (box.half[k] - a[k]) / d[k];
        from = std::max(from, std::min(s, t)), to = std::min(to, std::max(s, t));
    }
    return from <= to;
}

}  // namespace

TEST_CASE("the size of a picture: at right angles of view, 1 m at 1 m fills half of the height")
{
    const Viewpoint eye = eye_at_origin();
    CHECK(pixels_of(eye, {{10, 0, 0}, 1}) == doctest::Approx(100).epsilon(1e-12));
    CHECK(std::isinf(pixels_of(eye, {{0.5, 0, 0}, 1})));
    CHECK(distance_to(eye, {{0, 3, 4}, 2}) == doctest::Approx(3).epsilon(1e-15));
    CHECK(distance_to(eye, {{0, 1, 0}, 2}) == 0);
}

TEST_CASE("the pyramid of sight: the edges are at 45 degrees upwards and at atan 2 sideways")
{
    const Viewpoint eye = eye_at_origin();
    const double slack = 1e-9;
    // A ball of radius r touches the upper plane from outside if its centre is r above it.
    const double r = 0.5, x = 3;
    CHECK(is_in_view(eye, {{x, 0, x + r * std::sqrt(2.0) - slack}, r}));
    CHECK_FALSE(is_in_view(eye, {{x, 0, x + r * std::sqrt(2.0) + slack}, r}));
    CHECK(is_in_view(eye, {{x, 2 * x + r * std::sqrt(5.0) - slack, 0}, r}));
    CHECK_FALSE(is_in_view(eye, {{x, -(2 * x + r * std::sqrt(5.0) + slack), 0}, r}));
    CHECK_FALSE(is_in_view(eye, {{-2, 0, 0}, 1}));
    const Viewpoint wide = widened(eye, 0.1);
    CHECK(is_in_view(wide, {{x, 0, x * std::tan(kPi / 4 + 0.1 - slack)}, 0}));
    CHECK_FALSE(is_in_view(wide, {{x, 0, x * std::tan(kPi / 4 + 0.1 + slack)}, 0}));
    CHECK(is_in_view(wide, {{x, x * std::tan(std::atan(2.0) + 0.1 - slack), 0}, 0}));
    CHECK_FALSE(is_in_view(wide, {{x, x * std::tan(std::atan(2.0) + 0.1 + slack), 0}, 0}));
}

TEST_CASE("a box hides a ball only if no ray from the eye reaches it, and hides what is well within its shadow")
{
    Dice dice;
    int hidden = 0, seen = 0;
    for (int n = 0; n < 4000; ++n)
    {
        const Quat q = normalized(Quat{dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1)});
        const Occluder box{{dice.vector(1), q}, {dice.between(0.5, 3), dice.between(0.5, 3), dice.between(0.5, 3)}};
        const Vec3 eye = dice.vector(6);
        const Ball ball{dice.vector(8), dice.between(0.01, 1)};
        int reached = 0;
        constexpr int kRays = 200;
        for (int k = 0; k < kRays; ++k)
        {
            const Vec3 to = ball.center + ball.radius * normalized(dice.vector(1));
            reached += meets(eye, to, box) ? 0 : 1;
        }
        const bool is_gone = is_hidden(eye, ball, box);
        if (is_gone) CHECK(reached == 0);
        hidden += is_gone ? 1 : 0, seen += !is_gone && reached > 0 ? 1 : 0;
        // A point directly behind the centre of the box.
        const Vec3 behind = eye + (box.pose.p - eye) * 1.0001 + normalized(box.pose.p - eye) * length(box.half);
        const Vec3 local = rotate_back(q, eye - box.pose.p);
        const bool inside = std::fabs(local.x) <= box.half.x && std::fabs(local.y) <= box.half.y && std::fabs(local.z) <= box.half.z;
        CHECK(is_hidden(eye, {behind, 1e-6}, box) == !inside);
    }
    CHECK(hidden > 100);
    CHECK(seen > 1000);
}
