/// What a step costs by the levels of the watched components, learnt from the costs of past steps.
#pragma once

#include <span>

#include "plab/value.h"

namespace plab::governors
{

/// The step costs sum_l f_l c_l, where f_l is the fraction of the components at level l and c_l the cost of a step with all of them at that
/// level. A Kalman filter with the random walk c <- c + w estimates c from the costs that are measured. What is measured may be all that a
/// level costs: more evaluations of forces and constraints too, which are in no account of the component itself.
/// Source: R. E. Kalman, A new approach to linear filtering and prediction problems, J. Basic Eng. 82 (1960).
class CostModel
{
public:
    /// `state`: the n means (s) and then the n x n covariance (s^2); it is filled at the first update. It has to outlive this object.
    CostModel(Reals& state, std::size_t levels) : state_(state), n_(levels) {}

    bool is_known() const { return state_.size() == n_ + n_ * n_; }
    /// `fraction`: of the components at each level, sum 1. `cost`: s.
    void update(std::span<const double> fraction, double cost);
    /// What trial steps say: a step with all components at the level costs this much more (s) than one with all of them at the level
    /// below. A trial step of a few objects is not a step of all, so it counts only as long as steps have not told better. Does nothing
    /// before the first update.
    void update_difference(std::size_t level, double more);
    /// s: the cost of a step with all components at this level, and its standard deviation.
    double cost(std::size_t level) const { return state_[level]; }
    double deviation(std::size_t level) const;

private:
    double& covariance(std::size_t i, std::size_t k) { return state_[n_ + i * n_ + k]; }
    void begin(std::span<const double> fraction, double cost);
    /// `value` = sum_l weight_l c_l was measured, with this variance.
    void observe(std::span<const double> weight, double value, double variance);
    double variance_of(std::span<const double> weight) const;

    Reals& state_;
    std::size_t n_;
};

}  // namespace plab::governors
