/// Bodies, joints and the classical Runge-Kutta method over host tables, without a world.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "joints/sides.h"
#include "plab/rotation.h"
#include "simulation/rows/row_system.h"

namespace plab::test
{

inline constexpr Ref kWorld{Facet::Body, kNoIndex};

class Mechanism : public simulation::RowSource
{
public:
    using Joint = std::function<void(const Bodies&, const Shafts&, RowSink&)>;

    Ref body(double mass, const Vec3& inertia, const Vec3& position)
    {
        const std::uint32_t i = host.add(Facet::Body, components_++);
        Bodies& b = host.bodies;
        b.motion[i] = Motion::Dynamic, b.mass[i] = mass, b.inverse_mass[i] = 1 / mass, b.position[i] = position;
        b.inertia_B[i] = Mat3::diagonal(inertia.x, inertia.y, inertia.z);
        b.inverse_inertia_B[i] = Mat3::diagonal(1 / inertia.x, 1 / inertia.y, 1 / inertia.z);
        return {Facet::Body, i};
    }
    Ref shaft(double inertia)
    {
        const std::uint32_t i = host.add(Facet::Shaft, components_++);
        host.shafts.motion[i] = Motion::Dynamic, host.shafts.inertia[i] = inertia, host.shafts.inverse_inertia[i] = 1 / inertia;
        host.shafts.root[i] = i;
        return {Facet::Shaft, i};
    }
    /// Both joint points are at the present position p.
    std::uint32_t ball(Ref a, Ref b, const Vec3& p) { return ball(a, in_frame(a, p), b, in_frame(b, p)); }
    std::uint32_t ball(Ref a, const Vec3& p_a, Ref b, const Vec3& p_b)
    {
        return add([=](const Bodies& bodies, const Shafts&, RowSink& sink)
                   { constraints::add_point_rows(sides(bodies, a, p_a, b, p_b), 0, sink); });
    }
    std::uint32_t hinge(Ref a, Ref b, const Vec3& p, const Vec3& axis)
    {
        const Vec3 p_a = in_frame(a, p), p_b = in_frame(b, p);
        const Quat f_a = conjugate(attitude(a)) * constraints::frame_of_axis(axis),
                   f_b = conjugate(attitude(b)) * constraints::frame_of_axis(axis);
        return add(
            [=, this](const Bodies& bodies, const Shafts&, RowSink& sink)
            {
                const constraints::Sides s = sides(bodies, a, p_a, b, p_b);
                constraints::add_point_rows(s, 0, sink);
                const Quat q = attitude(a) * f_a;
                constraints::add_axis_rows(s, rotate(q, {0, 0, 1}), rotate(attitude(b) * f_b, {0, 0, 1}), rotate(q, {1, 0, 0}),
                                           rotate(q, {0, 1, 0}), 3, sink);
            });
    }
    std::uint32_t add(Joint joint) { return joints_.push_back(std::move(joint)), static_cast<std::uint32_t>(joints_.size() - 1); }

    void constrain(const StepContext&, RowSink& sink) override
    {
        for (std::uint32_t i = 0; i < joints_.size(); ++i) sink.begin(i), joints_[i](host.bodies, host.shafts, sink);
    }
    void build()
    {
        REQUIRE(graph.build(host.shafts, {}));
        for (std::uint32_t i = 0; i < host.bodies.size(); ++i) host.bodies.refresh_momentum(i);
        wrenches = Wrenches(host.bodies, host.shafts);
        wrenches.force.resize(host.bodies.size()), wrenches.torque.resize(host.bodies.size());
        wrenches.shaft_torque.resize(host.shafts.size());
        rows.configure(host, *this, graph);
    }

    void evaluate()
    {
        for (std::uint32_t i = 0; i < host.bodies.size(); ++i) wrenches.force[i] = gravity * host.bodies.mass[i], wrenches.torque[i] = {};
        for (double& t : wrenches.shaft_torque) t = 0;
        if (load) load(wrenches);
        REQUIRE(rows.react(context, wrenches));
        ++evaluations;
    }
    void step(double h);
    void run(double t, double h)
    {
        for (long n = std::lround(t / h); n > 0; --n) step(h);
    }

