/// What is recorded while a run steps.
#pragma once

#include "study/run_record.h"

namespace plab::study
{

class Observation
{
public:
    Observation(const simulation::Simulation& simulation, RunRecord& out);

    /// After each step: events and the step's report.
    void step();
    /// At a sample time: quantities, energies, momenta, declared errors and outputs.
    void sample();
    /// At the end: outputs, and the algorithms that did the work.
    void finish();

private:
    void note(const Event& event);
    void sample_energy(const simulation::Totals& totals);
    void sample_momenta(const simulation::Totals& totals);
    void sample_parts();

    const simulation::Simulation* simulation_;
    RunRecord* out_;
    simulation::Totals start_;
    bool by_work_ = false;
    double unexplained_at_start_ = 0;
};

/// Work of interactions whose energy is not part of the stored energy, and of requests; J since the run began.
double unstored_work(const simulation::Simulation& simulation);
/// Whether stored energies do not show what was lost: a spring with a damper dissipates energy that only its work accounts for;
/// contacts share theirs with the forces that they balance.
bool energy_goes_unseen(const simulation::Simulation& simulation);
/// Kinetic and stored energy less the work of interactions that store none; `by_work`: kinetic energy less all work, as in the
/// live metrics ("unexplained"). J, up to a constant.
double unexplained_energy(const simulation::Simulation& simulation, const simulation::Totals& totals, bool by_work);

}  // namespace plab::study
