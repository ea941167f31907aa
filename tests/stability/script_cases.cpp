// Scripts with every kind of failure, beside a body that is independent of them.
#include "case.h"
#include "pieces.h"
#include "trial.h"

namespace plab::stability
{

namespace
{

struct Fault
{
    const char* name;
    const char* code;
};

const std::vector<Fault>& faults()
{
    static const std::vector<Fault> all{
        {"force nan", "function force(t, state) driven:add_force(vec(0/0, 0, 0)) end"},
        {"force inf", "function force(t, state) driven:add_force(vec(1/0, 0, 0)) end"},
        {"force 1e300", "function force(t, state) driven:add_force(vec(1e300, 0, 0)) end"},
        {"pushes itself", "function force(t, state) driven:add_force(1000 * driven.velocity) end"},
        {"nan later", "function force(t, state) driven:add_force(vec(1 / (t &lt; 0.5 and 1 or 0/0), 0, 0)) end"},
        {"loop in force", "function force(t, state) while true do end end"},
        {"loop in drive", "function drive(step) while true do end end"},
        {"loop in pcall", "function drive(step) while true do pcall(function() while true do end end) end end"},
        {"error", "function force(t, state) error('no') end"},
        {"recursion", "local function f() return 1 + f() end function force(t, state) f() end"},
        {"memory", "function drive(step) local t = {} for i = 1, 1e9 do t[i] = 'x' .. i end end"},
        {"sets nan", "function drive(step) set('sick', 'mass', 0/0) end"},
    };
    return all;
}

Case scripts()
{
    std::vector<std::string> names;
    for (const Fault& f : faults()) names.emplace_back(f.name);
    const auto solvers = algorithms_of("Solver");
    Case c{"script",
           "Scripts that fail",
           "A script acts on one body of 1 kg that moves with 1 m/s, and another body falls freely; 2 s at 1/60 s. "
           "Error: of the other body's speed, relative, which no failure may affect. "
           "Stable to 1e-9, bounded to 1; a body that is not finite is beyond all bounds.",
           "solver",
           "fault",
           solvers,
           names,
           {},
           {}};
    c.run = [solvers](std::size_t r, std::size_t v)
    {
        Trial t(gravity() + body("sick", 1, {1, 1, 1}, {5, 0, 0}, attribute("linear_velocity", Vec3{1, 0, 0})) +
                    body("well", 1, {1, 1, 1}, {}) + "<component id=\"script\" type=\"Script/Lua\" driven=\"sick\"><param name=\"code\">" +
                    faults()[v].code + "</param></component>",
                dt(1.0 / 60) + attribute("solver", "Solver/" + solvers[r]));
        t.run(2);
        if (!t.loaded()) return t.judge(0, {});
        const double error = std::fabs(t.vec("well", "linear_velocity").z / (-kG * t.simulation().time()) - 1);
        const double speed = length(t.vec("sick", "linear_velocity"));
        return t.judge(std::isfinite(speed) && speed < 1e4 ? error : speed, {1e-9, 1});
    };
    c.quick = [solvers](std::size_t r, std::size_t v) { return solvers[r] == "RungeKutta4" || (solvers[r] == "Radau5" && v < 5); };
    return c;
}

}  // namespace

std::vector<Case> script_cases() { return {scripts()}; }

}  // namespace plab::stability
