#include "plab/plugin.h"

#include "airflow.h"
#include "gravity.h"
#include "loads.h"

PLAB_PLUGIN("fields", registrar)
{
    using namespace plab::fields;
    using plab::Phase;
    registrar.component<GravityRows>("Field/Gravity", "weight in a uniform field")
        .family("Field/Gravity")
        .command<apply_gravity>(Phase::Force, "Field/Apply", "adds m g")
        .command<stored_by_gravity>(Phase::Potential, "Field/Energy", "potential energy, zero at the world's origin")
        .uniform();
    registrar.component<LoadRows>("Field/Load", "a constant force and torque")
        .family("Field/Load")
        .command<apply_load>(Phase::Force, "Field/Apply", "adds the force and the torque")
        .uniform()
        .limits("does not turn with the body");
    registrar.component<DragRows>("Field/Drag", "linear and quadratic resistance of a medium that may move")
        .family("Field/Drag")
        .command<apply_drag>(Phase::Force, "Field/Apply", "adds the resistance to motion through the medium")
        .limits("explicit: a step must be shorter than about m/c");
    registrar.component<AirflowRows>("Field/Airflow", "the cone of air that a fan blows")
        .family("Field/Airflow")
        .command<apply_airflow>(Phase::Force, "Field/Apply", "drags the bodies in the cone along with the air")
        .limits("one-way: the fan does not feel the air; bodies do not shield one another")
        .source("S. B. Pope, Turbulent flows, section 5.1 (round jet)");
}
