/// Metrics: cost since the last sample, error, work, outputs of each interaction; the ledger.
#pragma once

#include "publish/error_probe.h"
#include "publish/pace.h"
#include "publish/records.h"
#include "simulation/simulation.h"

namespace plab::publish
{

class Sampler
{
public:
    /// `error_share`: largest share of real time for measuring errors.
    explicit Sampler(double error_share) : errors_(error_share) {}
    wire::Metrics sample(const simulation::Simulation& simulation, Nanoseconds now);

private:
    void read_rate(const simulation::Simulation& simulation, Nanoseconds now);

    ErrorProbe errors_;
    std::uint64_t run_ = 0;
    Nanoseconds rate_since_ = 0;
    double rate_from_ = 0;  ///< s, simulated
    double real_time_factor_ = 0;
};

}  // namespace plab::publish
