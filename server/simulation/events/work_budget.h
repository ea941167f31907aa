/// How much a step may do to locate events: a multiple of what it does without, so that every step ends.
///
/// Counted are operations, never seconds: the same run spends the same everywhere. The unit is one group of bodies advanced over one piece
/// of the step, or one distance measured; what is cheaper counts as a share of it.
#pragma once

#include <cstdint>

namespace plab::simulation
{

class WorkBudget
{
public:
    /// Units that every step has, however small its scene: some thousand impacts of a few bodies.
    static constexpr double kBase = 100'000;
    static constexpr double kMultiple = 20;
    /// One sweep over one row of a contact or joint, and one pair that a list of neighbours names, in units.
    static constexpr double kSweptRow = 1.0 / 32, kListedPair = 1.0 / 16;
    /// One group or known pair of the scene, gone through to find out what stands on what, in units.
    static constexpr double kGoneThrough = 1.0 / 64;

    /// One pair of shapes beyond the first of a pair of bodies, a triangle too, in units.
    static constexpr double kFurtherPair = 1.0 / 4;

    /// `plain`: units that the step takes without locating.
    void begin(double plain, double multiple) { spent_ = 0, allowed_ = kBase + multiple * plain; }
    void spend(double units) { spent_ += units; }
    bool is_spent() const { return spent_ >= allowed_; }
    double spent() const { return spent_; }
    double allowed() const { return allowed_; }

private:
    double spent_ = 0, allowed_ = 0;
};

}  // namespace plab::simulation
