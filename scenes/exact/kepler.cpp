// A body and a sun: Kepler's ellipse.
#include <cmath>
#include <numbers>

#include "exact/facts.h"
#include "model/numbers.h"

namespace plab::exact
{
namespace
{

class Kepler final : public Solution
{
public:
    Kepler(std::string id, double mu, const State& start) : id_(std::move(id)), mu_(mu), start_(start)
    {
        const Vec3 r = start.position, v = start.velocity;
        a_ = 1 / (2 / length(r) - length_squared(v) / mu);
        n_ = std::sqrt(mu / (a_ * a_ * a_));
        // e cos E0 and e sin E0: no eccentricity vector, so that circles are not a special case.
        ec_ = 1 - length(r) / a_, es_ = dot(r, v) / std::sqrt(mu * a_);
    }
    bool state(const std::string& id, double t, State& out) const override
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
    /// The angular speed at the periapsis is approximately n (1 - e)^-2.
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
    State start_;
};

}  // namespace

Result<std::unique_ptr<Solution>> make_kepler(const SceneFacts& facts, double)
{
    const auto object = only_object(facts);
    if (!object) return object.errors();
    if (facts.world().component(*object).facet != Facet::Body) return reason("its moving object is not a body");
    const auto mu = facts.number("mu");
    if (!mu || !(*mu > 0)) return missing_number("mu", "m^3/s^2, positive");
    const State start = present(facts, *object);
    if (!(length_squared(start.velocity) < 2 * *mu / length(start.position)))
        return reason("the body is not bound: its path is not an ellipse");
    return std::unique_ptr<Solution>(std::make_unique<Kepler>(facts.world().id_of(*object), *mu, start));
}

}  // namespace plab::exact
