#include "simulation/articulated/joint_tree.h"

#include <algorithm>
#include <cmath>

namespace plab::simulation
{
namespace
{

/// Rows are compared relative to their own size; joints that have drifted by a millionth of their arm are still joints.
constexpr double kJointTolerance = 1e-6;

using Twist = std::array<double, 6>;  ///< linear (m/s), angular (rad/s) times a length

double dot6(const Twist& a, const Twist& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]; }

/// An orthonormal set of twists that grows.
struct TwistBasis
{
    std::array<Twist, 6> q{};
    std::size_t count = 0;

    /// Removes from t what the set spans, twice for its digits, and returns the length that is left.
    double reduce(Twist& t) const
    {
        for (int pass = 0; pass < 2; ++pass)
            for (std::size_t k = 0; k < count; ++k)
            {
                const double along = dot6(q[k], t);
                for (std::size_t i = 0; i < 6; ++i) t[i] -= along * q[k][i];
            }
        return std::sqrt(dot6(t, t));
    }
    void push(Twist t, double size)
    {
        for (double& x : t) x /= size;
        q[count++] = t;
    }
};

/// The twists that no row resists, as an orthonormal basis; unit twists are tried in the order of what is left of them.
std::size_t null_space(TwistBasis& basis, std::array<Twist, 6>& out)
{
    std::size_t found = 0;
    while (basis.count < 6)
    {
        Twist best{};
        double most = 0;
        for (std::size_t i = 0; i < 6; ++i)
        {
            Twist unit{};
            unit[i] = 1;
            const double left = basis.reduce(unit);
            if (left > most * (1 + 1e-9)) most = left, best = unit;
        }
        basis.push(best, most);
        out[found++] = basis.q[basis.count - 1];
    }
    return found;
}

Vec3 linear_of(const Twist& t) { return {t[0], t[1], t[2]}; }
Vec3 angular_of(const Twist& t) { return {t[3], t[4], t[5]}; }

std::string_view as_line_joint(const Twist& t, double arm, const Vec3& center, RecognizedJoint& joint)
{
    const Vec3 v = linear_of(t), w = angular_of(t) / arm;
    const double turn = length(angular_of(t));
    if (turn < kJointTolerance)
    {
        joint.kind = JointKind::Slider, joint.axis_W = normalized(v), joint.anchor_W = center;
        return {};
    }
    joint.kind = JointKind::Hinge, joint.axis_W = normalized(w);
    const Vec3 m = v / length(w);  // axis x (center - anchor)
    if (std::fabs(dot(m, joint.axis_W)) > kJointTolerance * arm) return "a joint is a screw";
    joint.anchor_W = center - cross(m, joint.axis_W);
    return {};
}

/// Three twists v = w x r with one r. The three w span space, so they solve for the matrix of v in w, which is -[r]x.
std::string_view as_ball_joint(std::span<const Twist> t, double arm, const Vec3& center, RecognizedJoint& joint)
{
    const Vec3 w0 = angular_of(t[0]), w1 = angular_of(t[1]), w2 = angular_of(t[2]);
    const double volume = dot(w0, cross(w1, w2));
    if (std::fabs(volume) < 1e-3) return "a joint with three degrees of freedom is not a ball joint";
    const Vec3 d0 = cross(w1, w2) / volume, d1 = cross(w2, w0) / volume, d2 = cross(w0, w1) / volume;  // dual basis
    const Vec3 v0 = linear_of(t[0]), v1 = linear_of(t[1]), v2 = linear_of(t[2]);
    const auto entry = [&](int i, int j) { return arm * (v0[i] * d0[j] + v1[i] * d1[j] + v2[i] * d2[j]); };
    // v = w x r = A w:  A = [0 rz -ry; -rz 0 rx; ry -rx 0]
    const Vec3 r{0.5 * (entry(1, 2) - entry(2, 1)), 0.5 * (entry(2, 0) - entry(0, 2)), 0.5 * (entry(0, 1) - entry(1, 0))};
    for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j)
            if (std::fabs(entry(i, j) + entry(j, i)) > kJointTolerance * arm)
                return "a joint with three degrees of freedom is not a ball joint";
    joint.kind = JointKind::Ball, joint.anchor_W = center - r;
    return {};
}

