/// Standing contacts that impulses hold, whoever answers them: managers (held_islands.h) or responses (impulse_islands.h); and, at the end
/// of a step, what becomes of every pair that is known.
#pragma once

#include "simulation/contacts/held_islands.h"
#include "simulation/contacts/impulse_islands.h"

namespace plab::simulation
{

class HardContacts
{
public:
    HardContacts(StepState& step, GroupMotion& motion, ContactBook& contacts)
        : step_(step),
          motion_(motion),
          contacts_(contacts),
          positions_(step, motion, contacts),
          held_(step, motion, contacts),
          impulses_(step, motion, contacts, positions_)
    {
    }

    /// After any structural change.
    void rebuild() { held_.rebuild(); }
    void begin_step();
    /// Whether anybody has to advance with others because of a standing contact, or a joint that only a manager can hold.
    bool any_stands() const;
    /// Whether a group has such a joint in this step.
    bool holds_joints_of(std::uint32_t group) const { return held_.holds_joints_of(group); }
    /// Groups with a standing contact, from where they are: each island by itself.
    void advance(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed, double from, double to, WorkBook book,
                 bool trial);
    /// With the contacts of the step's end in found(): which begin, persist and end; overlap is parted.
    void finish_step();

private:
    void update_pair(PairState& pair, std::span<FoundContact> found);

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    PositionCorrection positions_;
    HeldIslands held_;
    ImpulseIslands impulses_;
    DisjointSets islands_;
    std::vector<std::uint32_t> groups_, island_;
    std::vector<std::uint8_t> done_;  ///< by group
};

}  // namespace plab::simulation
