/// What steps have cost of late, for governors that spend time: what is usual, and how far steps exceed it.
#pragma once

#include <cstddef>
#include <vector>

namespace plab::simulation
{

/// s, what a step costs: time that passes, and time of the processor that the stepping thread used.
struct StepCost
{
    double wall = 0, processor = 0;

    StepCost& operator+=(const StepCost& more) { return wall += more.wall, processor += more.processor, *this; }
};

/// Steps in a row are alike as long as no level changes. So the usual cost is told by the steps since the last change, but how far steps
/// exceed it by all steps of late: one of 100 is rare.
class StepTimes
{
public:
    void add(const StepCost& step);
    /// Steps to come are not like those before: levels have changed.
    void begin_anew();
    /// What the steps since then tell has been used. Those to come are taken to be like them: what they take longer, one by one or all of
    /// them, because the machine has become busy, is spread.
    void go_on();
    /// Steps since then.
    std::size_t count() const { return steps_.size(); }
    /// Their median.
    StepCost usual() const;
    /// The median of the last few of them; 0: there are fewer.
    StepCost recent() const;
    /// How many times what was usual 99 of the last 100 steps (in fact of the last 512) took at most; 1 at least, and without any steps.
    StepCost spread() const;

private:
    double at_share(const std::vector<StepCost>& of, double StepCost::*clock, double share) const;

    void note_ratios(const StepCost& expected);

    std::vector<StepCost> steps_;   ///< since the last change, or since they were used
    StepCost expected_;             ///< what was usual when steps were used last, if levels have not changed since; 0: they have
    std::vector<StepCost> ratios_;  ///< of former steps to what was usual then
    std::size_t oldest_ = 0;        ///< position in these
    mutable std::vector<double> sorted_;
};

}  // namespace plab::simulation
