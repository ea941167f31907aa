/// What trial steps have shown of the errors of levels, for all components of a kind together.
#pragma once

#include <span>

#include "plab/value.h"

namespace plab::governors
{

/// The root mean square of the errors of each level, for components that act on the same number of objects and have the same level now: a
/// few trials tell about all that are alike. What a component had until now matters, because a level that damps leaves little to be wrong
/// about, and what was exact until now still has all of its motion. Newer trials count more.
class ErrorTable
{
public:
    /// `state`: for each kind the number of objects, the present level, the number of trials, and the mean square of the error (m^2) of
    /// each level. It has to outlive this object.
    ErrorTable(Reals& state, std::size_t levels) : state_(state), n_(levels) {}

    /// `errors`: m, of each level against the most exact one, for a component of this kind. The first one for so many objects tells of all
    /// levels that such a component may have, as long as no trial of those does.
    void add(std::uint32_t objects, std::int32_t present, std::span<const double> errors);
    /// 0: nothing is known of the kind.
    double trials(std::uint32_t objects, std::int32_t present) const;
    /// Of components with this number of objects, whatever level they had.
    double trials(std::uint32_t objects) const;
    /// m, of each level, falling from level to level. Of a kind without trials, what those have shown that act on as many objects with
    /// another level, the one with the most trials; of levels without any trials, and of those that did not differ in any, it is 1e-12 m
    /// for each finer level, so that finer is still better.
    Reals errors(std::uint32_t objects, std::int32_t present) const;

private:
    std::size_t width() const { return 3 + n_; }
    bool is_known(std::size_t at) const { return at + width() <= state_.size(); }
    bool knows(std::uint32_t objects) const;
    std::size_t place_for(std::uint32_t objects, std::int32_t present);
    std::size_t place_of(std::uint32_t objects, std::int32_t present) const;
    std::size_t place_that_tells(std::uint32_t objects, std::int32_t present) const;

    Reals& state_;
    std::size_t n_;
};

}  // namespace plab::governors
