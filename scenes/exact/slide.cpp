// A box that slides on a plane with Coulomb friction: up, down and across a slope.
#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/facts.h"
#include "model/numbers.h"

namespace plab::exact
{
namespace
{

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Along a line: a first phase in which friction and slope decelerate the box, then rest, or sliding back down.
class Straight final : public Solution
{
public:
    /// `speed` along `along`; `pull`: the slope's share of gravity along it; `grip`: mu times gravity across the plane.
    Straight(std::string id, const State& start, const Vec3& along, double speed, double pull, double grip)
        : id_(std::move(id)), start_(start), along_(along), speed_(speed), brake_(grip - pull)
    {
        stop_ = speed == 0 ? 0 : brake_ > 0 ? speed / brake_ : kNever;
        // Afterwards friction acts against the pull of the slope.
        back_ = grip >= std::fabs(pull) ? 0 : pull > 0 ? pull - grip : pull + grip;
    }
    bool state(const std::string& id, double t, State& out) const override
    {
        if (id != id_) return false;
        const double first = std::min(t, stop_), then = t - first;
        out = start_;
        out.position += along_ * (speed_ * first - 0.5 * brake_ * first * first + 0.5 * back_ * then * then);
        out.velocity = along_ * (t < stop_ ? speed_ - brake_ * t : back_ * then);
        return true;
    }
    std::string words() const override
    {
        return "closed form of a sliding box: slows by " + model::format_real(brake_) + " m/s^2 from " + model::format_real(speed_) +
               " m/s" +
               (std::isfinite(stop_) ? ", stops at t = " + model::format_real(stop_) + " s" + (back_ != 0 ? ", slides back" : "") : "");
    }

private:
    std::string id_;
    State start_;
    Vec3 along_;
    double speed_, brake_, stop_ = kNever, back_ = 0;
};

/// Across a slope. With phi from the slope's pull p to the velocity, f = mu N/m, k = f/p and w = tan(phi/2):
///   v' = p cos phi - f, v phi' = -p sin phi, so v = C (1 + w^2) w^(k-1) / 2, and time and place are powers of w.
class Curved final : public Solution
{
public:
    /// down: along the pull; aside: the side to which it moves at first; units m and s.
    Curved(std::string id, const State& start, const Vec3& down, const Vec3& aside, double pull, double grip)
        : id_(std::move(id)), start_(start), down_(down), aside_(aside), p_(pull), k_(grip / pull)
    {
        const double along = dot(start.velocity, down), across = dot(start.velocity, aside), v = length(start.velocity);
        w0_ = across / (v + along);  // tan(phi/2)
        c_ = 2 * v / ((1 + w0_ * w0_) * std::pow(w0_, k_ - 1));
    }
    bool state(const std::string& id, double t, State& out) const override
    {
        if (id != id_) return false;
        out = start_;
        const double w = w_at(t), a = c_ * c_ / (4 * p_);
        const double down = a * (part(2 * k_ - 2, w) - part(2 * k_ + 2, w)), aside = 2 * a * (part(2 * k_ - 1, w) + part(2 * k_ + 1, w));
        const double speed = w > 0 ? 0.5 * c_ * (1 + w * w) * std::pow(w, k_ - 1) : 0.0, q = 1 + w * w;
        out.position += down_ * down + aside_ * aside;
        out.velocity = down_ * (speed * (1 - w * w) / q) + aside_ * (speed * 2 * w / q);
        return true;
    }
    double precision(double) const override { return 1e-12; }
    std::string words() const override
    {
        return "closed form of a box that slides across a slope: friction is " + model::format_real(k_) + " of the slope's pull";
    }

private:
    /// Integral of x^(n-1) from w to its initial value.
    double part(double n, double w) const
    {
        if (std::fabs(n) < 1e-12) return w > 0 ? std::log(w0_ / w) : kNever;
        if (!(w > 0)) return n > 0 ? std::pow(w0_, n) / n : kNever;
        return -std::pow(w, n) * std::expm1(n * std::log(w0_ / w)) / -n;
    }
    double time_of(double w) const { return c_ / (2 * p_) * (part(k_ - 1, w) + part(k_ + 1, w)); }
    double w_at(double t) const
    {
        if (time_of(0) <= t) return 0;
        double low = std::log(w0_) - 1, high = std::log(w0_);
        while (time_of(std::exp(low)) < t && low > -700) low -= 1;
        for (int i = 0; i < 200 && high > low; ++i)
        {
            const double middle = 0.5 * (low + high);
            if (middle == low || middle == high) break;
            (time_of(std::exp(middle)) < t ? high : low) = middle;
        }
        return std::exp(high);
    }

    std::string id_;
    State start_;
    Vec3 down_, aside_;
    double p_, k_, w0_ = 0, c_ = 0;
};

}  // namespace

Result<std::unique_ptr<Solution>> make_slide(const SceneFacts& facts, double)
{
    const auto place = body_and_plane(facts);
    if (!place) return place.errors();
    const auto box = only_shape(facts, place->body, GeometryKind::Box, "box");
    if (!box) return box.errors();
    const State start = present(facts, place->body);
    const Vec3 n = place->normal, g = facts.gravity();
    const double gap = dot(start.position - place->point, n) - box->size.z;
    const Vec3 up = rotate(start.orientation * box->pose.q, Vec3{0, 0, 1});
    if (length(cross(up, n)) > 1e-12 || std::fabs(gap) > 1e-9 * length(box->size)) return reason("the box does not lie flat on the plane");
    if (std::fabs(dot(start.velocity, n)) > 1e-12 * length(start.velocity) || length(start.angular_velocity) > 0)
        return reason("the box does more than slide");
    const auto mu = law_of(facts, "friction");
    if (!mu) return mu.errors();
    const Vec3 pull = g - n * dot(g, n);
    const double speed = length(start.velocity), p = length(pull), grip = *mu * -dot(g, n);
    const std::string id = facts.world().id_of(place->body);
    const bool level = p <= 1e-12 * length(g);
    const Vec3 along = speed > 0 ? start.velocity / speed : level ? Vec3{} : pull / p;
    const Vec3 side = level ? Vec3{} : along - pull * (dot(along, pull) / (p * p));
    if (level || speed == 0 || length(side) < 1e-9)
        return std::unique_ptr<Solution>(std::make_unique<Straight>(id, start, along, speed, level ? 0.0 : dot(along, pull), grip));
    return std::unique_ptr<Solution>(std::make_unique<Curved>(id, start, pull / p, side / length(side), p, grip));
}

}  // namespace plab::exact
