// Sliding, sticking and rolling on a plane. C14, C15 as in the catalogue, and the scene of C15 far away, fast and turned (A11).
//
// | problem | rung                        | bound                                                                  |
// |---------|-----------------------------|------------------------------------------------------------------------|
// | C14a    | Rows/Direct, any resolution | way 1e-12 m at h = 1/100 and 1/400, any direction; stands in the step  |
// |         |                             | of the end                                                             |
// |         | Impulse, located            | 5e-5 m at 1/100, 1e-5 at 1/400: the end of slip falls within a step    |
// |         | Impulse, None               | 1e-3 m at 1/100                                                        |
// |         | Rows/SequentialImpulse      | 1e-8 m; it creeps on for a tenth of a second                           |
// |         | Rows/SoftStep               | 5e-3 m at 1/100                                                        |
// | C14b    | Rows/Direct; Impulse located| x 1e-12 m, v 1e-12                                                     |
// |         | Impulse, None               | x 1e-3 m: it begins to press one step late                             |
// |         | SequentialImpulse; SoftStep | 1e-8 m; 3e-3 m                                                         |
// | C14c    | Rows/Direct, any resolution | mu = tan(1 + 1e-6): 1e-9 m in an hour (h = 0.1); (1 - 1e-6): 1e-5 m of |
// |         |                             | 0.0245 m in 100 s                                                      |
// |         | Impulse                     | holds at mu = 1.01 tan: 1e-4 m, all of it in the first second. At 1e-6 |
// |         |                             | sweeps end early: cm                                                   |
// | C15     | Rows/Direct, any resolution | x, v 1e-11, spin 1e-10                                                 |
// |         | Impulse, located            | v 1e-12; x 1e-4 m at 1/100, 5e-6 at 1/400 (the end of slip)            |
// |         | Impulse, None               | x 5e-4 m at 1/100                                                      |
// |         | SequentialImpulse; SoftStep | 1e-11; x 2e-3 m, v 4e-4                                                |
// | A11     | LocalRoot, LocalBisection   | 1e-7 m at 1e7 m; boosted by 1e3 m/s 1e-11 m, turned 1e-13 m            |
// |         | None + Rows                 | the same, boosted 6e-7 m: rounding chooses the step of its last bounces|
#include <algorithm>
#include <array>
#include <numbers>

#include "impacts.h"

using namespace plab;
using namespace plab::test;

namespace
{
constexpr double kG = 9.81;
constexpr Rung kSliding[] = {
    {"None", "Impulse"},         {"LocalBisection", "Impulse"}, {"LocalRoot", "Impulse"}, {"None", "Rows"},
    {"Speculative", "Rows"},     {"LocalBisection", "Rows"},    {"LocalRoot", "Rows"},    {"None", "Rows", "SequentialImpulse"},
    {"None", "Rows", "SoftStep"}};

bool direct(const Rung& r) { return r.rows() && std::string(r.manager) == "Direct"; }
bool soft(const Rung& r) { return r.rows() && std::string(r.manager) == "SoftStep"; }

std::string step_of(double h) { return "dt=\"" + text(h) + "\""; }
/// A ramp that stays level, with gravity leaning along x.
Vec3 leaning(double angle) { return {kG * std::sin(angle), 0, -kG * std::cos(angle)}; }
std::string brick(const Vec3& v = {}) { return kGround + box("a", {0.5, 0.5, 0.1}, at({0, 0, 0.1}, v)); }

double bound_of_stop(const Rung& r, double h)
{
    const double share = h < 0.005 ? 0.2 : 1;
    if (direct(r)) return 1e-12;
    if (soft(r)) return 5e-3 * share * 2;
    if (r.rows()) return 1e-8;
    return (r.locates() ? 5e-5 : 1e-3) * share;
}
}  // namespace

TEST_CASE("C14a: a box slides to a stop, at 5 m/s and mu = 0.5, as far in any direction")
{
    const double way = 25 / (2 * 0.5 * kG), end = 5 / (0.5 * kG);  // 2.54841997961264 m, 1.01936799184506 s
    for (const Rung& rung : kSliding)
        for (const double h : {0.01, 0.0025})
            for (const double angle : {0.0, 0.3, std::numbers::pi / 4})
            {
                CAPTURE(rung.name());
                CAPTURE(h);
                CAPTURE(angle);
                const Vec3 t{std::cos(angle), std::sin(angle), 0};
                Scene s(brick(t * 5) + gravity("a") + contact("a ground", rung, 0, 0.5), step_of(h));
                REQUIRE_MESSAGE(s.loaded(), s.error());
                double moving = 0;
                while (s.simulation().time() < 1.5)
                {
                    s.step();
                    if (length(s.vec("a", "linear_velocity")) > 1e-9) moving = s.simulation().time();
                }
                const Vec3 p = s.vec("a", "position");
                CHECK(std::hypot(p.x - way * t.x, p.y - way * t.y) < bound_of_stop(rung, h));
                if (direct(rung)) CHECK((moving < end && moving > end - 1.01 * h));
            }
}

TEST_CASE("C14b: a box slides down 30 degrees with mu = 0.3 at g (sin - mu cos)")
{
    const double a = kG * (0.5 - 0.3 * std::sqrt(0.75));  // 2.35628723666239706 m/s^2
    for (const Rung& rung : kSliding)
    {
        CAPTURE(rung.name());
        Scene s(brick() + gravity("a", leaning(std::numbers::pi / 6)) + contact("a ground", rung, 0, 0.3), step_of(0.01));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        const bool exact = direct(rung) || (!rung.rows() && rung.locates());
        CHECK(std::fabs(s.vec("a", "linear_velocity").x / a - 1) < (soft(rung) ? 1e-4 : 1e-12));
        CHECK(std::fabs(s.vec("a", "position").x - 0.5 * a) < (exact ? 1e-12 : soft(rung) ? 3e-3 : rung.rows() ? 1e-8 : 1e-3));
    }
}

