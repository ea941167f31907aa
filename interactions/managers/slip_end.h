/// Splits a time step at the instants where sliding ends.
///
/// While a contact slides, friction is mu j_n against the slip; once it sticks, friction is whatever holds it. A fixed step
/// would apply one of the two laws over the whole step, and a sliding body would stop at an instant that depends on the step
/// length. Between two such instants all accelerations are constant, so the slip speed falls linearly and its zero can be
/// computed: a shorter part of the step, in which all contacts still slide, is tried first, and the slip speeds before and after
/// it are extrapolated to zero. The step is cut at the first zero, and the rest is solved in the same way, with at most 8 cuts.
/// A body that slides to a stop therefore comes to rest at the right place, whatever the step length h. Islands with stiff servos are
/// stepped at once: their forces change within the step, so slip does not fall linearly, and nearly each step would be cut eight times.
#pragma once

#include "stepping.h"

namespace plab::managers
{

class SlipEnds
{
public:
    SlipEnds(Island& island, Bodies& bodies, Shafts& shafts, Method& method, double slop, StepMemory& memory)
        : island_(island), bodies_(bodies), shafts_(shafts), method_(method), slop_(slop), memory_(memory)
    {
    }
    /// Applies forces, impulses and motion of the whole step; leaves the sum of the impulses in the island.
    Verdict advance();

private:
    Verdict try_part(double h);
    /// The first instant, in a part of length h that has just been tried, at which a contact stops sliding; h if there is none.
    double first_end(double h);
    bool slides(std::size_t i) const;
    double slip_left(std::size_t i) const;
    void keep_impulses();
    /// Starts the next solve, of a part of h (s), from the `present` impulses, which are of a part of that length (s), or from those that
    /// were kept of the whole `rest` (s) of the step.
    void start_with(double h, double present, double rest);
    void move(const Verdict& found, double h);

    Island& island_;
    Bodies& bodies_;
    Shafts& shafts_;
    Method& method_;
    double slop_;
    StepMemory& memory_;
    double done_ = 0;       ///< s
    bool retried_ = false;  ///< first_end has tried other parts since
    double tried_ = 0;      ///< s, length of the part that was tried last
    double no_slip_ = 0;    ///< m/s, slower slip counts as none
};

}  // namespace plab::managers
