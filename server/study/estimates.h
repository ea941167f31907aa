/// Whether what trial steps tell of a level is true: for some components of a governor, what they tell against what the level then errs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulation/simulation.h"
#include "study/island_energy.h"
#include "study/shadow.h"

namespace plab::study
{

/// One component with one level in one interval, against the most exact level: as trial steps told at its begin, and the largest departure
/// at any step of it.
struct EstimateSample
{
    std::string level, component;
    double begin = 0;                ///< s
    double estimate = 0, error = 0;  ///< rad, W, or m
};

/// Of all samples of a level whose error can be told from rounding: the estimate as a multiple of the true error.
struct EstimateSpread
{
    std::string level;
    std::size_t samples = 0;
    double tenth = 0, median = 0, nine_tenths = 0;  ///< quantiles
    double error = 0;                               ///< median of the true errors
};
std::vector<EstimateSpread> spreads_of(const std::vector<EstimateSample>& samples);

/// For each level but the most exact one a simulation continues from the state of a run with that level for all, beside `exact`, which does
/// so with the most exact one.
class EstimateCheck
{
public:
    /// `unit`: of the governor; of pixels, metres are checked.
    EstimateCheck(model::TypeSource& types, std::string unit) : types_(types), unit_(std::move(unit)) {}

    /// `exact` has the state of the run, and the levels of the run as yet. `watched`: of which some are taken, spread evenly.
    Result<void> open(simulation::Simulation& exact, const simulation::Snapshot& state, const simulation::Ladder& ladder,
                      const std::vector<std::string>& watched, double interval, const simulation::LevelBook& levels);
    /// After each step of `exact`.
    Result<void> follow(simulation::Simulation& exact);
    void close(std::vector<EstimateSample>& out);
    void drop() { courses_.clear(), energies_.clear(), samples_.clear(); }
    bool is_open() const { return !courses_.empty(); }

private:
    double told_by(const LevelError& error) const;
    struct Sampled
    {
        std::size_t level = 0;
        std::vector<std::string> objects;
        EstimateSample found;
    };

    model::TypeSource& types_;
    std::string unit_;
    double interval_ = 0;                                           ///< s
    std::vector<std::unique_ptr<simulation::Simulation>> courses_;  ///< by level
    std::vector<IslandEnergies> energies_;                          ///< of these beside the exact one, if they count
    std::vector<Sampled> samples_;
};

}  // namespace plab::study
