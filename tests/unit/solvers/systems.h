/// Systems with known solutions, presented to a solver as by the host.
#pragma once

#include <doctest/doctest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "plab/registrar.h"
#include "plab/rotation.h"
#include "support/scene.h"

namespace plab::test
{

/// One step of a solver on a system.
using Advance = std::function<void(double h, DynamicSystem&)>;

/// Keeps the events of a solver.
class Events final : public EventSink
{
public:
    void emit(Event event) override { all.push_back(std::move(event)); }
    std::size_t count(const std::string& kind) const
    {
        std::size_t n = 0;
        for (const Event& e : all) n += e.kind == kind ? 1 : 0;
        return n;
    }
    std::vector<Event> all;
};

/// A solver's row with its declared defaults, to be stepped.
template <class Rows>
struct Solver
{
    using Command = void (*)(const StepContext&, Row, Rows&, DynamicSystem&);

    Rows rows;
    Events events;
    Command command;
    Tick tick = 0;
    bool trial = false;

    explicit Solver(Command c) : command(c)
    {
        Schema schema;
        rows.describe(schema);
        for (ColumnBase* column : schema.columns()) column->resize(1);
        for (const Field& field : schema.fields())
            if (type_of(field.fallback) != FieldType::None) field.column->set(0, field.fallback);
    }
    void operator()(double h, DynamicSystem& system)
    {
        StepContext context;
        context.dt = h, context.tick = tick++;
        context.events = trial ? nullptr : &events;
        command(context, 0, rows, system);
    }
};

/// Storage of a group of n coordinates, in a chart that starts at 0 in each step. Bodies come first, quantities last.
class FakeSystem : public DynamicSystem
{
public:
    explicit FakeSystem(std::size_t n, std::size_t quantities = 0) : x_(n), u_(n), dx_(n), du_(n), quantities_(quantities) {}
    std::span<double> coordinates() override { return x_; }
    std::span<double> speeds() override { return u_; }
    std::span<const double> coordinate_rates() const override { return dx_; }
    std::span<const double> speed_rates() const override { return du_; }
    std::span<double> workspace(int i) override
    {
        auto& w = work_.at(static_cast<std::size_t>(i));
        w.resize(x_.size(), 1e300);  // contents are undefined
        return w;
    }
    std::size_t body_count() const override { return 0; }
    RigidMember rigid(std::size_t) const override { return {}; }
    std::size_t quantity_count() const override { return quantities_; }
    bool forces_are_uniform() const override { return uniform; }
    bool is_constrained() const override { return constrained; }
    bool is_undersampled() const override { return undersampled; }
    void evaluate(double t, double weight) override
    {
        ++evaluations;
        booked += weight;
        evaluate_kinematics();
        evaluate_forces(t);
        work += weight * power();
    }
    virtual void evaluate_forces(double t) = 0;
    /// W, of the forces at the state just evaluated; what the ledger sums.
    virtual double power() const { return 0; }
    /// Runs n steps of length h; the displacement goes into the state, and the chart starts again.
    void run(double h, int steps, const Advance& advance)
    {
        for (int i = 0; i < steps; ++i)
        {
            std::fill(x_.begin(), x_.end(), 0.0);
            const double before = work;
            work = 0;
            advance(h, *this);
            work = before + h * work;
            absorb(h);
        }
    }
    virtual void absorb(double h) = 0;

    int evaluations = 0;
    double booked = 0;  ///< sum of weights: 1 for each step
    double work = 0;    ///< J, as the ledger books it
    bool uniform = false, constrained = false, undersampled = false;

protected:
    std::vector<double> x_, u_, dx_, du_;

private:
    std::array<std::vector<double>, 32> work_;
    std::size_t quantities_;
};

/// q'' = a(t, q, v): points on a line, of mass 1.
class Points : public FakeSystem
{
public:
    using Law = std::function<void(double t, const std::vector<double>& q, const std::vector<double>& v, std::vector<double>& a)>;
    Points(std::vector<double> q, const std::vector<double>& v, Law law)
        : FakeSystem(q.size()), place(std::move(q)), law_(std::move(law)), now_(place)
    {
        u_ = v;
    }
    void evaluate_kinematics() override { dx_ = u_; }
    void evaluate_forces(double t) override
    {
        for (std::size_t i = 0; i < x_.size(); ++i) now_[i] = place[i] + x_[i];
        law_(time + t, now_, u_, du_);
    }
    double power() const override
    {
        double p = 0;
        for (std::size_t i = 0; i < u_.size(); ++i) p += du_[i] * u_[i];
        return p;
    }
    void absorb(double h) override
    {
        for (std::size_t i = 0; i < x_.size(); ++i) place[i] += x_[i];
        time += h;
    }
    double speed(std::size_t i = 0) const { return u_[i]; }

