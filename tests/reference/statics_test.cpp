// Statics under Response/Rows: what contacts carry, in closed form. D.. as in the catalogue of reference problems.
#include <algorithm>

#include "statics_scene.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kG = 9.81;

/// Unit cubes one upon another.
std::string stack(const std::vector<double>& masses, const std::string& manager)
{
    std::string body = kGround, ids;
    for (std::size_t i = 0; i < masses.size(); ++i)
    {
        body += box(name_of_box(i), {0.5, 0.5, 0.5}, masses[i], {0, 0, static_cast<double>(i) + 0.5});
        ids += name_of_box(i) + " ";
    }
    return body + gravity(ids) + contact(ids + "ground", manager, 0.8);
}

struct Loads
{
    double first = 0;      ///< largest relative error of what a face carries, in the first step
    double worst = 0;      ///< the same, of each step (Direct) or the last one
    double moved = 0;      ///< m, the top
    std::size_t told = 0;  ///< events that contacts did not converge
};

double worst_load(Scene& s, const std::vector<double>& masses)
{
    double above = 0, worst = 0;
    for (std::size_t i = masses.size(); i-- > 0;)
    {
        above += masses[i] * kG;
        const Vec3 f = force_between(s, i == 0 ? "ground" : name_of_box(i - 1), name_of_box(i));
        worst = std::max(worst, length(f - Vec3{0, 0, above}) / above);
    }
    return worst;
}

/// Direct has to be right in each step, the others at the end.
Loads loads_of(const std::vector<double>& masses, const std::string& manager, const std::string& dt, std::int64_t steps)
{
    Scene s(stack(masses, manager), "dt=\"" + dt + "\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.warnings_expected = manager != "Direct";  // what falls through is told as a warning
    Loads out;
    if (manager == "Direct")
    {
        for (std::int64_t i = 0; i < steps; ++i)
        {
            s.step();
            out.worst = std::max(out.worst, worst_load(s, masses));
            if (i == 0) out.first = out.worst;
        }
    }
    else
        s.step(steps), out.worst = worst_load(s, masses);
    out.told = s.count("manager.not_converged");
    const std::size_t top = masses.size() - 1;
    out.moved = distance(s.vec(name_of_box(top), "position"), {0, 0, static_cast<double>(top) + 0.5});
    return out;
}

}  // namespace

TEST_CASE("D1: r kg on 1 kg, r = 1 to 1e8: reactions (1 + r) m g and r m g to rounding in one solve of Direct, and nothing moves in 600")
{
    for (const double r : {1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8})
    {
        CAPTURE(r);
        const Loads loads = loads_of({1, r}, "Direct", "1/60", 600);
        CHECK(loads.first < 1e-15);
        // Two impulses of r g h leave the light body r g h eps off its speed, and r g h^2 eps off its place: the heavy one follows,
        // by r eps of its own load. Beside that the tolerance, some 1e-13 m/s of g h = 0.16 m/s. Reached: 2.3e-12, and 4.1e-16 r.
        CHECK(loads.worst < 4e-12 + 6e-16 * r);
        CHECK(loads.moved < 5e-13 + 1e-17 * r);
        CHECK(loads.told == 0);
    }
}

// Where a cheap rung does not carry the load it says so: `manager.not_converged`, and the figure in `residual`.
TEST_CASE("D1: the cheap rungs: 1:1 to their tolerance, 10:1 within 2 % and 2 mm, from 1000:1 the light box is crushed, and it is told")
{
    struct Rung
    {
        const char* manager;
        double equal, moved;  ///< relative, of the loads; m
    };
    // Sweeps end when the last one changed less than 1e-7 m/s: with a contraction of cos^2(pi/5) = 0.65 a sweep, 2e-7 m/s are left, of
    // g dt = 0.16 m/s, on either face: reached 2.2e-6. SoftStep has come to rest: reached 1.1e-8, 0.18 mm deep.
    for (const Rung rung : {Rung{"SequentialImpulse", 4.5e-6, 1.5e-5}, {"SoftStep", 2.5e-8, 4e-4}})
    {
        CAPTURE(rung.manager);
        const Loads equal = loads_of({1, 1}, rung.manager, "1/60", 60), ten = loads_of({1, 10}, rung.manager, "1/60", 60);
        CHECK(equal.worst < rung.equal);
        CHECK(equal.moved < rung.moved);
        CHECK(ten.worst < 0.02);
        CHECK(ten.moved < 2e-3);
        const Loads heavy = loads_of({1, 1e3}, rung.manager, "1/60", 60);
        CHECK(heavy.moved > 0.5);
        CHECK(heavy.told > 0);
    }
}