TEST_CASE("C14c: a box on a ramp at mu = tan(angle) (1 -+ 1e-6) holds for an hour, and slides by the difference")
{
    const double angle = std::numbers::pi / 6;
    for (const Rung& rung : kSliding)
    {
        if (!direct(rung)) continue;
        CAPTURE(rung.name());
        const auto ramp = [&](double off, double until)
        {
            Scene s(brick() + gravity("a", leaning(angle)) + contact("a ground", rung, 0, std::tan(angle) * (1 + off)), step_of(0.1));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(until);
            return s.vec("a", "position").x;
        };
        const bool once = rung.is("None");
        CHECK(std::fabs(ramp(1e-6, once ? 3600 : 360)) < 1e-9);
        CHECK(std::fabs(ramp(-1e-6, 100) - 0.5 * kG * std::sin(angle) * 1e-6 * 1e4) < 1e-5);
    }
}

TEST_CASE("C14c: sweeps of impulses hold a box one percent below slipping")
{
    for (const char* resolution : {"LocalBisection", "LocalRoot"})
    {
        Scene s(brick() + gravity("a", leaning(0.5)) + contact("a ground", Rung{resolution, "Impulse"}, 0, std::tan(0.5) * 1.01),
                step_of(0.01));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        const double x = s.vec("a", "position").x;
        CHECK(std::fabs(x) < 1e-4);
        s.run(20);
        CHECK(std::fabs(s.vec("a", "position").x - x) < 1e-9);
    }
}

TEST_CASE("C15: a sliding ball comes to roll, when and as fast as it should")
{
    const double v0 = 5, mu = 0.3, end = 2 * v0 / (7 * mu * kG);  // .485413329450026698 s
    const double x = 2.08034284050011442 + 25.0 / 7 * (1 - end);
    for (const Rung& rung : kSliding)
        for (const double h : {0.01, 0.0025})
        {
            CAPTURE(rung.name());
            CAPTURE(h);
            Scene s(kGround + sphere("a", 0.1, at({0, 0, 0.1}, {v0, 0, 0})) + gravity("a") + contact("a ground", rung, 0, mu), step_of(h));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(1);
            const double off = std::fabs(s.vec("a", "position").x - x), share = h < 0.005 ? 0.1 : 1;
            const double v = std::fabs(s.vec("a", "linear_velocity").x - 25.0 / 7),
                         w = std::fabs(s.vec("a", "angular_velocity").y - 250.0 / 7);
            if (soft(rung))
            {
                CHECK(off < 2e-3);
                CHECK(v < 4e-4);
                continue;
            }
            CHECK(off < (rung.rows() ? 1e-11 : (rung.locates() ? 1e-4 : 5e-4) * share));
            CHECK(v < (rung.rows() || rung.locates() ? 1e-11 : 1e-4));
            CHECK(w < (rung.rows() || rung.locates() ? 1e-10 : 1e-3));
        }
}

namespace
{
/// C15 with a bounce ahead of it, in another frame. Where the ball is, seen from where it began in that frame, turned back.
std::vector<Vec3> path(const Rung& rung, const Vec3& origin, const Vec3& boost, const Quat& q)
{
    const std::string turned = "orientation=\"" + text(q.w) + " " + text(q.x) + " " + text(q.y) + " " + text(q.z) + "\"";
    Scene s("<component id=\"floor\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Kinematic\" shape=\"floor\" position=\"" +
                text(origin) + "\" linear_velocity=\"" + text(boost) + "\" " + turned + "/>" +
                sphere("a", 0.1, at(origin + rotate(q, {0, 0, 0.3}), boost + rotate(q, {5, 0, 0})) + " " + turned) +
                gravity("a", rotate(q, {0, 0, -kG})) + contact("a ground", rung, 0.5, 0.3),
            "dt=\"1/100\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    std::vector<Vec3> out;
    while (s.simulation().time() < 1)
    {
        s.step();
        out.push_back(rotate(conjugate(q), s.vec("a", "position") - s.vec("ground", "position")));
    }
    return out;
}
double furthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, distance(a[i], b[i]));
    return worst;
}
}  // namespace

TEST_CASE("A11: a ball that bounces, slides and rolls does the same 1e7 m away, at 1e3 m/s and turned")
{
    const Quat turn = normalized(Quat{0.3, -0.5, 0.7, 0.2});
    for (const Rung& rung :
         {Rung{"LocalRoot", "Impulse"}, Rung{"LocalBisection", "Impulse"}, Rung{"LocalRoot", "Rows"}, Rung{"None", "Rows"}})
    {
        CAPTURE(rung.name());
        const std::vector<Vec3> here = path(rung, {}, {}, {1, 0, 0, 0});
        CHECK(here.back().x > 2);
        // A position is rounded once per step, at 1e7 m by up to 9.3e-10 m, at a constant speed always to the same side: 100 steps
        // make 9.7e-8 m of (1e7, 2e6, -3e6). 1e3 m away by up to 5.7e-14 m, and the speed as much: 1e-11 m. Reached 7.5e-8, 3.2e-12.
        CHECK(furthest(here, path(rung, {1e7, 2e6, -3e6}, {}, {1, 0, 0, 0})) < 1e-7);
        CHECK(furthest(here, path(rung, {}, {1e3, 0, 0}, {1, 0, 0, 0})) < (rung.locates() ? 1e-11 : 6e-7));
        CHECK(furthest(here, path(rung, {}, {}, turn)) < 1e-13);
    }
}
