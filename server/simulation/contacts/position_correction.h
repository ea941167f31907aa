/// Position correction: removes the overlap that time stepping leaves in persistent contacts by translating and rotating the bodies. The
/// velocities stay as they are, so the correction adds no kinetic energy (unlike Baumgarte stabilisation).
///
/// Nonlinear Gauss-Seidel on positions (Mueller et al., Position based dynamics, 2007; Deul et al. for rigid bodies, 2016). For each
/// contact in turn, a positional impulse along the normal removes its depth:
///   lambda = depth / K,  K = 1/ma + 1/mb + (ra x n) . Ia^-1 (ra x n) + (rb x n) . Ib^-1 (rb x n)
/// where K is the effective inverse mass at the contact point. The rotation matters: translating the whole body by the depth of its
/// deepest corner would lift the other corners off, and the body would rock for ever.
///
/// Moving a body against a force (gravity, mostly) changes its potential energy. This is booked as ContactEnergy::by_correction, so that
/// the energy ledger still balances.
#pragma once

#include "simulation/contacts/contact_book.h"
#include "simulation/motion/group_motion.h"

namespace plab::simulation
{

class PositionCorrection
{
public:
    PositionCorrection(StepState& step, GroupMotion& motion, ContactBook& contacts) : step_(step), motion_(motion), contacts_(contacts) {}

    /// Gradually removes the overlap that is left when a spring contact was exchanged for a hard one (KnownContact::rest_depth).
    void ease_overlaps();
    /// Removes the overlap of persistent pairs whose response is impulses; managers (held_islands.h) correct their own.
    void correct_positions();
    /// Stores the forces other than contacts on the members of a system, as evaluated last: the correction lifts bodies against them.
    void note_forces(const GroupSystem& system);

private:
    struct Eased
    {
        KnownContact* known = nullptr;
        FoundContact* found = nullptr;
    };
    /// The force on a body other than contacts, N, with the step in which it was evaluated.
    struct KnownForce
    {
        Vec3 force;
        std::uint64_t serial = 0;  ///< of the step
    };
    void separate(std::span<const FoundContact> contacts);
    Vec3 force_on(Ref body);
    void ease_pair(PairState& pair);
    double share_of_overlap_left(const PairState& pair, std::span<const Eased> eased) const;

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    std::vector<KnownForce> known_force_;  ///< by body; filled for bodies that Response/Impulse advances or that are corrected
    std::vector<Eased> eased_;
};

}  // namespace plab::simulation