/// Why a row cannot be part of a lower pair; empty: it can.
std::string_view unfit(const Bodies& bodies, const ConstraintRow& row)
{
    if (row.may_yield()) return "a limit or a bounded motor acts on a joint";
    if (row.kind != RowKind::Equality || row.rate != 0) return "a motor drives a joint";
    if (row.count < 1 || row.count > 2) return "a joint has more than two participants";
    for (std::uint32_t k = 0; k < row.count; ++k)
    {
        const Ref p = row.blocks[k].participant;
        if (p.facet != Facet::Body || !p.valid()) return "a joint couples a shaft";
        if (bodies.dynamic(p.index)) continue;
        if (length(bodies.velocity[p.index]) + length(bodies.angular_velocity[p.index]) > 0)
            return "a joint is held by a body that is driven";
    }
    if (row.count == 1) return {};
    const RowBlock &a = row.blocks[0], &b = row.blocks[1];
    const Vec3 l = bodies.position[b.participant.index] - bodies.position[a.participant.index];
    const double size = length(b.linear) * (1 + length(l)) + length(b.angular) + length(a.angular);
    if (length(a.linear + b.linear) > kJointTolerance * size || length(a.angular + b.angular + cross(l, b.linear)) > kJointTolerance * size)
        return "a joint couples its bodies at a ratio";
    return {};
}

}  // namespace

std::string_view JointTree::add_joint(const Bodies& bodies, std::span<const ConstraintRow> rows)
{
    double arm = 0;  // m
    for (const ConstraintRow& row : rows)
    {
        if (const auto reason = unfit(bodies, row); !reason.empty()) return reason;
        for (std::uint32_t k = 0; k < row.count; ++k)
            if (row.count != rows[0].count || row.blocks[k].participant != rows[0].blocks[k].participant)
                return "the rows of a joint have different participants";
        const RowBlock& b = row.blocks[row.count - 1];
        if (const double linear = length(b.linear); linear > 0) arm = std::fmax(arm, length(b.angular) / linear);
    }
    if (!(arm > 0)) arm = 1;
    TwistBasis basis;
    for (const ConstraintRow& row : rows)
    {
        const RowBlock& b = row.blocks[row.count - 1];
        Twist t{b.linear.x, b.linear.y, b.linear.z, b.angular.x / arm, b.angular.y / arm, b.angular.z / arm};
        const double size = std::sqrt(dot6(t, t));
        if (!(size > 0) || !std::isfinite(size)) return "a row of a joint is empty";
        const double left = basis.reduce(t);
        if (left > kJointTolerance * size) basis.push(t, left);
    }
    const ConstraintRow& first = rows[0];
    const std::uint32_t last = first.blocks[first.count - 1].participant.index;
    RecognizedJoint joint;
    const auto moving = [&](std::uint32_t k)
    { return bodies.dynamic(first.blocks[k].participant.index) ? first.blocks[k].participant.index : kNoIndex; };
    joint.a = first.count == 2 ? moving(0) : kNoIndex, joint.b = moving(first.count - 1);
    joint.component = first.component;
    const Vec3& center = bodies.position[last];
    joint.anchor_W = joint.last_W = center;
    std::array<Twist, 6> free{};
    const std::size_t freedom = null_space(basis, free);
    std::string_view reason;
    if (freedom == 1)
        reason = as_line_joint(free[0], arm, center, joint);
    else if (freedom == 3)
        reason = as_ball_joint({free.data(), 3}, arm, center, joint);
    else if (freedom != 0)
        reason = "a joint has neither 0, 1 nor 3 degrees of freedom";
    joints_.push_back(joint);
    return reason;
}

