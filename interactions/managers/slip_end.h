/// A step that is cut where slip ends: before it friction is mu j_n against the slip, after it whatever holds. Between
/// cuts all accelerations are constant, so a body that slides to a stop stands where it should, whatever h is.
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
    /// Kick, impulses and motion of the whole step; leaves the sum of the impulses in the island.
    Verdict advance();

private:
    Verdict try_part(double h);
    void take_back();
    void keep_speeds();
    /// The first end of slip in a part of length h that was just tried; h if there is none.
    double first_end(double h);
    bool slides(std::size_t i) const;
    double slip_left(std::size_t i) const;
    void move(const Verdict& found, double h);

    Island& island_;
    Bodies& bodies_;
    Shafts& shafts_;
    Method& method_;
    double slop_;
    StepMemory& memory_;
    double done_ = 0;      ///< s
    bool looked_ = false;  ///< first_end tried other parts
    double tried_ = 0;     ///< s, the last part that was tried
    double no_slip_ = 0;   ///< m/s
};

}  // namespace plab::managers
