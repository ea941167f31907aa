/// Bodies that tumble onto a plane, with contacts answered at the ends of steps: bounds on their energy.
#pragma once

#include <algorithm>

#include "plab/random.h"
#include "statics_scene.h"
#include "support/mechanical_energy.h"

namespace plab::test
{

/// A combination of algorithms that answers contacts: a resolution, and a manager or Response/Impulse.
struct Method
{
    const char* resolution;
    const char* manager;  ///< "Impulse": Response/Impulse
};

struct Drop
{
    Vec3 half{0.5, 0.02, 0.02};  ///< m, of a box of 1 kg
    Vec3 inertia;                ///< kg m^2; 0: that of the box
    Vec3 axis{0, 0, 1};
    double angle = 0;
    Vec3 velocity, spin;
    double height = 1;  ///< m
    double friction = 0;
    double until = 1;  ///< s
    double h = 1.0 / 240;
};

inline std::string scene_of(const Drop& d, const Method& method)
{
    const Vec3 n = d.axis / length(d.axis);
    std::string more = "orientation=\"axis " + text(n) + " " + text(d.angle) + "\" linear_velocity=\"" + text(d.velocity) +
                       "\" angular_velocity=\"" + text(d.spin) + "\"";
    if (d.inertia != Vec3{}) more += " center_of_mass=\"0 0 0\" inertia=\"" + text(d.inertia) + "\"";
    const bool impulse = method.manager == std::string("Impulse");
    return std::string(kGround) + box("f", d.half, 1, {0, 0, d.height}, more) + gravity("f") +
           (impulse ? "<component id=\"contact\" type=\"CDetection/ODE\" between=\"f ground\" resolution=\"Resolution/" +
                          std::string(method.resolution) + "\" response=\"Response/Impulse\" response.friction=\"" + text(d.friction) +
                          "\" response.restitution=\"0\"/>"
                    : contact("f ground", method.manager, d.friction, 0, method.resolution));
}

struct Fall
{
    double start = 0, highest = 0, last = 0;  ///< J
    double lifted = 0;                        ///< J, largest gain in one step
    double gained = 0;                        ///< J: largest energy above the start plus what the contacts report as lifted
    double gain() const { return highest / start; }
};

inline Fall play(const Drop& d, const Method& method)
{
    Scene s(scene_of(d, method), "dt=\"" + text(d.h) + "\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;
    Fall out;
    out.start = out.highest = out.last = mechanical_energy(s);
    while (s.simulation().time() < d.until)
    {
        s.step();
        const double now = mechanical_energy(s);
        out.highest = std::max(out.highest, std::isfinite(now) ? now : HUGE_VAL);
        out.lifted = std::max(out.lifted, now - out.last);
        double lift = 0;
        for (const simulation::ContactEnergy& e : s.simulation().stepper().contact_energy()) lift += e.by_correction;
        out.gained = std::max(out.gained, std::isfinite(now) ? now - out.start - lift : HUGE_VAL);
        out.last = now;
    }
    return out;
}

inline Vec3 any_direction(std::uint64_t& random)
{
    Vec3 v;
    do
        for (int i = 0; i < 3; ++i) v[i] = 2 * next_uniform(random) - 1;
    while (length(v) > 1 || length(v) < 0.1);
    return v / length(v);
}

inline constexpr Method kMethods[] = {{"None", "Direct"},         {"None", "SequentialImpulse"}, {"None", "SoftStep"},
                                      {"None", "Impulse"},        {"Speculative", "Direct"},     {"Speculative", "SequentialImpulse"},
                                      {"Speculative", "SoftStep"}};

/// A falling, tumbling body: inertia ratios up to 1e4, h from 1/30 to 1/1000, w h up to 2, every other one with friction.
inline Drop any_drop(std::uint64_t& random)
{
    Drop d;
    const auto log_between = [&](double low, double high) { return low * std::pow(high / low, next_uniform(random)); };
    d.half = {0.5, 0.5 * log_between(0.01, 1), 0.5 * log_between(0.01, 1)};
    d.h = log_between(1e-3, 1.0 / 30);
    d.axis = any_direction(random), d.angle = 3 * next_uniform(random);
    d.spin = any_direction(random) * (2 * next_uniform(random) / d.h);
    d.velocity = any_direction(random) * (3 * next_uniform(random));
    d.height = length(d.half) + 0.3 * next_uniform(random) + 0.01;  // clear of the plane, however it is turned
    d.friction = next_uniform(random) < 0.5 ? 0.0 : next_uniform(random);
    d.until = std::min(1.0, 150 * d.h);
    return d;
}

/// J: allowed energy gain in a fall where it is not exact: some multiples of the work of gravity in one step.
inline double allowance(const Drop& d) { return 10 * std::pow(9.81 * d.h, 2); }

inline void check_drops(std::uint64_t random, int count)
{
    for (int i = 0; i < count; ++i)
    {
        const Drop d = any_drop(random);
        for (const Method& method : kMethods)
        {
            const Fall f = play(d, method);
            CAPTURE(i);
            CAPTURE(std::string(method.resolution));
            CAPTURE(std::string(method.manager));
            CAPTURE(d.h);
            CAPTURE(f.start);
            // SoftStep uses the contacts at the start of the step in its sub-steps.
            const bool exact = method.manager != std::string("SoftStep");
            CHECK(f.gained <= 1e-9 * f.start + (exact ? 0.0 : allowance(d)));
        }
    }
}

}  // namespace plab::test
