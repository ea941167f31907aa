/// How stiff the active contacts and rows of Newton's method are, from one of its steps to the next.
#pragma once

#include <algorithm>

namespace plab::managers
{

/// kappa of law_of() (contact_law.h): the stiffness rho of an active contact is kappa / K.
inline constexpr double kSoftest = 1e2, kUsualStiffness = 1e6, kMostStiffness = 1e12;

/// A step that multiplies the violation by more has gone too far.
inline constexpr double kTooFar = 2;

/// kappa from one Newton step to the next.
class Stiffness
{
public:
    double kappa() const { return kappa_; }
    /// Convergence is slow where masses differ much: the contacts then need a larger stiffness. Not where it is slow because points have
    /// changed their pieces, and not once the residual is at the level of rounding: a larger stiffness only amplifies rounding, and the
    /// disagreement between redundant contacts.
    void adapt(bool same_pieces, double before, double now, double tolerance)
    {
        raised_ = same_pieces && now > 0.05 * before && now > tolerance;
        if (raised_) kappa_ = std::min(most_, kappa_ * kFactor);
    }
    /// Where the step has gone too far: points that barely press change their impulses by much, and so their pieces, if the stiffness is
    /// large; and rounding grows with it. False if it is as low as it may be.
    bool lower()
    {
        raised_ = false;
        if (kappa_ <= kSoftest) return false;
        most_ = kappa_ /= kFactor;
        return true;
    }
    /// Whether a step with a larger stiffness, in the same pieces, has changed nothing: rows contradict one another.
    bool makes_no_difference(bool same_pieces, double before, double now)
    {
        return is_useless_ = raised_ && same_pieces && now > 0.99 * before && now < kTooFar * before;
    }
    bool is_useless() const { return is_useless_; }

private:
    static constexpr double kFactor = 1e2;
    double kappa_ = kUsualStiffness, most_ = kMostStiffness;
    bool raised_ = false, is_useless_ = false;
};

}  // namespace plab::managers
