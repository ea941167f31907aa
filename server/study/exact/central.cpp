// One object, one force: oscillator, pendulum, Kepler's ellipse.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/values.h"
#include "study/exact/elliptic.h"
#include "study/exact/exact.h"

namespace plab::study
{
namespace
{

std::string real(double v) { return model::format_real(v); }

/// x'' = -w2 x - 2 g x' from (x0, v0): under-damped, critical and over-damped in one.
struct Damped
{
    double w2 = 0, g = 0;
    void at(double t, double x0, double v0, double& x, double& v) const
    {
        const double d = w2 - g * g, fade = std::exp(-g * t);
        double c = 1, s = t;  // cos(w t) and sin(w t)/w, or their hyperbolic kin
        if (d > 0) c = std::cos(std::sqrt(d) * t), s = std::sin(std::sqrt(d) * t) / std::sqrt(d);
        if (d < 0) return over(t, std::sqrt(-d), x0, v0, x, v);
        x = fade * (x0 * c + (v0 + g * x0) * s);
        v = fade * (v0 * c - (w2 * x0 + g * v0) * s);
    }

private:
    /// Decays slow = w2/fast, without the cancellation of g - sqrt(g^2 - w2).
    void over(double t, double r, double x0, double v0, double& x, double& v) const
    {
        const double fast = g + r, slow = w2 / fast;
        const double a = (v0 + fast * x0) / (fast - slow), b = -(v0 + slow * x0) / (fast - slow);
        const double ea = a * std::exp(-slow * t), eb = b * std::exp(-fast * t);
        x = ea + eb, v = -slow * ea - fast * eb;
    }
};

class Oscillator final : public ExactSolution
{
public:
    Oscillator(std::string id, const Damped& law, const Vec3& center, const ExactState& start)
        : id_(std::move(id)), law_(law), center_(center), start_(start)
    {
    }
    bool state(const std::string& id, double t, ExactState& out) const override
    {
        if (id != id_) return false;
        out = start_;
        for (int i = 0; i < 3; ++i) law_.at(t, start_.position[i] - center_[i], start_.velocity[i], out.position[i], out.velocity[i]);
        out.position += center_;
        law_.at(t, start_.angle, start_.speed, out.angle, out.speed);
        return true;
    }
    double precision(double until) const override { return precision_after(std::sqrt(law_.w2) * until); }
    std::string words() const override
    {
        return "closed form of the oscillator: natural frequency " + real(std::sqrt(law_.w2)) + " rad/s, damping ratio " +
               real(law_.g / std::sqrt(law_.w2));
    }

private:
    std::string id_;
    Damped law_;
    Vec3 center_;
    ExactState start_;
};

/// sin(theta/2) = k sn (libration) or theta = 2 am (rotation).
class Pendulum final : public ExactSolution
{
public:
    Pendulum(std::string id, double w0, double theta, double speed) : id_(std::move(id)), w0_(w0)
    {
        // Whole turns do not matter to the force.
        turns_ = 2 * std::numbers::pi * std::round(theta / (2 * std::numbers::pi));
        const double half = 0.5 * (theta - turns_), s = std::sin(half), c = std::cos(half), u = 0.5 * speed / w0;
        k2_ = s * s + u * u;
        excess_ = c * c - u * u;  // 1 - k^2
        swings_ = excess_ > 0;
        if (swings_)
            mc_ = excess_, tau0_ = k2_ > 0 ? elliptic_f(std::atan2(s, u), mc_) : 0;
        else
            mc_ = -excess_ / k2_, sign_ = speed < 0 ? -1 : 1, tau0_ = elliptic_f(sign_ * half, mc_);
    }
    bool state(const std::string& id, double t, ExactState& out) const override
    {
        if (id != id_) return false;
        const double k = std::sqrt(k2_), u = tau0_ + w0_ * t * (swings_ ? 1 : k);
        const Jacobi j = jacobi(u, mc_);
        if (swings_)
            out.angle = turns_ + 2 * std::asin(k * j.sn), out.speed = 2 * k * w0_ * j.cn;
        else
            out.angle = turns_ + sign_ * 2 * amplitude(u, mc_), out.speed = sign_ * 2 * k * w0_ * j.dn;
        return true;
    }
    double precision(double until) const override { return precision_after(2 * w0_ * std::sqrt(std::max(1.0, k2_)) * until); }
    std::string words() const override { return "closed form of the pendulum: sqrt(w/J) = " + real(w0_) + " rad/s, k^2 = " + real(k2_); }

private:
    std::string id_;
    double w0_, turns_ = 0, k2_ = 0, excess_ = 1, mc_ = 1, tau0_ = 0, sign_ = 1;
    bool swings_ = true;
};

class Kepler final : public ExactSolution
{
public:
    Kepler(std::string id, double mu, const ExactState& start) : id_(std::move(id)), mu_(mu), start_(start)
    {
        const Vec3 r = start.position, v = start.velocity;
        a_ = 1 / (2 / length(r) - length_squared(v) / mu);
        n_ = std::sqrt(mu / (a_ * a_ * a_));
        // e cos E0 and e sin E0: no eccentricity vector, so that circles are no special case.
        ec_ = 1 - length(r) / a_, es_ = dot(r, v) / std::sqrt(mu * a_);
    }
    bool state(const std::string& id, double t, ExactState& out) const override
    {
        if (id != id_) return false;
        out = start_;
        // d: eccentric anomaly since the start; n t = d + es (1 - cos d) - ec sin d.
        const double turn = 2 * std::numbers::pi, m = n_ * t - turn * std::floor(n_ * t / turn);
        double low = 0, high = turn, d = m;
        for (int i = 0; i < 200; ++i)
        {
            const double f = d + es_ * (1 - std::cos(d)) - ec_ * std::sin(d) - m;
            (f > 0 ? high : low) = d;
            const double newton = d - f / (1 + es_ * std::sin(d) - ec_ * std::cos(d));
            const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
            if (next == d || std::fabs(next - d) < 1e-17) break;
            d = next;
        }
        const double s = std::sin(d), c1 = 2 * std::sin(d / 2) * std::sin(d / 2);  // 1 - cos d
        const double r0 = length(start_.position), r = a_ * (1 - ec_ * (1 - c1) + es_ * s);
        const double f = 1 - a_ / r0 * c1, g = (s - ec_ * s + es_ * c1) / n_;
        const double df = -std::sqrt(mu_ * a_) * s / (r * r0), dg = 1 - a_ / r * c1;
        out.position = start_.position * f + start_.velocity * g;
        out.velocity = start_.position * df + start_.velocity * dg;
        return true;
    }
    /// The angular speed at the near end of an ellipse is n (1 - e)^-2, about.
    double precision(double until) const override
    {
        const double near = 1 - std::hypot(ec_, es_);
        return precision_after(n_ * until / (near * near));
    }
    std::string words() const override
    {
        return "closed form of Kepler's ellipse: mu = " + real(mu_) + " m^3/s^2, semi-major axis " + real(a_) + " m, eccentricity " +
               real(std::hypot(ec_, es_));
    }

private:
    std::string id_;
    double mu_, a_ = 0, n_ = 0, ec_ = 0, es_ = 0;
    ExactState start_;
};

ExactState present(const SceneFacts& facts, std::uint32_t i)
{
    ExactState out;
    const world::Component& c = facts.world().component(i);
    if (c.facet == Facet::Shaft)
    {
        out.angle = facts.shafts().angle[c.host_index], out.speed = facts.shafts().speed[c.host_index];
        return out;
    }
    const Bodies& b = facts.bodies();
    out.position = b.position[c.host_index], out.velocity = b.velocity[c.host_index];
    out.orientation = b.orientation[c.host_index], out.angular_velocity = b.angular_velocity[c.host_index];
    return out;
}

/// The only moving object, a body or a shaft.
Result<std::uint32_t> only_object(const SceneFacts& facts)
{
    const auto bodies = facts.dynamic(Facet::Body), shafts = facts.dynamic(Facet::Shaft);
    if (bodies.size() + shafts.size() != 1)
        return reason("it has " + std::to_string(bodies.size() + shafts.size()) + " moving objects; this form is about one");
    return bodies.empty() ? shafts.front() : bodies.front();
}

Error missing(const std::string& name, const std::string& what)
{
    return reason("no component has a number '" + name + "' (" + what + "); give it as exact:NAME:" + name + "=VALUE");
}

}  // namespace

Result<std::unique_ptr<ExactSolution>> make_oscillator(const SceneFacts& facts, double)
{
    const auto object = only_object(facts);
    if (!object) return object.errors();
    const auto k = facts.number("stiffness");
    if (!k || !(*k > 0)) return missing("stiffness", "N/m or N m/rad, positive");
    const world::Component& c = facts.world().component(*object);
    const bool body = c.facet == Facet::Body;
    const double m = body ? facts.bodies().mass[c.host_index] : facts.shafts().inertia[c.host_index];
    const ExactState start = present(facts, *object);
    if (body && length(start.angular_velocity) > 0)
        return reason(facts.world().id_of(*object) + " turns; this form is about its place only");
    const Vec3 center{facts.number("center_x").value_or(0), facts.number("center_y").value_or(0), facts.number("center_z").value_or(0)};
    return std::unique_ptr<ExactSolution>(std::make_unique<Oscillator>(facts.world().id_of(*object),
                                                                       Damped{*k / m, 0.5 * facts.number("damping").value_or(0) / m},
                                                                       center + facts.gravity() * (m / *k), start));
}

Result<std::unique_ptr<ExactSolution>> make_pendulum(const SceneFacts& facts, double)
{
    const auto object = only_object(facts);
    if (!object) return object.errors();
    const world::Component& c = facts.world().component(*object);
    if (c.facet != Facet::Shaft) return reason(c.id + " is no shaft");
    const auto w = facts.number("weight_moment");
    if (!w || !(*w > 0)) return missing("weight_moment", "m g l, N m, positive");
    const double inertia = facts.shafts().inertia[c.host_index];
    return std::unique_ptr<ExactSolution>(
        std::make_unique<Pendulum>(c.id, std::sqrt(*w / inertia), facts.shafts().angle[c.host_index], facts.shafts().speed[c.host_index]));
}

Result<std::unique_ptr<ExactSolution>> make_kepler(const SceneFacts& facts, double)
{
    const auto object = only_object(facts);
    if (!object) return object.errors();
    if (facts.world().component(*object).facet != Facet::Body) return reason("its moving object is no body");
    const auto mu = facts.number("mu");
    if (!mu || !(*mu > 0)) return missing("mu", "m^3/s^2, positive");
    const ExactState start = present(facts, *object);
    if (!(length_squared(start.velocity) < 2 * *mu / length(start.position)))
        return reason("the body is not bound: its path is no ellipse");
    return std::unique_ptr<ExactSolution>(std::make_unique<Kepler>(facts.world().id_of(*object), *mu, start));
}

}  // namespace plab::study
