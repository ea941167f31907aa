/// One step of one island by sub-steps with soft contacts (soft_step.h), for either kind of packets of its contact points.
#pragma once

#include <vector>

#include "soft_step.h"

namespace plab::managers
{

template <int W>
class SoftIsland
{
public:
    SoftIsland(Island& island, Bodies& bodies, Shafts& shafts, const SoftChoices& choices, SoftMemory& memory, PacketList<W>& contacts,
               std::vector<SoftPoint<W>>& soft);
    Verdict run();

private:
    void start();
    void kick();
    void apply();
    void write();
    void move();
    void turn();
    void relax();
    bool gains() const;
    int step_hard();
    bool scale_down();
    void sweep_lines(bool soft);
    int remove_gained_energy();
    void gather();
    void note_kicks(bool before);
    void count_travel();
    void note_limits();
    void clear_impulses();
    void scale_impulses(double share);
    double bounce(double share);
    void bounce_with_limits(double share);
    void give_back();
    void finish(Verdict& out);

    Island& island_;
    Bodies& bodies_;
    Shafts& shafts_;
    const SoftChoices& choices_;
    SoftMemory& memory_;
    Problem& problem_;
    PacketList<W>& contacts_;  ///< the contact points; those of problem_ serve to load it and to report
    std::vector<SoftPoint<W>>& soft_;
    double h_;
    SoftSweep sweep_;
    bool bounces_ = false;
    bool applied_ = false;  ///< the impulses have been applied in an earlier sub-step of this step
    bool driven_ = false;   ///< the motion of other bodies may add energy at a contact
    double most_ = 0;       ///< J: kinetic energy after the sub-step's kick, which contacts must not exceed
    bool limits_bounce_ = false;
    double allowed_ = 0;  ///< J: kinetic energy at the start of the step plus the work of the forces since
};

}  // namespace plab::managers
