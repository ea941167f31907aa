#include "error_table.h"

#include <algorithm>
#include <cmath>

namespace plab::governors
{
namespace
{

constexpr double kMemory = 12;          ///< trials: older ones fade, because the motion of all changes with time
constexpr std::size_t kMostKinds = 64;  ///< further ones count as the last one
constexpr double kHearsay = 0.5;        ///< trials, that the first one of another level counts
constexpr double kLeast = 1e-12;        ///< m, by which a finer level is at least taken to be better

}  // namespace

/// The last place stands for all kinds that found no other one.
std::size_t ErrorTable::place_of(std::uint32_t objects, std::int32_t present) const
{
    const auto is_it = [&](std::size_t at)
    { return state_[at] == static_cast<double>(objects) && state_[at + 1] == static_cast<double>(present); };
    std::size_t at = 0;
    while (is_known(at) && !is_it(at)) at += width();
    return std::min(at, (kMostKinds - 1) * width());
}

/// The same, made if there is none.
std::size_t ErrorTable::place_for(std::uint32_t objects, std::int32_t present)
{
    const std::size_t at = place_of(objects, present);
    if (is_known(at)) return at;
    state_.resize(at + width(), 0.0);
    state_[at] = static_cast<double>(objects), state_[at + 1] = static_cast<double>(present);
    return at;
}

bool ErrorTable::knows(std::uint32_t objects) const
{
    for (std::size_t at = 0; is_known(at); at += width())
        if (state_[at] == static_cast<double>(objects)) return true;
    return false;
}

void ErrorTable::add(std::uint32_t objects, std::int32_t present, std::span<const double> errors)
{
    const bool is_first = !knows(objects);
    const std::size_t at = place_for(objects, present);
    // Before anything has changed its level, what is true of one level is true of all.
    for (std::size_t l = 0; l < n_ && is_first; ++l)
        if (const auto level = static_cast<std::int32_t>(l); !is_known(place_of(objects, level)))
        {
            const std::size_t other = place_for(objects, level);
            state_[other + 2] = kHearsay;
            for (std::size_t k = 0; k < n_; ++k) state_[other + 3 + k] = errors[k] * errors[k];
        }
    double& trials = state_[at + 2];
    trials = std::min(kMemory, trials + 1);
    for (std::size_t l = 0; l < n_; ++l)
    {
        double& mean = state_[at + 3 + l];
        mean += (errors[l] * errors[l] - mean) / trials;
    }
}

double ErrorTable::trials(std::uint32_t objects, std::int32_t present) const
{
    const std::size_t at = place_of(objects, present);
    return is_known(at) ? std::floor(state_[at + 2]) : 0;
}

double ErrorTable::trials(std::uint32_t objects) const
{
    double out = 0;
    for (std::size_t at = 0; is_known(at); at += width())
        if (state_[at] == static_cast<double>(objects)) out += std::floor(state_[at + 2]);
    return out;
}

/// Its own place, or the one of as many objects with the most trials.
std::size_t ErrorTable::place_that_tells(std::uint32_t objects, std::int32_t present) const
{
    std::size_t best = place_of(objects, present);
    if (is_known(best)) return best;
    for (std::size_t at = 0; is_known(at); at += width())
        if (state_[at] == static_cast<double>(objects) && (!is_known(best) || state_[at + 2] > state_[best + 2])) best = at;
    return best;
}

Reals ErrorTable::errors(std::uint32_t objects, std::int32_t present) const
{
    Reals out(n_, 0.0);
    const std::size_t at = place_that_tells(objects, present);
    const bool known = is_known(at);
    for (std::size_t l = n_ - 1; l-- > 0;) out[l] = std::max(known ? std::sqrt(state_[at + 3 + l]) : 0.0, out[l + 1] + kLeast);
    return out;
}

}  // namespace plab::governors
