/// What trial steps have shown of the errors of levels, for all components of a kind together.
#pragma once

#include <span>

#include "plab/value.h"

namespace plab::governors
{

/// The root mean square of the errors of each level, for components that act on the same number of objects: a few trials tell about all
/// that are alike. Newer trials count more.
class ErrorTable
{
public:
    /// `state`: for each kind the number of objects, the number of trials, and the mean square of the error (m^2) of each level. It has to
    /// outlive this object.
    ErrorTable(Reals& state, std::size_t levels) : state_(state), n_(levels) {}

    /// `errors`: m, of each level against the most exact one.
    void add(std::uint32_t objects, std::span<const double> errors);
    /// 0: nothing is known of the kind.
    double trials(std::uint32_t objects) const;
    /// m, of each level, falling from level to level: of a kind without trials, and of levels that did not differ in any, it is 1e-12 m for
    /// each finer level, so that finer is still better.
    Reals errors(std::uint32_t objects) const;

private:
    std::size_t width() const { return 2 + n_; }
    std::size_t place_of(std::uint32_t objects) const;

    Reals& state_;
    std::size_t n_;
};

}  // namespace plab::governors
