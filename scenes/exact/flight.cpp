// Free flight: the centre of mass on its parabola, the attitude by Jacobi's elliptic functions.
//
// In principal axes, I1 <= I2 <= I3, a = 2 E I3 - L^2 and b = L^2 - 2 E I1 are sums of squares. Where L^2 > 2 E I2 the spin
// circles about axis 3 (else exchange 1 and 3):
//   w1 = A1 cn, w2 = +-A2 sn, w3 = +-A3 dn,  tau' = sqrt((I3 - I2) b / (I1 I2 I3)),
//   mc = (I3 - I1)(L^2 - 2 E I2) / ((I3 - I2) b).
// The angular momentum is constant in W; about it the body precesses by phi' = L (I1 w1^2 + I2 w2^2)/(I1^2 w1^2 + I2^2 w2^2).
// Source: Landau and Lifshitz, Mechanics, section 37.
#include <algorithm>
#include <array>
#include <cmath>

#include "exact/closed_form.h"
#include "exact/motions.h"
#include "model/values.h"
#include "plab/rotation.h"
#include "world/principal_axes.h"

namespace plab::exact
{
namespace
{

using world::principal_axes, world::PrincipalAxes;

// Gauss-Legendre, 8 points on [-1, 1]: positive nodes and weights.
constexpr std::array<double, 4> kNodes{0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959, 0.96028985649753623168};
constexpr std::array<double, 4> kWeights{0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054, 0.10122853629037625915};

class FreeSpin
{
public:
    FreeSpin(const Mat3& inertia_B, const Quat& q, const Vec3& w_W, double until);
    Quat attitude(double t) const;
    /// rad/s, of precession and of the circling spin together.
    double fastest() const { return steady_ ? length(w0_) : 0.25 / panel_; }
    Vec3 spin_W(double t) const { return rotate(attitude(t), rotate(principal_.q_BP, spin_P(t))); }

private:
    Vec3 spin_P(double t) const;
    Quat euler(double phi, const Vec3& w_P) const;
    double precession_rate(double t) const;
    double precession(double from, double to) const;

