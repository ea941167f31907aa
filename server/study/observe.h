/// What is noted while a recorded run steps.
#pragma once

#include "study/run.h"

namespace plab::study
{

class Observation
{
public:
    Observation(const simulation::Simulation& simulation, RunRecord& out);

    /// After each step: events and what the step reports.
    void step();
    /// At a sample time: quantities, energies, momenta, declared errors and outputs.
    void sample();
    /// At the end: outputs, and what did the work.
    void finish();

private:
    void note(const Event& event);
    void sample_energy(const simulation::Totals& totals);
    void sample_momenta(const simulation::Totals& totals);
    void sample_parts();

    const simulation::Simulation* s_;
    RunRecord* out_;
    simulation::Totals start_;
    double work_at_start_ = 0;
};

/// Work of interactions whose energy is not among the stored ones, and of requests; J since the run began.
double unstored_work(const simulation::Simulation& simulation);

}  // namespace plab::study
