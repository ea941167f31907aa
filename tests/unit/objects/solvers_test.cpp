/// Solvers on systems with known solutions: observed orders, and free rotation through the exponential map.
#include <doctest/doctest.h>

#include <array>
#include <functional>
#include <vector>

#include "objects/solvers/runge_kutta4.h"
#include "objects/solvers/semi_implicit_euler.h"
#include "plab/plugin.h"
#include "plab/rotation.h"

using namespace plab;
using namespace plab::solvers;

extern "C" void plab_plugin_register(plab::Registrar& registrar);

namespace
{

using Advance = std::function<void(double h, DynamicSystem&)>;

void advance_euler(double h, DynamicSystem& system)
{
    StepContext context;
    context.dt = h;
    advance_semi_implicit_euler(context, 0, {}, system);
}
void advance_rk4(double h, DynamicSystem& system)
{
    StepContext context;
    context.dt = h;
    advance_runge_kutta4(context, 0, {}, system);
}

/// Storage of a group of n coordinates, in a chart that starts at 0 each step.
class FakeSystem : public DynamicSystem
{
public:
    explicit FakeSystem(std::size_t n) : x_(n), u_(n), dx_(n), du_(n) {}
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
    void evaluate(double t, double weight) override
    {
        weight_ += weight;
        evaluate_kinematics();
        evaluate_forces(t);
    }
    virtual void evaluate_forces(double t) = 0;

protected:
    std::vector<double> x_, u_, dx_, du_;
    double weight_ = 0;

private:
    std::array<std::vector<double>, 32> work_;
};

/// q'' = -q + cos(2 t)/2: q = cos t - (cos 2t - cos t)/6, driven so that stage times matter.
class DrivenOscillator final : public FakeSystem
{
public:
    DrivenOscillator() : FakeSystem(1) {}
    void evaluate_kinematics() override { dx_[0] = u_[0]; }
    void evaluate_forces(double t) override { du_[0] = -(q_ + x_[0]) + 0.5 * std::cos(2 * (t_ + t)); }

    double error_after(double time, int steps, const Advance& advance)
    {
        const double h = time / steps;
        for (int n = 0; n < steps; ++n)
        {
            t_ = n * h, x_[0] = 0;
            advance(h, *this);
            q_ += x_[0];
        }
        CHECK(weight_ == doctest::Approx(steps).epsilon(1e-13));  // the ledger's shares of each step add up to 1
        const double exact = std::cos(time) - (std::cos(2 * time) - std::cos(time)) / 6;
        return std::fabs(q_ - exact);
    }

private:
    double q_ = 1, t_ = 0;
};

double observed_order(const Advance& advance, int steps)
{
    return std::log2(DrivenOscillator().error_after(3, steps, advance) /
                     DrivenOscillator().error_after(3, 2 * steps, advance));
}

/// A free rigid body as the host presents it: rotation vector u with q = q0 exp(u), and L in W.
class FreeBody final : public FakeSystem
{
public:
    FreeBody(const Vec3& inertia, const Vec3& w_B) : FakeSystem(3), inertia_(inertia)
    {
        set(u_, {inertia.x * w_B.x, inertia.y * w_B.y, inertia.z * w_B.z});
    }
    void evaluate_kinematics() override
    {
        const Vec3 u{x_[0], x_[1], x_[2]};
        set(dx_, rotation_vector_rate(u, spin_B(q_ * exp_rotation(u))));
    }
    void evaluate_forces(double) override { set(du_, {}); }
    void run(double h, int steps, const Advance& advance)
    {
        for (int n = 0; n < steps; ++n)
        {
            set(x_, {});
            advance(h, *this);
            q_ = normalized(q_ * exp_rotation({x_[0], x_[1], x_[2]}));
        }
    }
    Quat orientation() const { return q_; }
    Vec3 momentum() const { return {u_[0], u_[1], u_[2]}; }
    Vec3 spin_B(const Quat& q) const
    {
        const Vec3 L_B = transposed_times(rotation_matrix(q), momentum());
        return {L_B.x / inertia_.x, L_B.y / inertia_.y, L_B.z / inertia_.z};
    }
    double energy() const { return 0.5 * dot(spin_B(q_), transposed_times(rotation_matrix(q_), momentum())); }

private:
    static void set(std::vector<double>& to, const Vec3& v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }
    Vec3 inertia_;
    Quat q_;
};

/// The angle between two attitudes, rad.
double attitude_error(const Quat& a, const Quat& b)
{
    return length(log_rotation(conjugate(a) * b));
}

/// A solid box, half extents 0.1, 0.2, 0.3, 1 kg. References: Jacobi elliptic functions in extended precision,
/// checked against an extrapolation method in quadruple precision.
const Vec3 kBoxInertia{0.13 / 3, 0.10 / 3, 0.05 / 3};
const Vec3 kBoxSpin{1, 2, 3};
const Quat kBoxAt5{-0.36486374298686260041, 0.02356335734258868336, 0.02126200105200739735, -0.93051982491273477482};
const Vec3 kBoxSpinAt5{0.28086194081460047257, -2.4322669397127980927, 2.7501014800339831926};

}  // namespace

TEST_CASE("semi-implicit Euler is of order 1, classical Runge-Kutta of order 4")
{
    for (const int steps : {80, 160})
    {
        CHECK(std::fabs(observed_order(advance_euler, 8 * steps) - 1) < 0.05);
        CHECK(std::fabs(observed_order(advance_rk4, steps) - 4) < 0.05);
    }
}

