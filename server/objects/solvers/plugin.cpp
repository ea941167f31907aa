#include "plab/plugin.h"

#include "runge_kutta4.h"
#include "semi_implicit_euler.h"

PLAB_PLUGIN("solvers", registrar)
{
    using namespace plab::solvers;
    using plab::Phase;
    registrar.component<SemiImplicitEulerRows>("Solver/SemiImplicitEuler", "one force evaluation per step; order 1")
        .family("Solver")
        .command<advance_semi_implicit_euler>(Phase::Advance, "Solver/Advance", "advances its group over the step")
        .order(1)
        .elementwise()
        .cost("1 force evaluation per step")
        .limits("errors shrink only with h; free rotation gains energy")
        .source("Hairer, Lubich, Wanner, Geometric numerical integration, eq. (I.1.9)");
    registrar.component<RungeKutta4Rows>("Solver/RungeKutta4", "the classical method; order 4")
        .family("Solver")
        .command<advance_runge_kutta4>(Phase::Advance, "Solver/Advance", "advances its group over the step")
        .order(4)
        .elementwise()
        .cost("4 force evaluations per step")
        .limits("stiff forces: h below 2.8/w; fast spin: h below 0.05/w; energy drifts in very long runs")
        .source(
            "Hairer, Norsett, Wanner, Solving ordinary differential equations I, table II.1.2; "
            "Munthe-Kaas, Appl. Numer. Math. 29 (1999)");
}
