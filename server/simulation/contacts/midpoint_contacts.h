/// Midpoint contacts: second-order time stepping for bodies that roll or slide along curved surfaces.
///
/// Consider a ball that rolls in a bowl. Time stepping that uses the contact normal at the start of the step keeps the velocity tangential
/// to a surface that has turned away by the end of the step. The body leaves the curve by O(h^2) in every step, which gives a method of
/// first order. The midpoint rule avoids this: evaluate the constraint in the middle of the step.
///   1. Advance the bodies by half a step in a straight line with their velocities v0 (advance_to_midpoint).
///   2. Detect the contacts there; take normals n, contact points and forces from the midpoint (update_contacts).
///   3. Solve for the impulses, which change v0 to v1.
///   4. Move the poses by h (v0 + v1) / 2, starting from the start of the step (take_back removes the half step).
/// What remains is the curvature itself. If the gap is g0 at the start and gm at the midpoint,
///
///   c = gm - g0 - (h / 2) n0 . (vb0 - va0)      is what the curvature alone opens the gap by in half a step, and
///   n . u1 >= -4 c / h                          requires the velocity u1 at the end of the step to be tangential to the curve there
///                                               (Contact::turning).
///
/// It requires no more than the speed at which the bodies close along n in the beginning: where a surface has a fold instead of a curve,
/// the body would be thrown off otherwise.
/// So a body that starts along the curve ends along it and keeps its speed and its gap, with an error of third order in h per step: the
/// midpoint rule on the curve, of order 2. If the condition would need a pulling impulse, the impulse is zero: the body leaves the curve,
/// at a time that is correct to order 2.
///
/// Contacts that have a pivot (plab/collision.h) are left to managers that put them midway themselves (TypeInfo::pivots_up_to), but for
/// those of balls, and in islands that need this for another contact.
///
/// Limits: orientations are advanced for the forces but not for the contacts, so a curve that rotates with its body (a tumbling capsule)
/// stays at order 1, and so do pivots (Contact::pivot) in its island. Forces that depend on velocities are evaluated with v0. Joints would
/// not be satisfied at the midpoint, and kinematic bodies are not advanced to it, so islands that contain either are stepped without this.
///
/// Source: the midpoint rule for constrained motion, Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), VII.1.
#pragma once

#include <span>
#include <vector>

#include "simulation/contacts/contact_book.h"

namespace plab::simulation
{

class MidpointContacts
{
public:
    MidpointContacts(StepState& step, ContactBook& contacts) : step_(step), contacts_(contacts) {}

    /// Whether two round bodies move along one another so far in h (s) that the rotation of their normal matters.
    bool turns(const Contact& contact, double h) const;
    /// Whether one of the bodies is kinematic. It cannot be advanced to the midpoint, so no body of its island may be.
    bool is_driven(const Contact& contact) const;
    /// To be called after system.begin(), for each island: the next evaluation puts its members (indices into system.bodies()) half a step
    /// ahead.
    void advance_to_midpoint(GroupSystem& system, std::span<const std::uint32_t> members, double h);
    /// To be called after that evaluation: gives the contacts at the indices `places` (ascending) of `all`, which are those of the
    /// advanced bodies, their normals, points and Contact::turning of the midpoint. Orientations are reset to those of the start; positions
    /// stay at the midpoint.
    void update_contacts(std::span<const std::uint32_t> places, std::vector<FoundContact>& all, double h);
    /// To be called when the step is made: removes the half step from the positions.
    void take_back();

private:
    struct Advanced
    {
        std::uint32_t body = 0;  ///< host row
        Vec3 displacement;       ///< m
        Quat start;
    };
    Vec3 displacement_of(Ref body) const { return displacements_[body.index]; }
    double margin_of(const Contact& contact) const;
    void query(std::span<const std::uint32_t> places, const std::vector<FoundContact>& all);

    StepState& step_;
    ContactBook& contacts_;
    std::vector<Advanced> advanced_;
    std::vector<Vec3> displacements_;  ///< m, by host row; zero between steps
    std::vector<FoundContact> midpoint_;
    std::vector<PersistentPair> persistent_;
};

}  // namespace plab::simulation