TEST_CASE("semi-implicit Euler takes the new speed, Runge-Kutta the exact parabola")
{
    class Falling final : public FakeSystem
    {
    public:
        Falling() : FakeSystem(1) { u_[0] = 2; }
        void evaluate_kinematics() override { dx_[0] = u_[0]; }
        void evaluate_forces(double) override { du_[0] = -10; }
    };
    Falling euler, rk4;
    advance_euler(0.5, euler);
    CHECK(euler.speeds()[0] == -3);
    CHECK(euler.coordinates()[0] == -1.5);
    advance_rk4(0.5, rk4);
    CHECK(rk4.speeds()[0] == doctest::Approx(-3).epsilon(1e-15));
    CHECK(rk4.coordinates()[0] == doctest::Approx(2 * 0.5 - 0.5 * 10 * 0.25).epsilon(1e-14));
}

TEST_CASE("a free box turns as Euler's equations say")
{
    FreeBody coarse(kBoxInertia, kBoxSpin), fine(kBoxInertia, kBoxSpin);
    const Vec3 L = coarse.momentum();
    coarse.run(0.01, 500, advance_rk4);
    fine.run(0.001, 5000, advance_rk4);
    const double coarse_error = attitude_error(coarse.orientation(), kBoxAt5);
    const double fine_error = attitude_error(fine.orientation(), kBoxAt5);
    MESSAGE("attitude error at t = 5: " << coarse_error << " rad at h = 0.01, " << fine_error << " rad at 0.001");
    CHECK(coarse_error < 1e-7);
    CHECK(fine_error < 1e-11);
    CHECK(coarse_error / fine_error == doctest::Approx(1e4).epsilon(0.1));
    CHECK(length(fine.spin_B(fine.orientation()) - kBoxSpinAt5) < 2e-11);
    CHECK(coarse.momentum() == L);
    CHECK(coarse.energy() == doctest::Approx(0.49 / 3).epsilon(1e-8));
}

TEST_CASE("semi-implicit Euler turns a free box to first order")
{
    const auto error = [](double h, int steps)
    {
        FreeBody box(kBoxInertia, kBoxSpin);
        box.run(h, steps, advance_euler);
        return attitude_error(box.orientation(), kBoxAt5);
    };
    CHECK(std::log2(error(1e-4, 50000) / error(5e-5, 100000)) == doctest::Approx(1).epsilon(0.05));
}

TEST_CASE("an unstable spin flips when it should")
{
    // Dzhanibekov: I = (3, 2, 1), spin 10 about the middle axis, 1e-3 beside it; state at t = 10 in closed form.
    // The error grows by e^5.8 per second near the axis: the flips are where a wrong gyroscopic term shows first.
    const auto error = [](double h, int steps)
    {
        FreeBody wing({3, 2, 1}, {1e-3, 10, 1e-3});
        wing.run(h, steps, advance_rk4);
        const Vec3 expected{9.1429206965016778e-3, -9.9999876110424964, 1.5772729522424334e-2};
        return length(wing.spin_B(wing.orientation()) - expected);
    };
    CHECK(error(1e-3, 10000) < 2e-5);
    CHECK(error(2e-4, 50000) < 1e-7);
}

TEST_CASE("degenerate tops: a ball keeps its spin, a disc and a rod precess as they should")
{
    FreeBody ball({0.4, 0.4, 0.4}, {1, 2, 3});
    ball.run(0.01, 1000, advance_rk4);
    CHECK(length(ball.spin_B(ball.orientation()) - Vec3{1, 2, 3}) < 1e-13);

    // Symmetric top: w1 + i w2 turns at (I3 - I1)/I1 w3 in the body.
    const auto top_error = [](double i3, double w3)
    {
        FreeBody top({1, 1, i3}, {0.1, 0, w3});
        top.run(1e-4, 10000, advance_rk4);
        const double rate = (i3 - 1) * w3;
        const Vec3 w = top.spin_B(top.orientation());
        return std::fmax(std::fabs(w.x - 0.1 * std::cos(rate)), std::fabs(w.y - 0.1 * std::sin(rate)));
    };
    CHECK(top_error(2, 5) < 1e-13);
    CHECK(top_error(1e-4, 5) < 1e-12);
}

TEST_CASE("the exponential map and its differential agree across their series and closed forms")
{
    for (const double angle : {0.0, 1e-9, 1e-4, 0.3, 0.4999999, 0.5000001, 1.0, 3.0})
    {
        const Vec3 u = normalized(Vec3{1, -2, 3}) * angle;
        const Vec3 w{0.3, 0.7, -0.2};
        CAPTURE(angle);
        CHECK(norm(exp_rotation(u)) == doctest::Approx(1).epsilon(1e-15));
        CHECK(length(log_rotation(exp_rotation(u)) - u) < 1e-14);
        // q0 exp(u(t)) with u' = rate(u, w) turns at w: compare exp(u + d u') with exp(u) exp(d w).
        const double d = 1e-4;
        const Vec3 rate = rotation_vector_rate(u, w);
        const Vec3 ahead = log_rotation(exp_rotation(u) * exp_rotation(w * d));
        const Vec3 behind = log_rotation(exp_rotation(u) * exp_rotation(w * -d));
        if (angle < 2.5)
            CHECK(length((ahead - behind) / (2 * d) - rate) < 1e-8);
    }
}

TEST_CASE("the plugin declares the ladder")
{
    Registrar registrar;
    plab_plugin_register(registrar);
    REQUIRE(registrar.types().size() == 2);
    CHECK(registrar.types()[0].name == "Solver/SemiImplicitEuler");
    CHECK(registrar.types()[0].order == 1);
    CHECK(registrar.types()[1].name == "Solver/RungeKutta4");
    CHECK(registrar.types()[1].order == 4);
    for (const TypeInfo& type : registrar.types())
    {
        CHECK(type.elementwise);
        CHECK(type.family == "Solver");
        CHECK(type.commands[0].name == "Solver/Advance");
        CHECK(type.commands[0].phase == Phase::Advance);
    }
}