    double energy() const
    {
        double sum = 0;
        for (std::uint32_t i = 0; i < host.bodies.size(); ++i)
            sum += host.bodies.kinetic_energy(i) - host.bodies.mass[i] * dot(gravity, host.bodies.position[i]);
        for (std::uint32_t i = 0; i < host.shafts.size(); ++i) sum += host.shafts.kinetic_energy(i);
        return sum;
    }
    Quat attitude(Ref body) const { return body.valid() ? host.bodies.orientation[body.index] : Quat{}; }
    Vec3 in_frame(Ref body, const Vec3& p) const
    {
        return body.valid() ? rotate_back(attitude(body), p - host.bodies.position[body.index]) : p;
    }
    static constraints::Sides sides(const Bodies& bodies, Ref a, const Vec3& p_a, Ref b, const Vec3& p_b)
    {
        return constraints::sides_of(constraints::side_of(bodies, a, p_a), constraints::side_of(bodies, b, p_b));
    }

    world::HostTables host;
    simulation::ConstraintGraph graph;
    simulation::RowSystem rows;
    simulation::ProjectionReport report;  ///< of the last step
    Wrenches wrenches;
    StepContext context;
    Vec3 gravity{0, 0, -9.81};
    std::function<void(Wrenches&)> load;
    std::size_t evaluations = 0;

private:
    std::vector<Joint> joints_;
    std::uint32_t components_ = 0;
};

/// Runge-Kutta with rotation vectors (Munthe-Kaas), then the projection: what pLab's step does with Solver/RungeKutta4.
inline void Mechanism::step(double h)
{
    context.dt = h;
    Bodies& b = host.bodies;
    Shafts& s = host.shafts;
    const Bodies start = b;
    const Shafts start_s = s;
    struct Rate
    {
        Vec3 x, u, v, l;
    };
    const std::size_t n = b.size(), m = s.size();
    std::vector<Rate> k(n), sum(n);
    std::vector<Vec3> u(n);
    std::vector<double> ks(m), kw(m), sum_s(m), sum_w(m);
    const double share[4] = {0, 0.5, 0.5, 1}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    const auto place = [&](const std::vector<Rate>& r, const std::vector<double>& rs, const std::vector<double>& rw, double t)
    {
        for (std::uint32_t i = 0; i < n; ++i)
        {
            u[i] = r[i].u * t;
            b.position[i] = start.position[i] + r[i].x * t, b.velocity[i] = start.velocity[i] + r[i].v * t;
            b.orientation[i] = start.orientation[i] * exp_rotation(u[i]);
            b.angular_momentum[i] = start.angular_momentum[i] + r[i].l * t;
            b.refresh_spin(i);
        }
        for (std::size_t i = 0; i < m; ++i) s.angle[i] = start_s.angle[i] + rs[i] * t, s.speed[i] = start_s.speed[i] + rw[i] * t;
        graph.derive(s);
    };
    for (int stage = 0; stage < 4; ++stage)
    {
        place(k, ks, kw, share[stage] * h);
        evaluate();
        for (std::uint32_t i = 0; i < n; ++i)
        {
            k[i] = {b.velocity[i], rotation_vector_rate(u[i], rotate_back(b.orientation[i], b.angular_velocity[i])),
                    wrenches.force[i] * b.inverse_mass[i], wrenches.torque[i]};
            sum[i].x += k[i].x * weight[stage], sum[i].u += k[i].u * weight[stage];
            sum[i].v += k[i].v * weight[stage], sum[i].l += k[i].l * weight[stage];
        }
        for (std::uint32_t i = 0; i < m; ++i)
        {
            double torque = wrenches.shaft_torque[i], inertia = s.inertia[i];
            if (const auto* tree = graph.tree_of(i))
            {
                torque = 0, inertia = tree->inertia;
                for (const auto& node : graph.nodes(*tree)) torque += node.ratio * wrenches.shaft_torque[node.shaft];
                torque *= s.ratio[i];
            }
            ks[i] = s.speed[i], kw[i] = torque / inertia;
            sum_s[i] += ks[i] * weight[stage], sum_w[i] += kw[i] * weight[stage];
        }
    }
    place(sum, sum_s, sum_w, h);
    for (std::uint32_t i = 0; i < n; ++i) b.orientation[i] = normalized(b.orientation[i]);
    report = rows.project(context);
}

}  // namespace plab::test
