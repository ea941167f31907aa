// A ball that bounces off level ground.
#include <algorithm>
#include <cmath>

#include "exact/facts.h"
#include "model/numbers.h"

namespace plab::exact
{
namespace
{

/// Flights between impacts at t_k; after the last one it rests on the plane.
class Bounce final : public Solution
{
public:
    Bounce(std::string ball, std::string plane, const State& start, double ground, double g, double e, double until)
        : ball_(std::move(ball)), plane_(std::move(plane)), start_(start), ground_(ground), g_(g), e_(e)
    {
        const double h = start.position.z - ground, v = start.velocity.z;
        // First impact: h + v t - g t^2/2 = 0, written without cancellation.
        const double root = std::sqrt(v * v + 2 * g * h);
        double t = v >= 0 ? (v + root) / g : 2 * h / (root - v), up = e * root;
        rest_ = e < 1 ? t + 2 * up / (g * (1 - e)) : std::numeric_limits<double>::infinity();
        // A flight shorter than a hundred picoseconds is ignored.
        while (t <= until && up > 1e-9 * root)
        {
            flights_.push_back({t, up});
            t += 2 * up / g, up *= e;
        }
        if (flights_.empty() && e == 0) rest_ = t;
    }
    bool state(const std::string& id, double t, State& out) const override
    {
        if (id != ball_) return false;
        out = start_;
        out.position.x += start_.velocity.x * t, out.position.y += start_.velocity.y * t;
        const auto next = std::upper_bound(flights_.begin(), flights_.end(), t, [](double x, const Flight& f) { return x < f.begin; });
        const double since = next == flights_.begin() ? t : t - std::prev(next)->begin;
        const double from = next == flights_.begin() ? start_.position.z : ground_,
                     up = next == flights_.begin() ? start_.velocity.z : std::prev(next)->up;
        if (t >= rest_ || (next == flights_.end() && !flights_.empty() && since > 2 * up / g_))
            out.position.z = ground_, out.velocity.z = 0;
        else
            out.position.z = from + up * since - 0.5 * g_ * since * since, out.velocity.z = up - g_ * since;
        return true;
    }
    bool knows_contacts() const override { return true; }
    std::vector<ContactStart> contacts(double until) const override
    {
        std::vector<ContactStart> out;
        const auto& [a, b] = std::minmax(ball_, plane_);
        for (const Flight& f : flights_)
            if (f.begin <= until) out.push_back({"contact.impact", a, b, f.begin});
        return out;
    }
    std::string words() const override
    {
        return "closed form of a bouncing ball: g = " + real(g_) + " m/s^2, restitution " + real(e_) + ", at rest from t = " + real(rest_) +
               " s";
    }

private:
    struct Flight
    {
        double begin, up;
    };
    std::string ball_, plane_;
    State start_;
    double ground_, g_, e_, rest_ = 0;
    std::vector<Flight> flights_;
};

}  // namespace

Result<std::unique_ptr<Solution>> make_bounce(const SceneFacts& facts, double until)
{
    const auto place = body_and_plane(facts);
    if (!place) return place.errors();
    const auto ball = only_shape(facts, place->body, GeometryKind::Sphere, "ball");
    if (!ball) return ball.errors();
    const State start = present(facts, place->body);
    const Vec3 g = facts.gravity();
    if (!(place->normal == Vec3{0, 0, 1}) || !(g.x == 0 && g.y == 0 && g.z < 0))
        return reason("the plane is not level, or gravity is not along -z");
    if (length(start.angular_velocity) > 0) return reason("the ball spins");
    const auto e = law_of(facts, "restitution");
    if (!e) return e.errors();
    const bool slides = start.velocity.x != 0 || start.velocity.y != 0;
    if (slides && facts.number("friction").value_or(1) != 0) return reason("the ball moves sideways, and there is friction");
    const double ground = place->point.z + ball->size.x;
    if (!(start.position.z > ground)) return reason("the ball does not start above the plane");
    return std::unique_ptr<Solution>(
        std::make_unique<Bounce>(facts.world().id_of(place->body), facts.world().id_of(place->plane), start, ground, -g.z, *e, until));
}

}  // namespace plab::exact
