#include "error_table.h"

#include <algorithm>
#include <cmath>

namespace plab::governors
{
namespace
{

constexpr double kMemory = 32;          ///< trials: older ones fade
constexpr std::size_t kMostKinds = 64;  ///< further ones count as the last one
constexpr double kLeast = 1e-12;        ///< m, by which a finer level is at least taken to be better

}  // namespace

/// The last place stands for all kinds that found no other one.
std::size_t ErrorTable::place_of(std::uint32_t objects) const
{
    std::size_t at = 0;
    while (at + width() <= state_.size() && state_[at] != static_cast<double>(objects)) at += width();
    return std::min(at, (kMostKinds - 1) * width());
}

void ErrorTable::add(std::uint32_t objects, std::span<const double> errors)
{
    const std::size_t at = place_of(objects);
    if (at + width() > state_.size()) state_.resize(at + width(), 0.0), state_[at] = static_cast<double>(objects);
    double& trials = state_[at + 1];
    trials = std::min(kMemory, trials + 1);
    for (std::size_t l = 0; l < n_; ++l)
    {
        double& mean = state_[at + 2 + l];
        mean += (errors[l] * errors[l] - mean) / trials;
    }
}

double ErrorTable::trials(std::uint32_t objects) const
{
    const std::size_t at = place_of(objects);
    return at + width() <= state_.size() ? state_[at + 1] : 0;
}

Reals ErrorTable::errors(std::uint32_t objects) const
{
    Reals out(n_, 0.0);
    const std::size_t at = place_of(objects);
    const bool known = at + width() <= state_.size();
    for (std::size_t l = n_ - 1; l-- > 0;) out[l] = std::max(known ? std::sqrt(state_[at + 2 + l]) : 0.0, out[l + 1] + kLeast);
    return out;
}

}  // namespace plab::governors
