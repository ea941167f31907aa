// Series of impacts that depend on one another, with every algorithm (contact_algorithms.h): C6, C8 and C13 of the catalogue.
#include "impacts.h"

using namespace plab;
using namespace plab::test;

namespace
{
/// C6: number of missing or surplus collisions, and the relative change of energy.
std::array<double, 2> galperin(const Algorithm& algorithm, int k, double digits)
{
    const double heavy = std::pow(100.0, k);
    Scene s("<component id=\"wall.shape\" type=\"Shape/Plane\"/><component id=\"wall\" type=\"State/Static\" shape=\"wall.shape\"/>" +
                sphere("light", 0.5, at({0, 0, 1.5})) + sphere("heavy", 0.5, at({0, 0, 3}, {0, 0, -0.1}, heavy)) +
                contact("light heavy wall", algorithm, 1, 0, stiffness(algorithm, 1e6, 1e8)),
            "dt=\"0.1\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    s.run(300);
    return {std::fabs(static_cast<double>(s.count("contact.impact")) - digits),
            std::fabs(s.simulation().totals().kinetic / (0.005 * heavy) - 1)};
}
}  // namespace

TEST_CASE("C6: Galperin's balls with every algorithm: 3, 31, 314 collisions, and energy")
{
    // Speculative: the speed that closes a gap is subtracted from the approach, and restitution returns a share of the rest.
    constexpr Bound<6> table[] = {
        {"*", "Impulse", {0, 0, 0, 4e-15, 4e-15, 4e-15}},
        {"located", "Rows", {0, 0, 0, 1e-15, 1e-15, 1e-15}},
        {"None", "Rows/Direct", {0, 0, 0, 1e-15, 3e-15, 6e-15}},
        {"None", "Rows/SequentialImpulse", {0, 0, 0, 1e-15, 1e-15, 1.3e-14}},
        {"None", "Rows/SoftStep", {0, 0, 200, 1e-15, 1.2e-6, 1}, {0, 0, 60, 0, 0, 0.4}},
        {"Speculative", "Rows/Direct", {0, 0, 314, 1e-15, 0.44, 1}, {0, 0, 100, 0, 0.1, 0.5}},
        {"Speculative", "Rows/SequentialImpulse", {0, 0, 5200, 1e-15, 0.65, 1.01}, {0, 0, 1200, 0, 0.16, 0.9}},
        {"Speculative", "Rows/SoftStep", {0, 0, 200, 1e-15, 3e-7, 1}, {0, 0, 50, 0, 0, 0.4}},
        {"*", "Penalty", {0, 0, 1, 1.4e-10, 1.9e-9, 1.8e-8}},
        {"*", "HuntCrossley", {0, 0, 0, 6.3e-8, 5.1e-7, 4.3e-6}},
    };
    check_algorithms(every_algorithm(), table,
                     [](const Algorithm& algorithm)
                     {
                         const auto k0 = galperin(algorithm, 0, 3), k1 = galperin(algorithm, 1, 31), k2 = galperin(algorithm, 2, 314);
                         return std::array{k0[0], k1[0], k2[0], k0[1], k1[1], k2[1]};
                     });
}

namespace
{
/// C8: speeds after k of 5 balls have hit the others with 1 m/s; `gap` is the distance between the others.
std::array<double, 5> cradle(const Algorithm& algorithm, int k, double gap, std::vector<Event>* reported = nullptr)
{
    std::string balls, all;
    for (int i = 0; i < 5; ++i)
    {
        const std::string id = "b" + std::to_string(i);
        balls += sphere(id, 0.1, at({i * (0.2 + gap) - (i < k ? 0.1 : 0), 0, 0}, {i < k ? 1.0 : 0.0, 0, 0}));
        all += id + " ";
    }
    Scene s(balls + contact(all, algorithm, 1, 0, stiffness(algorithm, 1e8, 1e10)), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = s.warnings_expected = reported != nullptr;
    s.run(0.5);
    if (reported) *reported = s.events;
    std::array<double, 5> v{};
    for (std::size_t i = 0; i < 5; ++i) v[i] = s.vec("b" + std::to_string(i), "linear_velocity").x;
    return v;
}
/// k in, k out: the largest error of a speed; and those of momentum and energy.
std::array<double, 2> cradle_error(const Algorithm& algorithm, double gap)
{
    std::array<double, 2> worst{};
    for (int k = 1; k <= 3; ++k)
    {
        const auto v = cradle(algorithm, k, gap);
        double momentum = -k, energy = -k;
        for (std::size_t i = 0; i < 5; ++i)
        {
            worst[0] = std::max(worst[0], std::fabs(v[i] - (static_cast<int>(i) >= 5 - k ? 1 : 0)));
            momentum += v[i], energy += v[i] * v[i];
        }
        worst[1] = std::max({worst[1], std::fabs(momentum), std::fabs(energy)});
    }
    return worst;
}

/// Speeds of the first and of the last ball after one ball hit four that touch. Impulses, one pair after the other: k in, k out.
/// Rows at the ends of steps, all at once: the first contact separates at 1 m/s, the others do not separate. Springs: the chain's
/// own equations, m x'' = -k x+ or -k (x+)^1.5 between neighbours, by Runge-Kutta of order 4 with steps of 1e-5 (m / k)^(1/2),
/// which agree with 2e-5 to 1e-11.
std::array<double, 2> touching_law(const Algorithm& algorithm)
{
    if (algorithm.law() == "Penalty") return {-0.13227948471, 0.94240173339};
    if (algorithm.law() == "HuntCrossley") return {-0.0710850170861, 0.9887774241474};
    if (algorithm.rows() && !algorithm.locates()) return {-0.6, 0.4};
    return {0, 1};
}
}  // namespace

namespace
{
/// Balls connected by springs that only push, m = 1, the first at 1 m/s: x'' by k d^power of each overlap d > 0. Classical
/// Runge-Kutta.
std::array<double, 5> chain_speeds(double k, double power, double gap)
{
    constexpr double kStep = 2e-8, kEnd = 2e-3;  // s
    using State = std::array<double, 10>;        // displacements, speeds
    const auto rates = [&](const State& y)
    {
        State out{};
        for (std::size_t i = 0; i < 5; ++i) out[i] = y[5 + i];
        for (std::size_t i = 0; i < 4; ++i)
        {
            const double d = y[i] - y[i + 1] - (i == 0 ? 0 : gap);
            const double force = d > 0 ? k * (power == 1 ? d : d * std::sqrt(d)) : 0.0;
            out[5 + i] -= force, out[6 + i] += force;
        }
        return out;
    };
    const auto ahead = [](const State& y, double h, const State& r)
    {
        State out = y;
        for (std::size_t i = 0; i < y.size(); ++i) out[i] += h * r[i];
        return out;
    };
    State y{};
    y[5] = 1;
    for (double t = 0; t < kEnd; t += kStep)
    {
        const State a = rates(y), b = rates(ahead(y, kStep / 2, a)), c = rates(ahead(y, kStep / 2, b)), d = rates(ahead(y, kStep, c));
        for (std::size_t i = 0; i < y.size(); ++i) y[i] += kStep / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    }
    return {y[5], y[6], y[7], y[8], y[9]};
}
std::vector<Algorithm> without_springs()
{
    std::vector<Algorithm> out = every_algorithm();
    std::erase_if(out, [](const Algorithm& algorithm) { return algorithm.springs(); });
    return out;
}
}  // namespace

TEST_CASE("C8: springs across gaps of 1e-6 m: a resting ball is detected when it is hit, and hits the next one")
{
    for (const char* law : {"Penalty", "HuntCrossley"})
    {
        CAPTURE(std::string(law));
        const bool linear = std::string_view(law) == "Penalty";
        std::vector<Event> reported;
        const auto found = cradle({"None", law}, 1, 1e-6, &reported);
        const auto expected = chain_speeds(linear ? 1e8 : 1e10, linear ? 1 : 1.5, 1e-6);
        for (std::size_t i = 0; i < 5; ++i) CHECK(std::fabs(found[i] - expected[i]) < 1e-7);
        CHECK(std::none_of(reported.begin(), reported.end(), [](const Event& e) { return e.kind == "contact.missed"; }));
    }
}

TEST_CASE("C8: Newton's cradle with every algorithm: k in, k out; with gaps of 1e-6 and 1e-9 m")
{
    // Speeds, momentum and energy; the same for the smaller gap.
    // Rows at the ends of steps: gaps up to 1e-9 m count as touching, so all balls share the impact; across a gap of 1e-6 m,
    // which is held without restitution, energy is lost.
    constexpr Bound<4> table[] = {
        {"*", "Impulse", {1e-15, 1e-15, 1e-15, 1e-15}},
        {"located", "Rows", {1e-15, 1e-15, 2e-15, 2e-15}},
        {"at ends", "Rows/Direct", {0.81, 1.2, 0.81, 1e-15}, {0.74, 1.1, 0.79, 0}},
        {"at ends", "Rows/SequentialImpulse", {0.81, 1.2, 0.81, 4.5e-7}, {0.74, 1.1, 0.79, 0}},
        {"None", "Rows/SoftStep", {0.58, 0.75, 0.58, 0.75}, {0.5, 0.7, 0.5, 0.7}},
        {"Speculative", "Rows/SoftStep", {0.58, 0.49, 0.58, 0.49}, {0.5, 0.4, 0.5, 0.4}},
    };
    check_algorithms(without_springs(), table,
                     [](const Algorithm& algorithm)
                     {
                         const auto wide = cradle_error(algorithm, 1e-6), narrow = cradle_error(algorithm, 1e-9);
                         return std::array{wide[0], wide[1], narrow[0], narrow[1]};
                     });
}

TEST_CASE("C8: Newton's cradle without gaps: each response follows its declared law")
{
    // One in: speeds of the first and of the last ball, relative to those of the law. k in: momentum and energy.
    constexpr Bound<3> table[] = {
        {"*", "Impulse", {1e-15, 1e-15, 1e-15}},
        {"located", "Rows", {1e-15, 1e-15, 2e-13}},
        {"at ends", "Rows/Direct", {1e-15, 1e-15, 1e-15}},
        {"at ends", "Rows/SequentialImpulse", {9e-8, 1e-9, 4.5e-7}},
        {"None", "Rows/SoftStep", {0.3, 0.13, 0.75}, {0.29, 0.11, 0.7}},
        {"Speculative", "Rows/SoftStep", {0.48, 0.12, 0.46}, {0.47, 0.11, 0.45}},
        {"*", "Penalty", {4e-10, 5e-10, 4e-11}},
        {"*", "HuntCrossley", {1.9e-9, 1.3e-9, 2.5e-8}},
    };
    check_algorithms(every_algorithm(), table,
                     [](const Algorithm& algorithm)
                     {
                         const auto [first, last] = touching_law(algorithm);
                         const auto v = cradle(algorithm, 1, 0);
                         return std::array{std::fabs(v[0] - first), std::fabs(v[4] - last), cradle_error(algorithm, 0)[1]};
                     });
}

namespace
{
/// C13: speeds by place after a cue ball has hit a rack of 15 along its axis; ids are permuted by `rank`. The cue ball's speed
/// is the last one.
std::vector<Vec3> break_rack(const Algorithm& algorithm, const std::vector<int>& rank, double gap)
{
    std::string balls, all;
    std::vector<std::string> ids;
    const double d = 0.1 + gap;
    for (int row = 0, n = 0; row < 5; ++row)
        for (int i = 0; i <= row; ++i, ++n)
        {
            ids.push_back("b" + std::to_string(100 + rank[static_cast<std::size_t>(n)]));
            balls += sphere(ids.back(), 0.05, at({row * d * std::sqrt(0.75), (i - 0.5 * row) * d, 0}));
            all += ids.back() + " ";
        }
    balls += sphere("cue", 0.05, at({-0.5, 0, 0}, {10, 0, 0}));
    ids.push_back("cue");
    Scene s(balls + contact(all + "cue", algorithm, 1, 0, stiffness(algorithm, 1e8, 1e10)), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;
    s.run(0.5);
    std::vector<Vec3> out;
    for (const std::string& id : ids) out.push_back(s.vec(id, "linear_velocity"));
    return out;
}

/// Deviation from mirror symmetry; change when the ids are permuted, m/s; relative changes of momentum and energy.
std::array<double, 4> rack_error(const Algorithm& algorithm, double gap)
{
    std::vector<int> straight, mixed;
    for (int i = 0; i < 15; ++i) straight.push_back(i), mixed.push_back((i * 7 + 3) % 15);
    const std::vector<Vec3> v = break_rack(algorithm, straight, gap), w = break_rack(algorithm, mixed, gap);
    std::array<double, 4> off{};
    for (int row = 0, first = 0; row < 5; first += ++row)
        for (int i = 0; i <= row; ++i)
        {
            const Vec3 &a = v[static_cast<std::size_t>(first + i)], &b = v[static_cast<std::size_t>(first + row - i)];
            off[0] = std::max(off[0], length(a - Vec3{b.x, -b.y, b.z}));
        }
    Vec3 momentum;
    double energy = 0;
    for (std::size_t i = 0; i < v.size(); ++i)
        off[1] = std::max(off[1], length(v[i] - w[i])), momentum = momentum + v[i], energy += length_squared(v[i]);
    off[2] = length(momentum - Vec3{10, 0, 0}) / 10, off[3] = std::fabs(energy / 100 - 1);
    return off;
}
}  // namespace

TEST_CASE("C13: a symmetric rack breaks symmetrically, whatever the ids of the balls: touching, with every algorithm")
{
    // Bisection distinguishes touching from separated only to rounding, and simultaneous impacts are answered one after the
    // other: no symmetry.
    constexpr Bound<4> table[] = {
        {"None", "Impulse", {1e-15, 1e-15, 1e-15, 1e-15}},
        {"certified", "Impulse", {6e-15, 6e-15, 1e-15, 1e-15}},
        {"certified", "Rows", {3e-14, 3e-14, 1e-15, 4e-15}},
        {"halved", "Impulse", {12, 12, 1e-15, 1e-15}, {1, 1, 0, 0}},
        {"halved", "Rows", {9, 8, 1e-15, 4e-15}, {1, 1, 0, 0}},
        {"None", "Rows/Direct", {6e-15, 6e-15, 1e-15, 1e-15}},
        {"Speculative", "Rows/Direct", {1e-14, 1e-14, 1e-15, 6e-3}, {0, 0, 0, 1e-3}},
        {"None", "Rows/SequentialImpulse", {0.5, 0.01, 1e-15, 1.7e-3}, {0.05, 1e-3, 0, 1e-4}},
        {"Speculative", "Rows/SequentialImpulse", {0.6, 1, 1e-15, 0.02}, {0.05, 0.05, 0, 2e-3}},
        {"None", "Rows/SoftStep", {1.5, 3, 1e-15, 0.08}, {0.1, 0.1, 0, 0.01}},
        {"Speculative", "Rows/SoftStep", {0.8, 0.8, 1e-15, 0.9}, {0.1, 0.1, 0, 0.1}},
        {"*", "Penalty", {1e-15, 1e-15, 2.4e-15, 8e-12}},
        {"*", "HuntCrossley", {2e-15, 2e-15, 4e-15, 1.2e-8}},
    };
    check_algorithms(every_algorithm(), table, [](const Algorithm& algorithm) { return rack_error(algorithm, 0); });
}

TEST_CASE("C13: the same with gaps of 0.1 mm")
{
    constexpr Bound<4> table[] = {
        {"None", "Impulse", {1e-15, 1e-15, 1e-15, 1e-15}},
        {"certified", "*", {8e-15, 3e-15, 1e-15, 1e-15}},
        {"halved", "*", {9, 9, 1e-15, 1e-15}, {1, 1, 0, 0}},
        {"None", "Rows/Direct", {1e-15, 1e-15, 1e-15, 1e-15}},
        {"None", "Rows/SequentialImpulse", {1e-15, 1e-15, 1e-15, 1e-15}},
        {"None", "Rows/SoftStep", {0.15, 0.3, 1e-15, 1e-6}, {0.01, 0.01, 0, 0}},
        {"Speculative", "Rows/Direct", {1e-13, 2e-12, 1e-15, 1}, {0, 0, 0, 0.3}},
        {"Speculative", "Rows/SequentialImpulse", {6e-3, 0.015, 1e-15, 1}, {0, 0, 0, 0.3}},
        {"Speculative", "Rows/SoftStep", {0.8, 1, 1e-15, 0.9}, {0.1, 0.1, 0, 0.2}},
    };
    check_algorithms(without_springs(), table, [](const Algorithm& algorithm) { return rack_error(algorithm, 1e-4); });
}
