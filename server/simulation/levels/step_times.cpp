#include "simulation/levels/step_times.h"

#include <algorithm>
#include <array>

namespace plab::simulation
{
namespace
{

constexpr std::size_t kMostSteps = 1024;  ///< of which the median is taken
constexpr std::size_t kMemory = 512;      ///< ratios
constexpr std::size_t kFew = 4;           ///< a median of fewer steps is chance
constexpr std::size_t kRecent = 7;

}  // namespace

double StepTimes::at_share(const std::vector<StepCost>& of, double StepCost::*clock, double share) const
{
    sorted_.clear();
    for (const StepCost& c : of) sorted_.push_back(c.*clock);
    const auto at = sorted_.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted_.size() - 1));
    std::nth_element(sorted_.begin(), at, sorted_.end());
    return *at;
}

void StepTimes::add(const StepCost& step)
{
    // At once, as a warm step asks for no memory.
    if (steps_.capacity() == 0) steps_.reserve(kMostSteps), ratios_.reserve(kMemory), sorted_.reserve(kMostSteps);
    if (steps_.size() < kMostSteps) steps_.push_back(step);
}

void StepTimes::begin_anew()
{
    note_ratios(expected_);
    steps_.clear(), expected_ = {};
}

void StepTimes::go_on()
{
    const StepCost now = usual();
    note_ratios(expected_);
    steps_.clear(), expected_ = now;
}

void StepTimes::note_ratios(const StepCost& expected)
{
    StepCost by = usual();
    if (expected.wall > 0 && expected.processor > 0) by = {std::min(by.wall, expected.wall), std::min(by.processor, expected.processor)};
    if (steps_.size() < kFew || !(by.wall > 0) || !(by.processor > 0)) return;
    for (const StepCost& step : steps_)
    {
        const StepCost ratio{step.wall / by.wall, step.processor / by.processor};
        if (ratios_.size() < kMemory)
            ratios_.push_back(ratio);
        else
            ratios_[oldest_] = ratio, oldest_ = (oldest_ + 1) % kMemory;
    }
}

StepCost StepTimes::recent() const
{
    if (steps_.size() < kRecent) return {};
    const auto of = [this](double StepCost::*clock)
    {
        std::array<double, kRecent> last;
        for (std::size_t k = 0; k < kRecent; ++k) last[k] = steps_[steps_.size() - kRecent + k].*clock;
        std::nth_element(last.begin(), last.begin() + kRecent / 2, last.end());
        return last[kRecent / 2];
    };
    return {of(&StepCost::wall), of(&StepCost::processor)};
}

StepCost StepTimes::usual() const
{
    if (steps_.empty()) return {};
    return {at_share(steps_, &StepCost::wall, 0.5), at_share(steps_, &StepCost::processor, 0.5)};
}

StepCost StepTimes::spread() const
{
    if (ratios_.empty()) return {1, 1};
    const auto of = [this](double StepCost::*clock) { return std::max(1.0, at_share(ratios_, clock, 0.99)); };
    return {of(&StepCost::wall), of(&StepCost::processor)};
}

}  // namespace plab::simulation
