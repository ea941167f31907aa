/// Small worlds made by hand: bodies, shapes, a sink, and rows of the collision types with their declared defaults.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "detection/ode_detection.h"
#include "response/impulse.h"
#include "support/one_row.h"
#include "support/random_poses.h"

namespace plab::test
{

/// Equal to a relative error; doctest's own scale of 1 would let small numbers pass.
inline doctest::Approx near(double want, double relative) { return doctest::Approx(want).epsilon(relative).scale(0); }

inline Ref body(std::uint32_t i) { return {Facet::Body, i}; }

/// Adds a body with its centre of mass at `p`; mass 0 makes it static.
inline std::uint32_t add_body(Bodies& b, double mass, const Vec3& inertia, const Vec3& p, const Vec3& v = {}, const Quat& q = {})
{
    const bool moves = mass > 0;
    b.motion.push_back(moves ? Motion::Dynamic : Motion::Static);
    b.position.push_back(p), b.orientation.push_back(q), b.velocity.push_back(v);
    b.angular_velocity.push_back({}), b.angular_momentum.push_back({});
    b.mass.push_back(mass), b.inverse_mass.push_back(moves ? 1 / mass : 0);
    b.inertia_B.push_back(Mat3::diagonal(inertia.x, inertia.y, inertia.z));
    b.inverse_inertia_B.push_back(moves ? Mat3::diagonal(1 / inertia.x, 1 / inertia.y, 1 / inertia.z) : Mat3{});
    b.needle.push_back(0), b.center_B.push_back({}), b.material.push_back(0), b.shapes.push_back({});
    return static_cast<std::uint32_t>(b.size() - 1);
}
inline std::uint32_t add_sphere(Bodies& b, double mass, double radius, const Vec3& p, const Vec3& v = {})
{
    const double i = 0.4 * mass * radius * radius;
    return add_body(b, mass, {i, i, i}, p, v);
}
inline void set_spin(Bodies& b, std::uint32_t i, const Vec3& w)
{
    b.angular_velocity[i] = w;
    b.refresh_momentum(i);
}

inline std::uint32_t add_shape(Shapes& s, GeometryKind kind, const Vec3& size = {}, const Pose& pose = {})
{
    Geometry g;
    g.kind = kind, g.size = size, g.pose = pose;
    s.geometry.push_back(std::move(g));
    return static_cast<std::uint32_t>(s.geometry.size() - 1);
}
inline Geometry solid(GeometryKind kind, const Vec3& size = {})
{
    Geometry g;
    g.kind = kind, g.size = size;
    return g;
}
inline detection::Collider collider(GeometryKind kind, const Vec3& size = {})
{
    detection::start_ode();
    return detection::Collider(solid(kind, size));
}
inline Geometry mesh_of(std::vector<Vec3> vertices)
{
    Geometry g;
    g.kind = GeometryKind::Mesh, g.vertices = std::move(vertices), g.hull_collides = true;
    return g;
}
inline std::vector<Vec3> box_corners(const Vec3& h)
{
    std::vector<Vec3> out;
    for (int i = 0; i < 8; ++i) out.push_back({i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z});
    return out;
}

/// The host's side of detection. `rank` gives each body its place in the order of ids; empty: by index.
struct Sink final : ContactSink
{
    std::vector<PersistentPair> pairs;
    std::vector<Contact> contacts;
    std::vector<std::uint32_t> rank;

    std::span<const PersistentPair> persistent() const override { return pairs; }
    void add(const Contact& contact) override { contacts.push_back(contact); }
    bool precedes(Ref a, Ref b) const override { return rank.empty() ? a.index < b.index : rank[a.index] < rank[b.index]; }
};

/// A detection between all bodies of a small world.
struct Detection : OneRow<detection::OdeRows>
{
    Sink sink;
    CollisionFilter filter;
    explicit Detection(const char* space = "tree") { rows.space[0] = space; }
    const std::vector<Contact>& detect(const Bodies& bodies, const Shapes& shapes, const StepContext& context = {})
    {
        sink.contacts.clear();
        const auto done = detection::detect(context, 0, rows, bodies, shapes, filter, sink);
        return done ? sink.contacts : (sink.contacts.clear(), sink.contacts);
    }
    void between_all(const Bodies& bodies)
    {
        rows.between[0].clear();
        for (std::uint32_t i = 0; i < bodies.size(); ++i) rows.between[0].push_back(body(i));
    }
};

inline Contact contact_point(std::uint32_t a, std::uint32_t b, const Vec3& point, const Vec3& normal, double friction = 0,
                             double restitution = 0)
{
    Contact c;
    c.a = body(a), c.b = body(b), c.point = point, c.normal = normal;
    c.friction = friction, c.restitution = restitution;
    return c;
}
inline Impact respond(Bodies& bodies, std::vector<Contact>& contacts, ImpactMode mode = ImpactMode::Impact, double dt = 0)
{
    OneRow<response::ImpulseRows> row;
    Impact impact;
    impact.mode = mode, impact.dt = dt, impact.contacts = contacts;
    response::respond({}, 0, row.rows, bodies, impact);
    return impact;
}

inline double total_energy(const Bodies& b)
{
    double e = 0;
    for (std::uint32_t i = 0; i < b.size(); ++i) e += b.kinetic_energy(i);
    return e;
}

}  // namespace plab::test
