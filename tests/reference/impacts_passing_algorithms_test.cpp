// A bullet that passes within one step, with every algorithm (contact_algorithms.h): C10 of the catalogue.
#include "impacts.h"

using namespace plab;
using namespace plab::test;

namespace
{
/// A bullet of 1 mm at 1000 m/s and paper of 0.1 mm, e = .5, 16.7 m per step. Measures: error of the reported time, s (1 if none
/// is reported); relative error of the speed afterwards; whether it is reported that the bullet passed through.
std::array<double, 3> shoot(const Algorithm& algorithm)
{
    Scene s(sphere("bullet", 1e-3, at({0, 0, 0}, {1000, 0, 0}, 1e-3)) +
                box("paper", {5e-5, 1, 1}, "position=\"" + text(Vec3{1.2345 + 5e-5, 0, 0}) + "\"", "Static") +
                contact("bullet paper", algorithm, 0.5, 0, stiffness(algorithm, 1e12, 1e15)),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = s.warnings_expected = true;
    s.step(2);
    double off = 1;
    for (const Event& e : s.events)
        if (e.kind == "contact.begin" || e.kind == "contact.impact") off = std::min(off, std::fabs(e.time - (1.2345 - 1e-3) / 1000));
    return {off, std::fabs(s.vec("bullet", "linear_velocity").x + 500) / 1000, static_cast<double>(s.count("contact.missed"))};
}
}  // namespace

TEST_CASE(
    "C10: a bullet and paper: certified algorithms and springs find the time of impact, Speculative stops short of it; the others miss it "
    "and report that")
{
    constexpr Bound<3> table[] = {
        {"certified", "*", {1e-15, 1e-15, 0}},
        {"halved", "*", {1, 1.5, 1}, {1, 1.5, 1}},
        {"None", "springs", {1e-15, 2.2e-9, 0}},
        {"None", "*", {1, 1.5, 1}, {1, 1.5, 1}},
        // Reported at the start of the step in which it is stopped, 1.2335 ms early.
        {"Speculative", "*", {1.24e-3, 1e-15, 0}, {1.23e-3, 0, 0}},
    };
    check_algorithms(every_algorithm(), table, shoot);
}

TEST_CASE("C10: a thousand sheets in one step: a sensor that certifies reports all of them, the others none")
{
    std::string sheets, all;
    for (int i = 0; i < 1000; ++i)
    {
        const std::string id = "s" + std::to_string(10000 + (i * 617) % 1000);  // ids in another order than places
        sheets += box(id, {5e-5, 1, 1}, "position=\"" + text(Vec3{1 + 1e-3 * i + 5e-5, 0, 0}) + "\"", "Static");
        all += id + " ";
    }
    for (const char* resolution : {"None", "Bisection", "LocalBisection", "ConservativeAdvancement", "LocalRoot"})
    {
        CAPTURE(std::string(resolution));
        Scene s(sphere("bullet", 1e-3, at({0, 0, 0}, {1000, 0, 0}, 1e-3)) + sheets + sensor("bullet", resolution, all), "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.step();
        const auto begins = events_of(s, "contact.begin");
        if (!Algorithm{resolution, "None"}.certifies())
        {
            CHECK(begins.empty());
            continue;
        }
        REQUIRE(begins.size() == 1000);
        double worst = 0;
        for (int i = 0; i < 1000; ++i)
            worst = std::max(worst, std::fabs(begins[static_cast<std::size_t>(i)].time - (1 + 1e-3 * i - 1e-3) / 1000));
        CHECK(worst < 1e-15);
    }
}
