// A bicycle that rides itself, against the eigenvalues of its linear equations: the benchmark of J. Meijaard, J. Papadopoulos, A. Ruina,
// A. Schwab, Linearized dynamics equations for the balance and steer of a bicycle, Proc. R. Soc. A 463 (2007) 1955. Four bodies, three
// hinges and two wheels that roll without slip, as knife edges; x is ahead, z up.
#include <array>
#include <complex>
#include <numbers>
#include <vector>

#include "support/gravity.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kRideSpeed = 5;  // m/s

/// It stands upright and falls over the line on which it rides with 1e-4 rad/s, so that lean stays small enough to be linear to 1e-8.
std::string bicycle(const std::string& solver)
{
    constexpr double kLean = 1e-4, kRear = 0.3, kFront = 0.35, kBase = 1.02, kTrail = 0.08;
    const auto part = [&](const char* id, double mass, const char* inertia, const Vec3& at, double radius)
    {
        const Vec3 velocity = Vec3{kRideSpeed, 0, 0} + cross({kLean, 0, 0}, at);
        return body(id, text(mass), inertia, text(at),
                    "linear_velocity='" + text(velocity) + "' angular_velocity='" +
                        text(Vec3{kLean, radius > 0 ? kRideSpeed / radius : 0.0, 0}) + "'");
    };
    const auto wheel = [](const char* id, const char* b, double radius) {
        return joint(id, "Rolling", "", b, "semi_axes='" + text(Vec3{radius, 1e-9, radius}) + "'");
    };
    const auto hinge = [](const char* id, const char* a, const char* b, const Vec3& anchor, const Vec3& axis)
    { return joint(id, "Hinge", a, b, "anchor='" + text(anchor) + "' axis='" + text(axis) + "'"); };
    const double tilt = std::numbers::pi / 10;
    return solver_is(solver) + gravity() + part("rear", 2, "0.0603 0.12 0.0603 0 0 0", {0, 0, kRear}, kRear) +
           part("frame", 85, "9.2 11 2.8 0 -2.4 0", {0.3, 0, 0.9}, 0) +
           part("fork", 4, "0.05892 0.06 0.00708 0 0.00756 0", {0.9, 0, 0.7}, 0) +
           part("front", 3, "0.1405 0.28 0.1405 0 0 0", {kBase, 0, kFront}, kFront) +
           hinge("rear_axle", "frame", "rear", {0, 0, kRear}, {0, 1, 0}) +
           hinge("front_axle", "fork", "front", {kBase, 0, kFront}, {0, 1, 0}) +
           hinge("steer", "frame", "fork", {kBase + kTrail, 0, 0}, {-std::sin(tilt), 0, std::cos(tilt)}) +
           wheel("rear_rolls", "rear", kRear) + wheel("front_rolls", "front", kFront);
}

/// Lean of the frame every 0.1 s, rad.
std::vector<double> ride(const std::string& solver, int per_second)
{
    Scene s(bicycle(solver), dt(per_second));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    std::vector<double> out;
    for (int i = 0; i <= 40; ++i)
    {
        s.run(0.1 * i);
        const Quat q = s.quat("frame", "orientation");
        out.push_back(std::atan2(2 * (q.w * q.x + q.y * q.z), 1 - 2 * (q.x * q.x + q.y * q.y)));
    }
    return out;
}

/// What is left of samples that are a sum of four exponentials, after the filter whose zeros these are; relative to the largest sample.
double beside_modes(const std::vector<double>& samples)
{
    constexpr double kInterval = 0.1;  // s
    // 1/s, at 5 m/s (table 2 there): weave, capsize and castering.
    const std::array<std::complex<double>, 4> modes{
        {{-0.77534188219585, 4.46486771378823}, {-0.77534188219585, -4.46486771378823}, {-0.32286642900409, 0}, {-14.07838969279822, 0}}};
    std::array<std::complex<double>, 5> filter{1};
    for (const auto& mode : modes)
        for (std::size_t k = 4; k > 0; --k) filter[k] -= std::exp(mode * kInterval) * filter[k - 1];
    double most = 0, left = 0;
    for (const double x : samples) most = std::fmax(most, std::fabs(x));
    for (std::size_t i = 4; i < samples.size(); ++i)
    {
        double sum = 0;
        for (std::size_t k = 0; k < filter.size(); ++k) sum += filter[k].real() * samples[i - k];
        left = std::fmax(left, std::fabs(sum));
    }
    return left / most;
}

}  // namespace

TEST_CASE("a bicycle at 5 m/s sways with the modes of its linear equations, and stays up")
{
    for (const char* solver : {"RungeKutta4", "Automatic"})
    {
        CAPTURE(std::string(solver));
        const std::vector<double> lean = ride(solver, 240), coarse = ride("RungeKutta4", 120);
        MESSAGE(std::string(solver), ": ", beside_modes(lean), " at 1/240 s, RungeKutta4 ", beside_modes(coarse), " at 1/120 s");
        CHECK(beside_modes(lean) < 1e-7);
        CHECK(beside_modes(coarse) > 8 * beside_modes(lean));
        CHECK(std::fabs(lean.back()) < 1e-4);
    }
}
