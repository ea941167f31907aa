/// Recognises trees of joints from their constraint rows.
///
/// A joint between A and B leaves the twists of B relative to A that its rows J annihilate. If the null space of J has no dimension, the
/// joint is a weld; if it is one rotation, a hinge; one translation, a slider; three rotations about one point, a ball joint. These lower
/// pairs have a motion subspace that is constant in the bodies (Featherstone, "Rigid Body Dynamics Algorithms", 2008, section 4.4), so
/// what their rows are at one pose determines them at all poses. Rows with another subspace are refused, and so are rows that a motion of
/// A and B as one rigid body would violate (gears).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "plab/rows.h"
#include "plab/tables.h"

namespace plab::simulation
{

enum class JointKind : std::uint8_t
{
    Free,    ///< the root of a tree that nothing holds
    Weld,    ///< no relative motion
    Hinge,   ///< one angle about `axis`
    Slider,  ///< one length along `axis`
    Ball     ///< three angles about `anchor`
};

/// What the rows of one component are, at the present state of the tables.
struct RecognizedJoint
{
    JointKind kind = JointKind::Weld;
    std::uint32_t a = kNoIndex, b = kNoIndex;  ///< bodies by host index; kNoIndex: the world, or a body that does not move
    Vec3 axis_W;                               ///< unit
    Vec3 anchor_W;                             ///< m, a point on the axis, or the centre of a ball joint
    Vec3 last_W;                               ///< m, the centre of mass of the last participant, for its reaction
    std::uint32_t component = kNoIndex;
};

/// A body of a tree, with the joint to its parent.
struct TreeLink
{
    std::uint32_t body = kNoIndex;    ///< host index
    std::uint32_t parent = kNoIndex;  ///< index of a link before this one; kNoIndex: the world
    std::uint32_t joint = kNoIndex;   ///< index of the joint; kNoIndex: a free root
    bool reversed = false;            ///< the body is the joint's A
};

/// Memory is kept between calls.
class JointTree
{
public:
    /// Returns an empty text, or why the rows do not form trees of lower pairs. `rows`: those of one component adjacent. Bodies without
    /// joints become free roots.
    std::string_view recognize(const Bodies& bodies, std::span<const std::uint32_t> members, std::span<const ConstraintRow> rows);

    /// Parents before their children, in an order that depends on the orders of members and rows only.
    std::span<const TreeLink> links() const { return links_; }
    std::span<const RecognizedJoint> joints() const { return joints_; }

private:
    std::string_view add_joint(const Bodies& bodies, std::span<const ConstraintRow> rows);
    std::string_view order(std::span<const std::uint32_t> members);
    std::string_view grow(std::size_t from);
    std::uint32_t member_of(std::uint32_t body) const;

    std::vector<RecognizedJoint> joints_;
    std::vector<TreeLink> links_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> by_body_;  ///< (body, member), sorted
    std::vector<std::uint32_t> first_, next_;                       ///< joints of a member: first_[m] .. in next_
    std::vector<std::uint32_t> link_of_;                            ///< by member
    std::vector<std::uint8_t> used_;                                ///< by joint: it is in the tree
};

}  // namespace plab::simulation
