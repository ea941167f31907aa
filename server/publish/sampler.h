/// Metrics: cost since the last sample, error, work, outputs of each interaction; the ledger.
#pragma once

#include "publish/pace.h"
#include "publish/records.h"
#include "simulation/simulation.h"

namespace plab::publish
{

class Sampler
{
public:
    Metrics sample(const simulation::Simulation& simulation, Nanoseconds now);

private:
    void read_costs(const simulation::Simulation& simulation);
    void read_rate(const simulation::Simulation& simulation, Nanoseconds now);

    std::uint64_t run_ = 0;
    simulation::CostBook since_;
    std::vector<double> cost_of_rows_;
    double step_ns_ = 0;
    Nanoseconds rate_since_ = 0;
    double rate_from_ = 0;  ///< s, simulated
    double real_time_factor_ = 0;
};

}  // namespace plab::publish
