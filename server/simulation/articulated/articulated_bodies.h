/// The equations of motion of trees of joined bodies in the coordinates of their joints.
///
/// The articulated body algorithm (R. Featherstone, "Rigid Body Dynamics Algorithms", 2008, table 7.1), O(n): outward for velocities and
/// bias accelerations, inward for the inertia I^A that a body has with all that hangs on it, outward again for accelerations. All spatial
/// vectors are (linear, angular) about the body's own centre of mass with the axes of the world, so that moving them between bodies is a
/// shift without a rotation:
///
///   v_i = X v_p + S u,   a_i = X a_p + c + S u',   X (a, alpha) = (a + alpha x l, alpha),   l = c_i - c_p
///   U = I^A S,  D = S^T U,  I^A_p += X^T (I^A - U D^-1 U^T) X,  p_p += X^T (p + I^a c - U D^-1 S^T p),  u' = -D^-1 (S^T p + U^T a')
///
/// A coordinate counts from the relative pose at the start of the advance, which is kept exactly; those of a ball joint and the rotation
/// of a free root are rotation vectors (sdk/plab/minimal_coordinates.h has the units).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "linear/ldlt3.h"
#include "plab/tables.h"
#include "plab/wrenches.h"
#include "simulation/articulated/joint_tree.h"

namespace plab::simulation
{

/// The force of a joint on its last participant about that one's centre of mass, in W.
struct JointReaction
{
    std::uint32_t component = kNoIndex;
    Vec3 force, torque;  ///< N, N m
};

class ArticulatedBodies
{
public:
    /// Takes over the tree at the present state of the tables.
    void start(const Bodies& bodies, const JointTree& tree);
    /// The number of coordinates, which is that of speeds.
    std::size_t size() const { return size_; }
    /// The speeds of the joints at the start.
    void read_speeds(const Bodies& bodies, std::span<double> u) const;
    /// Writes poses and velocities at the coordinates x and speeds u.
    void place(Bodies& bodies, std::span<const double> x, std::span<const double> u);
    /// x' at the coordinates and speeds of the last place().
    void coordinate_rates(std::span<const double> x, std::span<const double> u, std::span<double> rates) const;
    /// u' under the wrenches, at the coordinates and speeds of the last place().
    void accelerate(const Bodies& bodies, const Wrenches& wrenches, std::span<double> rates);
    /// The reactions of all joints at the last accelerate(), in their order.
    std::span<const JointReaction> reactions(const JointTree& tree);

private:
    /// [M H; H^T J]; M and J symmetric.
    struct Inertia
    {
        Mat3 M, H, J;
    };
    struct Spatial
    {
        Vec3 linear, angular;
    };
    struct Link
    {
        JointKind kind = JointKind::Free;
        std::uint32_t body = 0, parent = kNoIndex, offset = 0;  ///< offset of its coordinates
        Vec3 anchor_P, anchor_C;                                ///< the joint's point from the centre of parent and child, in their frames
        Vec3 axis_C;
        Quat relative;  ///< parent to child at the start
        // at the last place():
        Quat q;
        Mat3 R;
        Vec3 c, v, w;
        Vec3 l, r, axis;  ///< in W: from the parent's centre, from the anchor to the centre, axis
        Vec3 turn;        ///< relative angular velocity
        // of the last accelerate():
        Inertia inertia;
        Spatial p, bias, a;
        std::array<Spatial, 3> S, U;
        std::array<double, 3> push{};  ///< -S^T p
        linear::Ldlt3 D;               ///< factors of S^T U
    };

    static std::size_t freedom(JointKind kind);
    static Spatial times(const Inertia& inertia, const Spatial& a);
    static void free_acceleration(Link& link);
    void set_subspace(Link& link) const;
    void set_bias(Link& link) const;
    void factor(Link& link, std::size_t n) const;
    void pass_inward(const Link& link, std::size_t n);

    std::vector<Link> links_;
    std::vector<JointReaction> reactions_;
    std::size_t size_ = 0;
};

}  // namespace plab::simulation
