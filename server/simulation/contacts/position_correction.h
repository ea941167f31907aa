/// What time stepping leaves in overlap is parted again, by moving and turning: speeds stay as they are.
///
/// Nonlinear Gauss-Seidel on positions (Mueller et al., Position based dynamics, 2007; Deul et al. for rigid bodies, 2016):
///   lambda = depth / K,  K = 1/ma + 1/mb + (ra x n) . Ia^-1 (ra x n) + (rb x n) . Ib^-1 (rb x n)
/// A shift of the whole body by its deepest corner would lift the other corners and feed its rocking for ever.
#pragma once

#include "simulation/contacts/contact_book.h"
#include "simulation/motion/group_motion.h"

namespace plab::simulation
{

class PositionCorrection
{
public:
    PositionCorrection(StepState& step, GroupMotion& motion, ContactBook& contacts) : step_(step), motion_(motion), contacts_(contacts) {}

    /// What a swap from springs left is taken out by and by.
    void ease_overlaps();
    /// Overlaps of standing pairs whose response is impulses.
    void correct_positions();
    /// What acts on the members of a system besides contacts, as evaluated last: parting lifts them against it.
    void note_forces(const GroupSystem& system);

private:
    struct Eased
    {
        KnownContact* known = nullptr;
        FoundContact* found = nullptr;
    };
    /// What acts on a body besides contacts, N, as known in a step.
    struct KnownForce
    {
        Vec3 force;
        std::uint64_t serial = 0;  ///< of the step
    };
    void part(std::span<const FoundContact> contacts);
    Vec3 force_on(Ref body);
    void ease_pair(PairState& pair);
    double share_of_overlap_left(const PairState& pair, std::span<const Eased> eased) const;

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    std::vector<KnownForce> known_force_;  ///< by body, where Response/Impulse advances it or parts it from others
    std::vector<Eased> eased_;
};

}  // namespace plab::simulation
