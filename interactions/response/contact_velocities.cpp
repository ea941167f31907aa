#include "contact_velocities.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plab/symmetric.h"

namespace plab::response
{
namespace
{

/// What joints leave of the mobility of free bodies counts as nothing below this share: it is rounding.
constexpr double kHeld = 1e-10;

/// K without directions in which the law of a contact would divide by zero. Where joints let a point move along a line or in a plane only,
/// K is singular, and several impulses do the same. Of these the law shall find the one with the least friction: a tangent along which
/// nothing moves (it is not coupled to the others) gets the mobility of free bodies, and all tangents a trifle of it.
Mat3 without_singular_directions(const Mat3& K, double free)
{
    const Vec3 values = symmetric_axes(K).values;
    Mat3 out = K;
    if (std::min({values.x, values.y, values.z}) > kHeld * free) return out;
    const double mean = 0.5 * (K(0, 0) + K(1, 1)), difference = 0.5 * (K(0, 0) - K(1, 1));
    if (mean - std::hypot(difference, K(0, 1)) <= kHeld * free)
    {
        const double angle = 0.5 * (std::atan2(K(0, 1), difference) + std::numbers::pi), c = std::cos(angle), s = std::sin(angle);
        out(0, 0) += free * c * c, out(0, 1) += free * c * s, out(1, 0) += free * c * s, out(1, 1) += free * s * s;
        if (mean + std::hypot(difference, K(0, 1)) <= kHeld * free) out(0, 0) = out(1, 1) = free, out(0, 1) = out(1, 0) = 0;
    }
    out(0, 0) += kHeld * free, out(1, 1) += kHeld * free;
    return out;
}

}  // namespace

void ContactVelocities::begin(std::span<const Contact> contacts, Bodies& bodies, std::span<const Mat3> mobility)
{
    bodies_ = &bodies, contacts_ = contacts, mobility_ = mobility;
    points_.clear(), velocities_.clear(), own_.clear();
    for (const Contact& c : contacts) points_.emplace_back(c, bodies);
    if (!are_joined()) return;
    for (const ContactPoint& p : points_) velocities_.push_back(p.velocity(bodies));
    find_own();
}

void ContactVelocities::find_own()
{
    for (std::size_t i = 0; i < points_.size(); ++i)
    {
        const Mat3& K_W = mobility_[i * points_.size() + i];
        Mat3 K;
        for (int column = 0; column < 3; ++column)
        {
            const Vec3 along{column == 0 ? 1.0 : 0.0, column == 1 ? 1.0 : 0.0, column == 2 ? 1.0 : 0.0};
            const Vec3 u = points_[i].to_contact(K_W * points_[i].to_world(along));
            K(0, column) = u.x, K(1, column) = u.y, K(2, column) = u.z;
        }
        const double free = points_[i].K()(2, 2);
        if (!(K(2, 2) > kHeld * free)) K = Mat3{};
        // Without friction, the host has found what impulses along the normal do, and no more is asked for.
        if (contacts_[i].friction > 0 && K(2, 2) > 0) K = without_singular_directions((K + transposed(K)) * 0.5, free);
        own_.push_back(K);
    }
}

void ContactVelocities::apply(std::uint32_t contact, const Vec3& j, double normal_velocity)
{
    if (!are_joined()) return points_[contact].apply(*bodies_, j, normal_velocity);
    const Vec3 j_W = points_[contact].to_world(j);
    for (std::size_t i = 0; i < points_.size(); ++i) velocities_[i] += points_[i].to_contact(mobility_[i * points_.size() + contact] * j_W);
}

void ContactVelocities::keep(std::span<const std::uint32_t> contacts)
{
    kept_.clear(), kept_velocities_ = velocities_, touched_.clear();
    if (are_joined()) return;
    for (const std::uint32_t i : contacts) touched_.push_back(contacts_[i].a.index), touched_.push_back(contacts_[i].b.index);
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    for (const std::uint32_t b : touched_)
        kept_.push_back({b, bodies_->velocity[b], bodies_->angular_velocity[b], bodies_->angular_momentum[b]});
}

void ContactVelocities::put_back()
{
    if (are_joined()) velocities_ = kept_velocities_;
    for (const Kept& k : kept_)
    {
        bodies_->velocity[k.body] = k.velocity;
        bodies_->angular_velocity[k.body] = k.spin;
        bodies_->angular_momentum[k.body] = k.momentum;
    }
}

}  // namespace plab::response
