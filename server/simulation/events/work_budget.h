/// Limits the work of event location in a step to a multiple of the work of the step without it, so that every step ends.
///
/// The budget counts operations and never seconds, so that the same run gives the same result on every machine. The unit is one group of
/// bodies advanced over one piece of the step, or one distance query; cheaper operations count as fractions of it.
#pragma once

#include <cstdint>

namespace plab::simulation
{

class WorkBudget
{
public:
    /// Units that every step has, however small its scene, unless the resolution declares a number of its own: enough for some thousand
    /// impacts of a few bodies.
    static constexpr double kBase = 100'000;
    static constexpr double kMultiple = 20;
    /// Cost in units of one sweep over one row of a contact or joint, and of one pair that the broad phase lists.
    static constexpr double kSweptRow = 1.0 / 32, kListedPair = 1.0 / 16;
    /// Cost in units of a body with its joints in one evaluation of the equations of motion: a stiff group takes hundreds of these.
    static constexpr double kHeldBody = 1.0;
    /// Cost in units of visiting one group or known pair of the scene to find out what rests on what.
    static constexpr double kGoneThrough = 1.0 / 64;

    /// Cost in units of each pair of shapes of two bodies beyond the first one; a triangle of a mesh counts as a shape.
    static constexpr double kFurtherPair = 1.0 / 4;

    /// Beside crowds, locating the impacts of the other bodies may cost as much as the rest of the step and this share of `base`; more than
    /// that, and they are not worth it (EventLocator::run).
    static constexpr double kBesideCrowds = 0x1p-5;

    /// `plain`: units that the step takes without event location.
    void begin(double plain, double multiple, double base)
    {
        spent_ = 0, allowed_ = base + multiple * plain, allowed_beside_crowds_ = kBesideCrowds * base + plain;
    }
    void spend(double units) { spent_ += units; }
    bool is_spent() const { return spent_ >= allowed_; }
    bool is_too_much_beside_crowds() const { return spent_ >= allowed_beside_crowds_; }
    double spent() const { return spent_; }
    double allowed() const { return allowed_; }

private:
    double spent_ = 0, allowed_ = 0, allowed_beside_crowds_ = 0;
};

}  // namespace plab::simulation
