#include "decision_costs.h"

#include <algorithm>

#include "cost_model.h"

namespace plab::governors
{
namespace
{

bool tells(const Reals& measured) { return measured.size() >= 2 && measured[0] > 0; }

double seconds_of(const Reals& measured, double step)
{
    return measured[1] + (measured.size() > 2 && step > kLeastCost ? std::max(0.0, measured[2] - step) : 0.0);
}

}  // namespace

void learn_exchange(Reals& learnt, Reals& measured, double step)
{
    if (!tells(measured)) return;
    const double n = measured[0], seconds = seconds_of(measured, step);
    constexpr std::size_t kCosts = 2, kSize = kCosts + kCosts * kCosts;
    constexpr double kOpposed = -0.9;  // correlation of what is not known of f and e
    if (learnt.size() != kSize)
    {
        const double f = 0.5 * seconds, e = 0.5 * seconds / n;
        learnt = {f, e, f * f, kOpposed * f * e, kOpposed * f * e, e * e};
    }
    else
        CostModel(learnt, kCosts).update(Reals{1 / (1 + n), n / (1 + n)}, seconds / (1 + n));
    measured.clear();
}

void learn_trial(double& learnt, Reals& measured, double step)
{
    if (!tells(measured)) return;
    constexpr double kMost = 2;  // times as long: one of them may be an accident of the machine
    double seconds = seconds_of(measured, step) / measured[0];
    if (learnt > 0) seconds = std::min(seconds, kMost * learnt);
    learnt = std::max(seconds, learnt + (seconds - learnt) / 4);
    measured.clear();
}

}  // namespace plab::governors