    std::vector<double> place;
    double time = 0;

private:
    Law law_;
    std::vector<double> now_;
};

/// z' = r(t, z): quantities, speeds without coordinates.
class Amounts : public FakeSystem
{
public:
    using Law = std::function<void(double t, const std::vector<double>& z, std::vector<double>& rate)>;
    Amounts(std::vector<double> z, Law law) : FakeSystem(z.size(), z.size()), law_(std::move(law)) { u_ = std::move(z); }
    void evaluate_kinematics() override {}
    void evaluate_forces(double t) override { law_(time + t, u_, du_); }
    void absorb(double h) override { time += h; }
    double operator[](std::size_t i) const { return u_[i]; }

    double time = 0;

private:
    Law law_;
};

/// One rigid body as the host presents it: displacement, rotation vector in the starting frame, velocity, and angular
/// momentum in W (or, for a needle, angular velocity in the body).
class Body : public FakeSystem
{
public:
    struct Load
    {
        Vec3 force, torque;  ///< N, N m, in W
    };
    using Law = std::function<Load(double t, const Body&)>;

    Body(const Mat3& inertia, const Vec3& w_B, Law law = {}, bool needle = false)
        : FakeSystem(6), inertia_(inertia), inverse_(plab::inverse(inertia)), needle_(needle), law_(std::move(law))
    {
        if (inertia(0, 1) == 0 && inertia(0, 2) == 0 && inertia(1, 2) == 0)
            inverse_ = Mat3::diagonal(1 / inertia(0, 0), 1 / inertia(1, 1), 1 / inertia(2, 2));
        set(u_, 3, needle ? w_B : inertia * w_B);
        uniform = !law_;
    }
    std::size_t body_count() const override { return 1; }
    RigidMember rigid(std::size_t) const override { return {orientation, inertia_, inverse_, 1, needle_}; }
    void evaluate_kinematics() override
    {
        set(dx_, 0, get(u_, 0));
        set(dx_, 3, rotation_vector_rate(get(x_, 3), spin_B()));
    }
    void evaluate_forces(double t) override
    {
        load_ = law_ ? law_(time + t, *this) : Load{gravity, {}};
        set(du_, 0, load_.force);
        const Vec3 w = spin_B();
        set(du_, 3, needle_ ? inverse_ * (rotate_back(attitude(), load_.torque) - cross(w, inertia_ * w)) : load_.torque);
    }
    double power() const override { return dot(load_.force, get(u_, 0)) + dot(load_.torque, rotate(attitude(), spin_B())); }
    void absorb(double h) override
    {
        position += get(x_, 0);
        orientation = normalized(attitude());
        set(x_, 0, {}), set(x_, 3, {});
        time += h;
    }
    Vec3 place() const { return position + get(x_, 0); }
    Vec3 velocity() const { return get(u_, 0); }
    /// The same motion in the body, from another attitude.
    void turn_to(const Quat& q)
    {
        orientation = q;
        if (!needle_) set(u_, 3, rotate(q, get(u_, 3)));
    }
    void set_velocity(const Vec3& v) { set(u_, 0, v); }
    Quat attitude() const { return orientation * exp_rotation(get(x_, 3)); }
    Vec3 momentum() const { return needle_ ? rotate(attitude(), inertia_ * get(u_, 3)) : get(u_, 3); }
    Vec3 spin_B() const { return needle_ ? get(u_, 3) : inverse_ * rotate_back(attitude(), get(u_, 3)); }
    double spin_energy() const { return 0.5 * dot(momentum(), rotate(attitude(), spin_B())); }

    Vec3 position, gravity;
    Quat orientation;
    double time = 0;

private:
    static Vec3 get(const std::vector<double>& v, std::size_t i) { return {v[i], v[i + 1], v[i + 2]}; }
    static void set(std::vector<double>& to, std::size_t i, const Vec3& v) { to[i] = v.x, to[i + 1] = v.y, to[i + 2] = v.z; }
    Mat3 inertia_, inverse_;
    bool needle_;
    Law law_;
    Load load_;
};

inline Mat3 diagonal(const Vec3& v) { return Mat3::diagonal(v.x, v.y, v.z); }

/// log2 of how an error falls when the step is halved.
inline double order_of(const std::function<double(int steps)>& error, int steps) { return std::log2(error(steps) / error(2 * steps)); }

}  // namespace plab::test
