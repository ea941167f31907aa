/// Islands made by hand: boxes, faces between them, and a motion under gravity.
#pragma once

#include <doctest/doctest.h>

#include <vector>

#include "managers/problem.h"
#include "plab/rotation.h"

namespace plab::test
{

inline constexpr double kStep = 1.0 / 60;  // s

struct IslandWorld
{
    Bodies bodies;
    Shafts shafts;
    std::vector<Contact> contacts;
    std::vector<ConstraintRow> rows;
    std::vector<std::uint32_t> members;

    /// A box of half extents `half`; mass 0 makes it static.
    std::uint32_t add_box(double mass, const Vec3& half, const Vec3& at)
    {
        const bool moves = mass > 0;
        const Vec3 I =
            Vec3{half.y * half.y + half.z * half.z, half.x * half.x + half.z * half.z, half.x * half.x + half.y * half.y} * (mass / 3);
        bodies.motion.push_back(moves ? Motion::Dynamic : Motion::Static);
        bodies.position.push_back(at), bodies.orientation.push_back({}), bodies.velocity.push_back({});
        bodies.angular_velocity.push_back({}), bodies.angular_momentum.push_back({});
        bodies.mass.push_back(mass), bodies.inverse_mass.push_back(moves ? 1 / mass : 0);
        bodies.inertia_B.push_back(Mat3::diagonal(I.x, I.y, I.z));
        bodies.inverse_inertia_B.push_back(moves ? Mat3::diagonal(1 / I.x, 1 / I.y, 1 / I.z) : Mat3{});
        bodies.needle.push_back(0), bodies.center_B.push_back({}), bodies.material.push_back(0), bodies.shapes.push_back({});
        const auto i = static_cast<std::uint32_t>(bodies.size() - 1);
        if (moves) members.push_back(i);
        return i;
    }
    void add_contact(std::uint32_t a, std::uint32_t b, const Vec3& point, const Vec3& normal, double friction)
    {
        Contact c;
        c.a = {Facet::Body, a}, c.b = {Facet::Body, b};
        c.feature = static_cast<std::uint32_t>(contacts.size());
        c.point = point, c.normal = normal, c.friction = friction;
        contacts.push_back(c);
    }
    /// Four corners of a level face about `at`, b above a.
    void add_face(std::uint32_t a, std::uint32_t b, const Vec3& at, double half_x, double half_y, double friction)
    {
        for (int i = 0; i < 4; ++i)
            add_contact(a, b, at + Vec3{(i & 1) != 0 ? half_x : -half_x, (i & 2) != 0 ? half_y : -half_y, 0}, {0, 0, 1}, friction);
    }
    /// n unit boxes, one on another, with the given masses.
    void add_stack(const std::vector<double>& masses, double friction)
    {
        std::uint32_t below = add_box(0, {1, 1, 1}, {0, 0, -1});
        for (std::size_t i = 0; i < masses.size(); ++i)
        {
            const auto z = static_cast<double>(i);
            const std::uint32_t box = add_box(masses[i], {0.5, 0.5, 0.5}, {0, 0, z + 0.5});
            add_face(below, box, {0, 0, z}, 0.5, 0.5, friction);
            below = box;
        }
    }
    void kick(const Vec3& change)
    {
        for (const std::uint32_t b : members) bodies.velocity[b] += change;
    }
    Island island(double h)
    {
        Island i;
        i.h = h, i.bodies = members, i.contacts = contacts, i.rows = rows;
        return i;
    }
};

/// The problem of the present speeds: no gaps close, no restitution.
inline managers::Problem problem_of(IslandWorld& world, double h = 0.01)
{
    managers::Problem p;
    p.load(world.island(h), world.bodies, world.shafts);
    p.read_speeds(world.bodies, world.shafts);
    p.apply_impulses();
    return p;
}

/// Gravity alone; poses move, depths follow from the boxes' positions along the contacts' normals.
class GravityMotion final : public IslandMotion
{
public:
    GravityMotion(IslandWorld& world, double g) : w_(&world), g_(g)
    {
        for (const Contact& c : world.contacts)
        {
            arms_.push_back({rotate_back(world.bodies.orientation[c.a.index], c.point - world.bodies.position[c.a.index]),
                             rotate_back(world.bodies.orientation[c.b.index], c.point - world.bodies.position[c.b.index])});
            depths_.push_back(c.depth);
        }
    }
    void kick(double h) override
    {
        before_.clear();
        for (const std::uint32_t b : w_->members)
        {
            before_.push_back({w_->bodies.velocity[b], w_->bodies.angular_velocity[b]});
            w_->bodies.velocity[b].z -= g_ * h;
        }
    }
    void move(double h) override
    {
        for (const std::uint32_t b : w_->members) turn(b, w_->bodies.velocity[b] * h, w_->bodies.angular_velocity[b] * h);
    }
    void move_mean(double h) override
    {
        for (std::size_t i = 0; i < w_->members.size(); ++i)
        {
            const std::uint32_t b = w_->members[i];
            turn(b, (before_[i].v + w_->bodies.velocity[b]) * (0.5 * h), (before_[i].w + w_->bodies.angular_velocity[b]) * (0.5 * h));
        }
    }
    void refresh_rows() override {}
    bool put_rows_midway(double) override { return false; }
    void refresh_depths() override
    {
        for (std::size_t i = 0; i < w_->contacts.size(); ++i)
        {
            Contact& c = w_->contacts[i];
            const auto at = [&](std::uint32_t b, const Vec3& arm)
            { return w_->bodies.position[b] + rotate(w_->bodies.orientation[b], arm); };
            c.depth = depths_[i] - dot(at(c.b.index, arms_[i].b) - at(c.a.index, arms_[i].a), c.normal);
        }
    }

private:
    void turn(std::uint32_t b, const Vec3& shift, const Vec3& by)
    {
        w_->bodies.position[b] += shift;
        w_->bodies.orientation[b] = normalized(exp_rotation(by) * w_->bodies.orientation[b]);
        w_->bodies.refresh_spin(b);
    }
    struct Speeds
    {
        Vec3 v, w;
    };
    struct Arms
    {
        Vec3 a, b;
    };
    IslandWorld* w_;
    double g_;
    std::vector<Speeds> before_;
    std::vector<Arms> arms_;
    std::vector<double> depths_;
};

}  // namespace plab::test