TEST_CASE("D2: n cubes: (n - k + 1) m g between them to 6e-12 with Direct, and twice that in later steps")
{
    // Newton's method ends within 1e-12 m/s of the law: of the load of one cube, g dt, that is a share of 6.1e-12. Reached 2.6e-14 at
    // first, and 8.4e-12 in one of 30 steps (50 cubes). Places are rounded to 1.4e-14 m at the top.
    constexpr double kTolerance = 1e-12 / (kG / 60);
    for (const std::size_t n : {10u, 20u, 50u, 100u})
    {
        CAPTURE(n);
        const Loads loads = loads_of(std::vector<double>(n, 1.0), "Direct", "1/60", 30);
        CHECK(loads.first < kTolerance);
        CHECK(loads.worst < 2 * kTolerance);
        CHECK(loads.moved < 1.5e-13);
    }
}

TEST_CASE("D2: the cheap rungs at 1/60: three cubes to 1 mm; ten sink 1 cm with sub-steps, 1 dm with sweeps, which tell it")
{
    const std::vector<double> three(3, 1.0), ten(10, 1.0);
    CHECK(loads_of(three, "SequentialImpulse", "1/60", 120).moved < 1e-3);
    CHECK(loads_of(three, "SoftStep", "1/60", 120).moved < 1e-3);
    const Loads swept = loads_of(ten, "SequentialImpulse", "1/60", 120), soft = loads_of(ten, "SoftStep", "1/60", 120);
    CHECK(swept.moved < 0.1);
    CHECK(swept.told > 0);
    CHECK(soft.moved < 0.01);
    CHECK(soft.worst < 0.1);
}

