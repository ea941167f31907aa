#include "bench/peers/check.h"

#include <cmath>

#include "bench/peers/measure.h"
#include "bench/peers/reference.h"

namespace plab::peers
{
namespace
{

struct Known
{
    const char* which;
    Adapter adapter;
    const char* run;  ///< label
    const char* metric;
    double value;
    double tolerance;  ///< relative
};

// Sources: measured beforehand with programs that share no code with this one; the figures do not depend on the machine.
const std::vector<Known>& known_figures()
{
    static const std::vector<Known> table{
        {"a", ode_runs, "ode world dt 1/60", "energy", 0.21, 0.02},
        {"a", ode_runs, "ode world dt 1/60", "angular_momentum", 0.098, 0.02},
        {"a", ode_runs, "ode world dt 1/60", "distance", 9.81 * 20 / 120, 1e-3},  // g T dt / 2
        {"a", bullet_runs, "bullet explicit dt 1/30", "energy", 1.6, 0.05},
        {"a", simbody_runs, "simbody rkm dt 1/240", "angle_end", 4.2e-7, 0.05},
        {"a", simbody_runs, "simbody rkm dt 1/1000", "angle_end", 3.3e-10, 0.1},
        {"b", ode_runs, "ode world dt 1/60", "height_rms", 0.18, 0.03},
        {"b", ode_runs, "ode world dt 1/240", "height_rms", 0.014, 0.05},
        {"b", ode_runs, "ode world dt 1/240", "energy", 0.0092, 0.03},
        {"b", bullet_runs, "bullet si10 erp0_cpt0 dt 1/60", "height_rms", 0.18, 0.03},
        {"b", bullet_runs, "bullet si10 dt 1/480", "energy", 1.0, 1e-3},  // stops dead
        {"g-ball-1s", ode_runs, "ode world dt 1/240", "energy", 2.2e-3, 0.05},
        {"h", ode_runs, "ode world dt 1/30", "angle", 7.8e-4, 0.02},
        {"h", ode_runs, "ode world dt 1/30", "phase", 2.8e-3, 0.02},
        {"h", ode_runs, "ode world dt 1/1000", "angle", 9.8e-5, 0.02},
        {"h", bullet_runs, "bullet si10 dt 1/60", "angle", 1 / 600.0, 0.01},  // dt / T of semi-implicit Euler
        {"i-spring", simbody_runs, "simbody rkm dt 1/4000", "rms", 6.2e-5, 0.05},
    };
    return table;
}

Checked check(const Known& known)
{
    Checked out{known.run, std::string(known.which) + " " + known.metric, known.value, std::nan(""), false};
    std::vector<std::string> notes;
    for (const Case& which : make_cases({known.which}))
        for (const Run& run : known.adapter(which, notes))
        {
            if (run.label() != known.run) continue;
            const Measurement m = measure(which, run, Quantity::Figures);
            for (std::size_t i = 0; i < m.figures.size(); ++i)
                if (which.metrics[i].name == known.metric) out.measured = m.figures[i];
        }
    out.good = std::fabs(out.measured / known.value - 1) <= known.tolerance;
    return out;
}

Checked check_reference()
{
    const Vec3 inertia{1, 2, 3}, spin{0.01, 5, 0.01};
    const Quat coarse = FreeRotation(inertia, spin, 20, 25000).attitude(20);
    const Quat fine = FreeRotation(inertia, spin, 20, 50000).attitude(20);
    const double apart =
        std::fabs(coarse.w - fine.w) + std::fabs(coarse.x - fine.x) + std::fabs(coarse.y - fine.y) + std::fabs(coarse.z - fine.z);
    return {"reference", "a: change when its step is halved", 0, apart, apart < 1e-14};
}

}  // namespace

std::vector<Checked> check_adapters()
{
    std::vector<Checked> out{check_reference()};
    for (const Known& known : known_figures()) out.push_back(check(known));
    return out;
}

}  // namespace plab::peers
