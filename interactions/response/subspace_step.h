/// Where a Gauss-Seidel method for contacts converges slowly, which of them stick, slide and separate is soon known. Then the equations of
/// those that touch are linear:
///
///   sticks:  u = (0, 0, b)          slides along s:  u_n = b,  j_t = -mu s j_n          separates:  j = 0
///
/// Source: Silcowitz, Niebe, Erleben, A nonsmooth nonlinear conjugate gradient method for interactive contact force problems; Projected
/// Gauss-Seidel subspace minimization method for interactive rigid body dynamics (2010), there for boxes instead of cones.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact_velocities.h"

namespace plab::response
{

struct ConeContact
{
    std::uint32_t contact = 0;
    double friction = 0;
    double least = 0;  ///< b: smallest u_n that is allowed afterwards, m/s
    Vec3 impulse;      ///< j, N s in contact coordinates; on entry the initial guess, which has been applied already
};

/// Keeps its memory from call to call.
class SubspaceStep
{
public:
    /// Goes from the present impulses to those that solve these equations, as far as all impulses stay within their cones. Where the
    /// equations leave a choice (four legs of a table), these are the smallest ones, so that no order of contacts decides. Does nothing
    /// beyond kMostContacts.
    void take(std::span<ConeContact> contacts, ContactVelocities& velocities);

    /// Sets memory apart for so many contacts.
    void reserve(std::size_t contacts);

    static constexpr std::size_t kMostContacts = 48;

private:
    /// An unknown: the impulse of a contact along a direction, and the equation of the velocity along another one.
    struct Unknown
    {
        std::uint32_t place = 0;  ///< in `contacts`
        Vec3 force, direction;    ///< contact coordinates
    };
    enum class Aim : std::uint8_t
    {
        Smallest,  ///< the smallest impulses
        Nearest,   ///< the smallest change
    };
    void list_unknowns(std::span<const ConeContact> contacts);
    bool go(std::span<ConeContact> contacts, ContactVelocities& velocities, Aim aimed);
    void solve(std::span<const ConeContact> contacts, const ContactVelocities& velocities, Aim aimed);

    std::vector<Unknown> unknowns_;
    std::vector<double> matrix_, normal_, aim_, rest_, present_, solution_;
    std::vector<Vec3> change_;  ///< N s, by contact
};

}  // namespace plab::response
