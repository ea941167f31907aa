/// Contacts of bodies that roll or slide along one another's curves, half way through the step.
///
/// Time stepping with the normal of the step's start is of first order there: at the end of the step the bodies move square to a normal
/// that is no longer theirs, and are off the curve. So bodies are led half a step ahead, in a straight line with the speeds v0 that they
/// have; forces, normals n and points are taken there; impulses change the speeds, and poses go on by h (v0 + v1) / 2 from where the step
/// began. Of a gap g that is g0 at the start and gm half way,
///
///   c = gm - g0 - (h / 2) n0 . (vb0 - va0)      what the curves alone open it by,
///   n . u1 >= -4 c / h                          is motion square to the normal of the step's end (Contact::turning),
///
/// so a body that starts along the curve ends along it, keeps its speed, and its gap, to third order in h a step: the midpoint rule on the
/// curve, of order 2. Where that asks for an impulse that pulls, there is none: the body leaves the curve, at the right time to order 2.
/// Attitudes are led for forces, and not for contacts: what turns with its curve (a capsule that tumbles) gets order 1 as before. Forces
/// that depend on speeds are taken with v0. Joints would not hold half way, and who moves as told is not led: nor are islands with such.
///
/// Source: the midpoint rule for constrained motion, Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), VII.1.
#pragma once

#include <span>
#include <vector>

#include "simulation/contacts/contact_book.h"

namespace plab::simulation
{

class MidwayContacts
{
public:
    MidwayContacts(StepState& step, ContactBook& contacts) : step_(step), contacts_(contacts) {}

    /// Whether two round bodies move along one another so far in h (s) that their normal turns.
    bool turns(const Contact& contact, double h) const;
    /// Whether a body of it moves as told. It is not led, so nobody of its island may be.
    bool is_driven(const Contact& contact) const;
    /// After system.begin(), for each island: its members (indices into system.bodies()) are half a step ahead in the evaluation that
    /// follows.
    void lead(GroupSystem& system, std::span<const std::uint32_t> members, double h);
    /// After the evaluation: gives the contacts at `places` (ascending) of `all`, those of who was led, their normals, points and
    /// Contact::turning half way. Attitudes are those of the start again, places stay half way.
    void bend(std::span<const std::uint32_t> places, std::vector<FoundContact>& all, double h);
    /// When the step is made: places less the lead.
    void take_back();

private:
    struct Led
    {
        std::uint32_t body = 0;  ///< host row
        Vec3 displacement;       ///< m
        Quat start;
    };
    Vec3 displacement_of(Ref body) const { return displacements_[body.index]; }
    void query(std::span<const std::uint32_t> places, const std::vector<FoundContact>& all);

    StepState& step_;
    ContactBook& contacts_;
    std::vector<Led> led_;
    std::vector<Vec3> displacements_;  ///< m, by host row; zero between steps
    std::vector<FoundContact> midway_;
    std::vector<PersistentPair> persistent_;
};

}  // namespace plab::simulation