    PrincipalAxes principal_;  ///< axes 1, 2, 3 in the order used here
    Vec3 I_, w0_;
    bool steady_ = false;
    double A1_ = 0, A2_ = 0, A3_ = 0, rate_ = 0, tau0_ = 0, mc_ = 1, sign_ = 1, sign2_ = 1, L_ = 0;
    double panel_ = 1;         ///< s
    std::vector<double> phi_;  ///< rad, at the ends of panels
    Quat q0_, to_W_;
};

FreeSpin::FreeSpin(const Mat3& inertia_B, const Quat& q, const Vec3& w_W, double until) : principal_(principal_axes(inertia_B)), q0_(q)
{
    const Vec3 w_B = rotate(conjugate(q), w_W);
    I_ = principal_.moments, w0_ = rotate(conjugate(principal_.q_BP), w_B);
    const double middle = I_.z * (I_.z - I_.y) * w0_.z * w0_.z - I_.x * (I_.y - I_.x) * w0_.x * w0_.x;  // L^2 - 2 E I2
    if (middle < 0)
    {
        // Axes 3, 2, 1 with the middle one reversed: still right-handed.
        principal_ = reversed(principal_);
        I_ = principal_.moments, w0_ = rotate(conjugate(principal_.q_BP), w_B);
    }
    const double a = I_.x * (I_.z - I_.x) * w0_.x * w0_.x + I_.y * (I_.z - I_.y) * w0_.y * w0_.y;
    const double b = I_.y * (I_.y - I_.x) * w0_.y * w0_.y + I_.z * (I_.z - I_.x) * w0_.z * w0_.z;
    const int spinning = (w0_.x != 0 ? 1 : 0) + (w0_.y != 0 ? 1 : 0) + (w0_.z != 0 ? 1 : 0);
    steady_ = spinning < 2 || a == 0 || b == 0 || I_.z == I_.y;
    if (steady_) return;
    // Differences of moments and a, b change sign together when the axes are exchanged.
    A1_ = std::sqrt(a / (I_.x * (I_.z - I_.x))), A2_ = std::sqrt(a / (I_.y * (I_.z - I_.y))), A3_ = std::sqrt(b / (I_.z * (I_.z - I_.x)));
    rate_ = std::sqrt((I_.z - I_.y) * b / (I_.x * I_.y * I_.z));
    mc_ = std::clamp(std::fabs((I_.z - I_.x) * middle / ((I_.z - I_.y) * b)), 0.0, 1.0);
    sign_ = w0_.z < 0 ? -1 : 1, sign2_ = I_.z > I_.y ? sign_ : -sign_;
    tau0_ = elliptic_f(std::atan2(sign2_ * w0_.y / A2_, w0_.x / A1_), mc_);
    L_ = length(Vec3{I_.x * w0_.x, I_.y * w0_.y, I_.z * w0_.z});
    panel_ = 0.25 / (rate_ + L_ / std::min(I_.x, I_.z));
    const auto panels = static_cast<std::size_t>(std::ceil(until / panel_)) + 1;
    phi_.assign(1, 0.0);
    for (std::size_t i = 0; i < panels; ++i)
        phi_.push_back(phi_.back() + precession(static_cast<double>(i) * panel_, static_cast<double>(i + 1) * panel_));
    to_W_ = q * principal_.q_BP * conjugate(euler(0, w0_));
}

Vec3 FreeSpin::spin_P(double t) const
{
    if (steady_) return w0_;
    const Jacobi j = jacobi(rate_ * t + tau0_, mc_);
    return {A1_ * j.cn, sign2_ * A2_ * j.sn, sign_ * A3_ * j.dn};
}

double FreeSpin::precession_rate(double t) const
{
    const Vec3 w = spin_P(t);
    const double x = I_.x * w.x * w.x, y = I_.y * w.y * w.y;
    return L_ * (x + y) / (I_.x * x + I_.y * y);
}

double FreeSpin::precession(double from, double to) const
{
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double sum = 0;
    for (std::size_t i = 0; i < kNodes.size(); ++i)
        sum += kWeights[i] * (precession_rate(middle + half * kNodes[i]) + precession_rate(middle - half * kNodes[i]));
    return sum * half;
}

/// Rz(phi) Rx(theta) Rz(psi) with L along z: rotates principal axes to the frame of the angular momentum.
Quat FreeSpin::euler(double phi, const Vec3& w) const
{
    const Vec3 l{I_.x * w.x, I_.y * w.y, I_.z * w.z};
    const double theta = std::atan2(std::hypot(l.x, l.y), l.z), psi = std::atan2(l.x, l.y);
    const auto about = [](double angle, double x, double z) {
        return Quat{std::cos(angle / 2), x * std::sin(angle / 2), 0, z * std::sin(angle / 2)};
    };
    return about(phi, 0, 1) * about(theta, 1, 0) * about(psi, 0, 1);
}

Quat FreeSpin::attitude(double t) const
{
    if (steady_) return q0_ * exp_rotation(rotate(principal_.q_BP, w0_) * t);
    const std::size_t panel = std::min(static_cast<std::size_t>(std::max(0.0, t / panel_)), phi_.size() - 1);
    const double phi = phi_[panel] + precession(static_cast<double>(panel) * panel_, t);
    return normalized(to_W_ * euler(phi, spin_P(t)) * conjugate(principal_.q_BP));
}

class Flight final : public Solution
{
public:
    Flight(const SceneFacts& facts, double until) : g_(facts.gravity())
    {
        for (const std::uint32_t i : facts.dynamic(Facet::Body))
        {
            const std::uint32_t b = facts.world().component(i).host_index;
            const Bodies& bodies = facts.bodies();
            bodies_.emplace(facts.world().id_of(i),
                            Body{bodies.position[b], bodies.velocity[b],
                                 FreeSpin(bodies.inertia_B[b], bodies.orientation[b], bodies.angular_velocity[b], until)});
        }
    }
    bool state(const std::string& id, double t, State& out) const override
    {
        const auto found = bodies_.find(id);
        if (found == bodies_.end()) return false;
        const Body& body = found->second;
        out.position = body.x0 + body.v0 * t + g_ * (0.5 * t * t), out.velocity = body.v0 + g_ * t;
        out.orientation = body.spin.attitude(t), out.angular_velocity = body.spin.spin_W(t);
        return true;
    }
    double precision(double until) const override
    {
        double turned = 0;
        for (const auto& [id, body] : bodies_) turned = std::max(turned, body.spin.fastest() * until);
        return precision_after(turned);
    }
    std::string words() const override
    {
        return "closed form: x0 + v0 t + g t^2/2 with g = (" + model::format_value(Value(g_)) +
               ") m/s^2, attitude by Jacobi's elliptic functions";
    }

private:
    struct Body
    {
        Vec3 x0, v0;
        FreeSpin spin;
    };
    Vec3 g_;
    std::map<std::string, Body> bodies_;
};

}  // namespace

Result<std::unique_ptr<Solution>> make_flight(const SceneFacts& facts, double until)
{
    if (facts.dynamic(Facet::Body).empty()) return reason("it has no moving body");
    if (const std::string other = facts.foreign_force({"Field/Gravity"}); !other.empty())
        return reason(other + " acts too; only Field/Gravity may");
    if (facts.collides()) return reason("bodies may collide (CDetection/...); take the detection out");
    return std::unique_ptr<Solution>(std::make_unique<Flight>(facts, until));
}

}  // namespace plab::exact