std::uint32_t JointTree::member_of(std::uint32_t body) const
{
    if (body == kNoIndex) return kNoIndex;
    const auto at = std::lower_bound(by_body_.begin(), by_body_.end(), std::pair<std::uint32_t, std::uint32_t>{body, 0});
    return at != by_body_.end() && at->first == body ? at->second : kNoIndex;
}

std::string_view JointTree::recognize(const Bodies& bodies, std::span<const std::uint32_t> members, std::span<const ConstraintRow> rows)
{
    joints_.clear(), links_.clear(), by_body_.clear();
    for (const std::uint32_t b : members)
        if (bodies.needle[b] != 0) return "a body has no inertia about an axis";
    for (std::size_t i = 0; i < rows.size();)
    {
        const std::size_t first = i;
        while (i < rows.size() && rows[i].component == rows[first].component) ++i;
        if (const auto reason = add_joint(bodies, rows.subspan(first, i - first)); !reason.empty()) return reason;
    }
    for (std::uint32_t m = 0; m < members.size(); ++m) by_body_.emplace_back(members[m], m);
    std::sort(by_body_.begin(), by_body_.end());
    return order(members);
}

/// Breadth first: trees that the world holds, in the order of joints, then the others, each from its first member.
std::string_view JointTree::order(std::span<const std::uint32_t> members)
{
    link_of_.assign(members.size(), kNoIndex);
    used_.assign(joints_.size(), 0);
    first_.assign(members.size(), kNoIndex), next_.assign(2 * joints_.size(), kNoIndex);
    for (auto j = static_cast<std::uint32_t>(joints_.size()); j-- > 0;)  // backwards, so that lists are in the order of joints
        for (const std::uint32_t side : {1U, 0U})
        {
            const std::uint32_t m = member_of(side == 0 ? joints_[j].a : joints_[j].b);
            if (m != kNoIndex) next_[2 * j + side] = std::exchange(first_[m], 2 * j + side);
        }
    for (std::uint32_t j = 0; j < joints_.size(); ++j)
    {
        const RecognizedJoint& joint = joints_[j];
        const std::uint32_t a = member_of(joint.a), b = member_of(joint.b);
        if ((a == kNoIndex) == (b == kNoIndex)) continue;
        const std::uint32_t m = a == kNoIndex ? b : a;
        if (link_of_[m] != kNoIndex) return "joints form a loop through the world";
        link_of_[m] = static_cast<std::uint32_t>(links_.size()), used_[j] = 1;
        links_.push_back({members[m], kNoIndex, j, b == kNoIndex});
    }
    if (const auto reason = grow(0); !reason.empty()) return reason;
    for (std::uint32_t m = 0; m < members.size(); ++m)
    {
        if (link_of_[m] != kNoIndex) continue;
        const std::size_t from = links_.size();
        link_of_[m] = static_cast<std::uint32_t>(from);
        links_.push_back({members[m], kNoIndex, kNoIndex, false});
        if (const auto reason = grow(from); !reason.empty()) return reason;
    }
    return {};
}

std::string_view JointTree::grow(std::size_t from)
{
    for (std::size_t i = from; i < links_.size(); ++i)
        for (std::uint32_t at = first_[member_of(links_[i].body)]; at != kNoIndex; at = next_[at])
        {
            const std::uint32_t j = at / 2;
            if (used_[j] != 0) continue;
            used_[j] = 1;
            const bool reversed = at % 2 == 1;  // the parent is B
            const std::uint32_t child = member_of(reversed ? joints_[j].a : joints_[j].b);
            if (child == kNoIndex || link_of_[child] != kNoIndex) return "joints form a loop";
            link_of_[child] = static_cast<std::uint32_t>(links_.size());
            links_.push_back({reversed ? joints_[j].a : joints_[j].b, static_cast<std::uint32_t>(i), j, reversed});
        }
    return {};
}

}  // namespace plab::simulation
