/// What governors promise, checked afterwards: the true errors of the levels that a run had (plab-study --verify-levels).
///
/// A governor by error states that each component departs within `interval` by less than `bound` from where the most exact level would take
/// it. So from the state at the begin of each interval a second simulation continues with the most exact level for all components of the
/// governor, and decides nothing. The error of a component is the largest departure of its objects at any step of the interval, in the unit
/// of the governor; in W, the most energy that its island has more or less at any step, divided by the interval (island_energy.h).
/// Intervals in which the component had the most exact level all the time do not count, because there is nothing to promise; nor do, in
/// pixels, those in which no viewer sees it. In some intervals it is also checked what the trial steps tell on which the governor relies
/// (estimates.h).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "model/scene.h"
#include "model/type_registry.h"
#include "plab/interruption.h"
#include "plab/result.h"
#include "simulation/simulation.h"
#include "study/estimates.h"

namespace plab::study
{

/// One component in one interval.
struct VerifiedLevel
{
    std::string component, level;  ///< level: that it had at the end
    double begin = 0, error = 0;   ///< s; in the governor's unit
};

struct VerifiedInterval
{
    double begin = 0;                   ///< s
    std::size_t counted = 0, held = 0;  ///< components; those whose error was at most the bound
    VerifiedLevel worst;
};

struct VerifiedGovernor
{
    std::string id, type, unit;
    double bound = 0, interval = 0;  ///< in the unit; s
    std::size_t components = 0;      ///< that it watches
    double confidence = 0;           ///< that it stated at the end
    std::vector<VerifiedInterval> intervals;
    std::vector<EstimateSample> estimates;  ///< in some of the intervals, of some components

    std::size_t counted() const;
    std::size_t held() const;
    /// Of the counted ones; 1 if there are none.
    double share() const;
    /// The largest error; null: nothing was counted.
    const VerifiedLevel* worst() const;
};

struct VerifyResult
{
    std::string title, source, command;  ///< source: the file
    double from = 0, until = 0;          ///< s
    std::size_t objects = 0;             ///< that move
    std::vector<VerifiedGovernor> governors;
};

/// Follows a run and measures.
class LevelVerifier
{
public:
    explicit LevelVerifier(model::TypeSource& types);
    ~LevelVerifier();
    LevelVerifier(const LevelVerifier&) = delete;
    LevelVerifier& operator=(const LevelVerifier&) = delete;

    /// To be called at each boundary, before the step and before anything is decided. Errors: a state cannot be continued;
    /// a governor counts in W, and a component does not say whose the energy is that it stores.
    Result<void> at_boundary(simulation::Simulation& run);
    /// What was measured; intervals that are not over are left out. An error if no governor of the run states a bound.
    Result<VerifyResult> take();

private:
    class Window;
    Result<void> begin_run(const simulation::Simulation& run);

    model::TypeSource& types_;
    std::vector<std::unique_ptr<Window>> windows_;  ///< one for each governor
    std::uint64_t run_ = 0;
    bool begun_ = false;
    VerifyResult out_;
};

struct VerifyPlan
{
    std::string file, command;  ///< a blueprint or a recording (.mcap)
    double until = -1;          ///< s; negative: to the end of the recording
    const Interruption* stop = nullptr;
    std::function<void(const std::string&)> progress;
};

/// Runs the scene, or replays the recording, and checks all of its governors that state a bound.
Result<VerifyResult> verify_levels(model::TypeSource& types, const VerifyPlan& plan);

std::vector<std::string> verify_findings(const VerifyResult& result);
/// Writes levels.csv, one line for each interval of each governor, and estimates.csv, one line for each estimate that was checked.
Result<void> write_verified(const VerifyResult& result, const std::string& folder);

}  // namespace plab::study
