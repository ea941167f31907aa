// A ball that bounces, a box that slides to a stop.
#include <algorithm>
#include <cmath>

#include "model/values.h"
#include "study/exact/exact.h"

namespace plab::study
{
namespace
{

std::string real(double v) { return model::format_real(v); }

/// The only moving body, and the plane that it may meet: a point on it and its normal in W.
struct OnPlane
{
    std::uint32_t body = 0, plane = 0;  ///< directory indices
    Vec3 point, normal;
};

Result<OnPlane> body_and_plane(const SceneFacts& facts)
{
    const auto bodies = facts.dynamic(Facet::Body);
    if (bodies.size() != 1) return reason("it has " + std::to_string(bodies.size()) + " moving bodies; this form is about one");
    if (!facts.collides()) return reason("nothing collides: it has no CDetection/...");
    OnPlane out;
    out.body = bodies.front();
    int planes = 0;
    const world::HostTables& host = facts.world().host();
    for (const std::uint32_t i : facts.world().in_id_order())
    {
        const world::Component& c = facts.world().component(i);
        if (c.facet != Facet::Body || i == out.body) continue;
        for (const Ref shape : host.bodies.shapes[c.host_index])
        {
            if (host.shapes.geometry[shape.index].kind != GeometryKind::Plane)
                return reason(c.id + " is no plane; only one plane may be there");
            const Pose pose = host.bodies.pose(c.host_index) * host.shapes.geometry[shape.index].pose;
            out.plane = i, out.point = pose.p, out.normal = rotate(pose.q, Vec3{0, 0, 1});
            ++planes;
        }
    }
    if (planes != 1) return reason("it has " + std::to_string(planes) + " planes; this form is about one");
    if (const std::string other = facts.foreign_force({"Field/Gravity"}); !other.empty())
        return reason(other + " acts too; only Field/Gravity may");
    return out;
}

Result<Geometry> only_shape(const SceneFacts& facts, std::uint32_t body, GeometryKind kind, const std::string& name)
{
    const world::HostTables& host = facts.world().host();
    const RefList& shapes = host.bodies.shapes[facts.world().component(body).host_index];
    if (shapes.size() != 1 || host.shapes.geometry[shapes.front().index].kind != kind)
        return reason(facts.world().id_of(body) + " is no " + name);
    return host.shapes.geometry[shapes.front().index];
}

ExactState present(const SceneFacts& facts, std::uint32_t i)
{
    const Bodies& b = facts.bodies();
    const std::uint32_t r = facts.world().component(i).host_index;
    return {b.position[r], b.orientation[r], b.velocity[r], b.angular_velocity[r], 0, 0};
}

/// Flights between impacts at t_k; after the last one it rests on the plane.
class Bounce final : public ExactSolution
{
public:
    Bounce(std::string ball, std::string plane, const ExactState& start, double ground, double g, double e, double until)
        : ball_(std::move(ball)), plane_(std::move(plane)), start_(start), ground_(ground), g_(g), e_(e)
    {
        const double h = start.position.z - ground, v = start.velocity.z;
        // First impact: h + v t - g t^2/2 = 0, written without cancellation.
        const double root = std::sqrt(v * v + 2 * g * h);
        double t = v >= 0 ? (v + root) / g : 2 * h / (root - v), up = e * root;
        rest_ = e < 1 ? t + 2 * up / (g * (1 - e)) : std::numeric_limits<double>::infinity();
        // A flight of a hundred picoseconds is none.
        while (t <= until && up > 1e-9 * root)
        {
            flights_.push_back({t, up});
            t += 2 * up / g, up *= e;
        }
        if (flights_.empty() && e == 0) rest_ = t;
    }
    bool state(const std::string& id, double t, ExactState& out) const override
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
    std::vector<Touch> contacts(double until) const override
    {
        std::vector<Touch> out;
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
    ExactState start_;
    double ground_, g_, e_, rest_ = 0;
    std::vector<Flight> flights_;
};

class Slide final : public ExactSolution
{
public:
    Slide(std::string id, const ExactState& start, const Vec3& along, double speed, double pull, double mu_g)
        : id_(std::move(id)), start_(start), along_(along), speed_(speed), brake_(mu_g - pull), holds_(mu_g >= std::fabs(pull))
    {
    }
    bool state(const std::string& id, double t, ExactState& out) const override
    {
        if (id != id_) return false;
        out = start_;
        const double stop = brake_ > 0 ? speed_ / brake_ : std::numeric_limits<double>::infinity();
        const double s = holds_ ? std::min(t, stop) : t;
        out.position += along_ * (speed_ * s - 0.5 * brake_ * s * s);
        out.velocity = along_ * (speed_ - brake_ * s);
        return true;
    }
    std::string words() const override
    {
        return "closed form of a sliding box: slows by " + real(brake_) + " m/s^2 from " + real(speed_) + " m/s" +
               (holds_ && brake_ > 0 ? ", stops at t = " + real(speed_ / brake_) + " s after " + real(0.5 * speed_ * speed_ / brake_) + " m"
                                     : "");
    }

private:
    std::string id_;
    ExactState start_;
    Vec3 along_;
    double speed_, brake_;
    bool holds_;
};

Result<double> law_of(const SceneFacts& facts, const std::string& name)
{
    if (!facts.of_type("Material/Pair").empty()) return reason("materials set " + name + "; give it as exact:...:" + name + "=VALUE");
    const auto value = facts.number(name);
    if (!value) return reason("its response has no '" + name + "'; give it as exact:...:" + name + "=VALUE");
    return *value;
}

}  // namespace

Result<std::unique_ptr<ExactSolution>> make_bounce(const SceneFacts& facts, double until)
{
    const auto place = body_and_plane(facts);
    if (!place) return place.errors();
    const auto ball = only_shape(facts, place->body, GeometryKind::Sphere, "ball");
    if (!ball) return ball.errors();
    const ExactState start = present(facts, place->body);
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
    return std::unique_ptr<ExactSolution>(
        std::make_unique<Bounce>(facts.world().id_of(place->body), facts.world().id_of(place->plane), start, ground, -g.z, *e, until));
}

Result<std::unique_ptr<ExactSolution>> make_slide(const SceneFacts& facts, double)
{
    const auto place = body_and_plane(facts);
    if (!place) return place.errors();
    const auto box = only_shape(facts, place->body, GeometryKind::Box, "box");
    if (!box) return box.errors();
    const ExactState start = present(facts, place->body);
    const Vec3 n = place->normal, g = facts.gravity();
    const double gap = dot(start.position - place->point, n) - box->size.z;
    const Vec3 up = rotate(start.orientation * box->pose.q, Vec3{0, 0, 1});
    if (length(cross(up, n)) > 1e-12 || std::fabs(gap) > 1e-9 * length(box->size)) return reason("the box does not lie flat on the plane");
    if (std::fabs(dot(start.velocity, n)) > 1e-12 * length(start.velocity) || length(start.angular_velocity) > 0)
        return reason("the box does more than slide");
    const auto mu = law_of(facts, "friction");
    if (!mu) return mu.errors();
    const Vec3 pull = g - n * dot(g, n);
    const double speed = length(start.velocity), down = length(pull);
    const Vec3 along = speed > 0 ? start.velocity / speed : down > 0 ? pull / down : Vec3{};
    if (down > 1e-12 * length(g) && length(cross(along, pull)) > 1e-9 * down)
        return reason("the box does not slide along the slope's steepest line");
    if (dot(along, pull) < -1e-12 * length(g)) return reason("the box slides uphill; this form goes downhill or along the level");
    return std::unique_ptr<ExactSolution>(
        std::make_unique<Slide>(facts.world().id_of(place->body), start, along, speed, dot(along, pull), *mu * -dot(g, n)));
}

}  // namespace plab::study
