// A ball that bounces on a linear contact spring with its damper: parabolas, and damped oscillations in between.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "exact/facts.h"
#include "exact/motions.h"
#include "model/numbers.h"

namespace plab::exact
{
namespace
{

class SpringBounce final : public Solution
{
public:
    /// `ground`: height of the centre at which the ball touches, m; g > 0, m/s^2.
    SpringBounce(std::string ball, std::string plane, const State& start, double ground, double g, const Damped& law, double until)
        : ball_(std::move(ball)), plane_(std::move(plane)), start_(start), ground_(ground), g_(g), law_(law)
    {
        double t = 0, z = start.position.z - ground, v = start.velocity.z;
        while (t <= until)
        {
            pieces_.push_back({t, z, v, false});
            const double root = std::sqrt(v * v + 2 * g * z);
            t += v >= 0 ? (v + root) / g : 2 * z / (root - v);
            if (t > until) break;
            pieces_.push_back({t, 0, -root, true});
            const double release = release_after(-root);
            if (!std::isfinite(release)) break;
            double height = 0;
            in_contact(release, -root, height, v);
            t += release, z = 0;
        }
    }
    bool state(const std::string& id, double t, State& out) const override
    {
        if (id != ball_) return false;
        out = start_;
        const auto next = std::upper_bound(pieces_.begin(), pieces_.end(), t, [](double x, const Piece& p) { return x < p.begin; });
        const Piece& piece = *std::prev(next);
        const double s = t - piece.begin;
        double z = piece.z + piece.v * s - 0.5 * g_ * s * s, v = piece.v - g_ * s;
        if (piece.touches) in_contact(s, piece.v, z, v);
        out.position.z = ground_ + z, out.velocity.z = v;
        out.position.x += start_.velocity.x * t, out.position.y += start_.velocity.y * t;
        return true;
    }
    double precision(double until) const override { return precision_after(std::sqrt(law_.w2) * until); }
    bool knows_contacts() const override { return true; }
    std::vector<ContactStart> contacts(double until) const override
    {
        std::vector<ContactStart> out;
        const auto& [a, b] = std::minmax(ball_, plane_);
        for (const Piece& p : pieces_)
            if (p.touches && p.begin <= until) out.push_back({"contact.impact", a, b, p.begin});
        return out;
    }
    std::string words() const override
    {
        return "closed form of a ball on a contact spring: " + real(std::sqrt(law_.w2)) + " rad/s, damping ratio " +
               real(law_.g / std::sqrt(law_.w2));
    }

private:
    struct Piece
    {
        double begin, z, v;
        bool touches;
    };
    /// About the height at which it would rest, m g/k below the first contact.
    void in_contact(double s, double v0, double& z, double& v) const
    {
        const double low = -g_ / law_.w2;
        law_.at(s, -low, v0, z, v);
        z += low;
    }
    /// The first s > 0 at which it is back at z = 0; infinite if it stays.
    double release_after(double v0) const
    {
        const double period = 2 * std::numbers::pi / std::sqrt(law_.w2), step = period / 64;
        double z = 0, v = 0, low = step, high = 0;
        for (double s = step; s < 3 * period && high == 0; s += step)
        {
            in_contact(s, v0, z, v);
            if (z >= 0)
                high = s;
            else
                low = s;
        }
        if (high == 0) return std::numeric_limits<double>::infinity();
        for (int i = 0; i < 100; ++i)
        {
            const double middle = 0.5 * (low + high);
            in_contact(middle, v0, z, v);
            (z < 0 ? low : high) = middle;
        }
        return high;
    }

    std::string ball_, plane_;
    State start_;
    double ground_, g_;
    Damped law_;
    std::vector<Piece> pieces_;
};

}  // namespace

Result<std::unique_ptr<Solution>> make_spring_bounce(const SceneFacts& facts, double until)
{
    const auto place = body_and_plane(facts);
    if (!place) return place.errors();
    const auto ball = only_shape(facts, place->body, GeometryKind::Sphere, "ball");
    if (!ball) return ball.errors();
    const auto springs = facts.of_type("Response/Penalty");
    if (springs.size() != 1) return reason("it has no Response/Penalty");
    const State start = present(facts, place->body);
    const Vec3 g = facts.gravity();
    if (!(place->normal == Vec3{0, 0, 1}) || !(g.x == 0 && g.y == 0 && g.z < 0))
        return reason("the plane is not level, or gravity is not along -z");
    if (length(start.angular_velocity) > 0) return reason("the ball spins");
    if ((start.velocity.x != 0 || start.velocity.y != 0) && facts.number("friction").value_or(1) != 0)
        return reason("the ball moves sideways, and there is friction");
    const auto e = law_of(facts, "restitution");
    if (!e) return e.errors();
    const Value pulls = facts.world().get(springs.front(), "pulls");
    if (const auto* b = std::get_if<bool>(&pulls); b && !*b) return reason("its damper may not pull (pulls is false)");
    const double k = real_of(facts, springs.front(), "stiffness");
    if (!(k > 0)) return reason("its Response/Penalty has no stiffness of its own");
    const double m = facts.bodies().mass[facts.world().component(place->body).host_index];
    // exp(-pi z / sqrt(1 - z^2)) = e.
    const double decay = *e < 1 && *e > 0 ? -std::log(*e) : 0;
    const double ratio = real_of(facts, springs.front(), "damping_ratio") + (*e > 0 ? decay / std::hypot(std::numbers::pi, decay) : 1.0);
    const double damping = real_of(facts, springs.front(), "damping") + 2 * ratio * std::sqrt(k * m);
    const double ground = place->point.z + ball->size.x;
    if (!(start.position.z > ground)) return reason("the ball does not start above the plane");
    return std::unique_ptr<Solution>(std::make_unique<SpringBounce>(facts.world().id_of(place->body), facts.world().id_of(place->plane),
                                                                    start, ground, -g.z, Damped{k / m, 0.5 * damping / m}, until));
}

}  // namespace plab::exact