// A slab on four feet with a heavy box off its centre. Equilibrium gives three equations for four feet; what is left free is the
// split (+ - - +). Of all splits Direct takes the one with the least sum of squares, which is affine in the feet's places:
//   f_i = W / 4 (1 + x x_i / a^2 + y y_i / b^2),   (x, y): where the resultant passes, (+-a, +-b): the feet.
// From nothing it does so to rounding. Later steps look again where rounding has moved the table, and take the split with them: 1e-7 after
// 600.
TEST_CASE("D6: a table with four feet: the sum and the moments exactly, the split of least norm")
{
    const double a = 0.6, b = 0.4, mass = 10, load = 30, x = 0.25, y = 0.1;
    std::string feet, shapes;
    for (int i = 0; i < 4; ++i)
    {
        const std::string id = "foot" + std::to_string(i);
        shapes += "<component id=\"" + id + "\" type=\"Shape/Sphere\" radius=\"0.05\" position=\"" +
                  text(Vec3{(i & 1) != 0 ? a : -a, (i & 2) != 0 ? b : -b, -0.05}) + "\"/>";
        feet += id + " ";
    }
    shapes +=
        "<component id=\"slab\" type=\"Shape/Box\" half_extents=\"0.7 0.5 0.05\"/>"
        "<component id=\"table.shape\" type=\"Shape/Compound\" parts=\"slab " +
        feet +
        "\"/>"
        "<component id=\"table\" type=\"State/RigidBody\" shape=\"table.shape\" mass=\"10\" inertia=\"1 2 3\" "
        "center_of_mass=\"0 0 0\" position=\"0 0 0.1\"/>";
    struct Rung
    {
        const char* manager;
        double moments, first_split, split;  ///< relative
    };
    // Sweeps stop at the first split that they come to, and at moments within their tolerance (D1): reached 2.2e-6. SoftStep's springs
    // share evenly once they have come to rest, from 1.5e-4; its sub-steps leave 2e-5 of the moments.
    constexpr double kAny = 1;
    for (const Rung rung : {Rung{"Direct", 1e-13, 2e-14, 2e-7}, {"SequentialImpulse", 4.5e-6, kAny, kAny}, {"SoftStep", 4e-5, kAny, 3e-4}})
    {
        CAPTURE(rung.manager);
        Scene s(kGround + shapes + box("load", {0.1, 0.1, 0.1}, load, {x, y, 0.25}) + gravity("table load") +
                    contact("table load ground", rung.manager, 0.5),
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const double weight = (mass + load) * kG, cx = load * x / (mass + load), cy = load * y / (mass + load);
        std::vector<double> f;
        const auto off_least = [&]
        {
            f = point_forces(s, "ground", "table");
            REQUIRE(f.size() == 4);
            double worst = 0;
            for (std::size_t i = 0; i < 4; ++i)
            {
                const double xi = (i & 1) != 0 ? a : -a, yi = (i & 2) != 0 ? b : -b;
                worst = std::fmax(worst, std::fabs(f[i] / (weight / 4 * (1 + cx * xi / (a * a) + cy * yi / (b * b))) - 1));
            }
            return worst;
        };
        s.step();
        CHECK(off_least() < rung.first_split);
        s.step(599);
        CHECK(off_least() < rung.split);
        CHECK(std::fabs((f[0] + f[1] + f[2] + f[3]) / weight - 1) < rung.moments);
        CHECK(std::fabs(a * (f[1] + f[3] - f[0] - f[2]) / weight - cx) < rung.moments);
        CHECK(std::fabs(b * (f[2] + f[3] - f[0] - f[1]) / weight - cy) < rung.moments);
    }
}

// A uniform capsule of length L between the centres of its ends (radius r), its foot on a floor with friction, its head at a smooth
// wall. Moments about the foot's centre: m g L cos / 2 = f (L sin + r), f <= mu m g: it slips iff
//   (sin theta + r / L) / cos theta < 1 / (2 mu),     tan theta < 1 / (2 mu) for a thin one.
// Below that, by delta, it slides: with F' = mu L cos + L sin / 2 the angle falls by delta (cosh k t - 1),
//   k^2 = m g F' / (I + m L^2 sin^2 / 4),   I = m L^2 / 12.
TEST_CASE("D7: a ladder slips iff tan theta < 1 / (2 mu), to 1e-4 rad either way")
{
    const double mu = 0.5, length = 2, r = 0.002;
    // sin + r / L = cos / (2 mu): theta = atan(1 / 2 mu) - asin((r / L) / sqrt(1 + 1 / (4 mu^2))).
    const double q = 1 / (2 * mu), limit = std::atan(q) - std::asin(r / length / std::sqrt(1 + q * q));
    for (const double off : {1e-4, -1e-4})
        for (const char* manager : {"Direct", "SequentialImpulse", "SoftStep"})
        {
            CAPTURE(off);
            CAPTURE(manager);
            const double theta = limit + off, c = std::cos(theta), sn = std::sin(theta);
            // The capsule's axis is z, tilted towards +x, where the wall is.
            const std::string turn = "axis 0 1 0 " + text((1.5707963267948966 - theta) * 57.295779513082321) + " deg";
            const std::string ladder =
                "<component id=\"wall\" type=\"State/Static\" shape=\"floor\" orientation=\"axis 0 1 0 -90 deg\" position=\"" +
                text(Vec3{0.5 * length * c + r, 0, 0}) + "\" material=\"ice\"/><component id=\"rod\" type=\"Shape/Capsule\" radius=\"" +
                text(r) + "\" length=\"" + text(length) +
                "\"/><component id=\"ladder\" type=\"State/RigidBody\" shape=\"rod\" mass=\"3\" material=\"wood\" orientation=\"" + turn +
                "\" position=\"" + text(Vec3{0, 0, 0.5 * length * sn + r}) +
                "\"/><component id=\"smooth\" type=\"Material/Pair\" a=\"ice\" b=\"wood\" friction=\"0\" restitution=\"0\"/>";
            Scene s(kGround + ladder + gravity("ladder") + contact("ladder ground wall", manager, mu), "dt=\"1/240\"");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            const Vec3 before = s.vec("ladder", "position");
            s.run(1);
            const double moved = distance(s.vec("ladder", "position"), before);
            const bool holds = off > 0;
            const double k = std::sqrt(kG * (mu * length * c + 0.5 * length * sn) / (length * length * (1.0 / 12 + 0.25 * sn * sn)));
            const double slid = 0.5 * length * -off * (std::cosh(k) - 1);
            // Sub-steps give way, and slide 2 cm in a second this near to the edge.
            if (manager == std::string("SoftStep"))
                CHECK(moved < 0.05);
            else if (holds)
                CHECK(moved < (manager == std::string("Direct") ? 1e-11 : 1e-4));
            else
                CHECK(std::fabs(moved / slid - 1) < 0.02);
        }
}
