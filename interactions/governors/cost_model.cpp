#include "cost_model.h"

#include <algorithm>
#include <cmath>

namespace plab::governors
{
namespace
{

/// Of a level that has not been seen: each finer one is taken to cost three times as much.
constexpr double kDearer = 3;
/// Standard deviations relative to the cost: of such a guess, of a measurement, of what a cost changes from one look to the next, and of a
/// difference between trial steps.
constexpr double kGuess = 1, kNoise = 0.1, kDrift = 0.03, kTrial = 0.3;

}  // namespace

double CostModel::deviation(std::size_t level) const { return std::sqrt(std::max(0.0, state_[n_ + level * n_ + level])); }

void CostModel::begin(std::span<const double> fraction, double cost)
{
    // The level that most components have costs about what was measured.
    const auto most = static_cast<std::size_t>(std::max_element(fraction.begin(), fraction.end()) - fraction.begin());
    state_.assign(n_ + n_ * n_, 0.0);
    for (std::size_t k = 0; k < n_; ++k)
    {
        state_[k] = cost * std::pow(kDearer, static_cast<double>(k) - static_cast<double>(most));
        covariance(k, k) = kGuess * kGuess * state_[k] * state_[k];
    }
}

void CostModel::update(std::span<const double> fraction, double cost)
{
    if (!is_known()) begin(fraction, cost);
    // Only a level in use drifts away from what is known of it.
    for (std::size_t i = 0; i < n_; ++i)
        if (fraction[i] > 0) covariance(i, i) += kDrift * kDrift * state_[i] * state_[i];
    observe(fraction, cost, kNoise * kNoise * cost * cost);
}

void CostModel::update_difference(std::size_t level, double more)
{
    if (!is_known() || level == 0 || level >= n_) return;
    Reals weight(n_, 0.0);
    weight[level] = 1, weight[level - 1] = -1;
    const double deviation = kTrial * std::fabs(more);
    if (this->deviation(level) > 0.9 * kGuess * cost(level))
    {
        // A guess says nothing against a trial: the level costs what the one below does, and this much more.
        state_[level] = std::max(0.0, state_[level - 1] + more);
        for (std::size_t k = 0; k < n_; ++k)
            if (k != level) covariance(level, k) = covariance(k, level) = covariance(level - 1, k);
        covariance(level, level) = covariance(level - 1, level - 1) + deviation * deviation;
        return;
    }
    // Trials err in the same way each time, so they must not be averaged: they only replace what is known less well.
    if (variance_of(weight) <= 4 * deviation * deviation) return;
    observe(weight, more, deviation * deviation);
}

double CostModel::variance_of(std::span<const double> weight) const
{
    double out = 0;
    for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t k = 0; k < n_; ++k) out += weight[i] * state_[n_ + i * n_ + k] * weight[k];
    return out;
}

void CostModel::observe(std::span<const double> weight, double value, double variance)
{
    Reals gain(n_, 0.0);  // P w, then the gain
    double expected = 0;
    for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t k = 0; k < n_; ++k) gain[i] += covariance(i, k) * weight[k];
    for (std::size_t i = 0; i < n_; ++i) expected += weight[i] * state_[i], variance += weight[i] * gain[i];
    if (!(variance > 0)) return;
    for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t k = 0; k < n_; ++k) covariance(i, k) -= gain[i] * gain[k] / variance;
    for (std::size_t i = 0; i < n_; ++i) state_[i] = std::max(0.0, state_[i] + gain[i] / variance * (value - expected));
}

}  // namespace plab::governors
