// A block that rocks from edge to edge: about each edge it is an inverted pendulum.
#include <algorithm>
#include <cmath>

#include "exact/facts.h"
#include "exact/motions.h"
#include "model/numbers.h"
#include "plab/rotation.h"

namespace plab::exact
{
namespace
{

/// The block in the plane of its motion: up is N, aside is n x N; it turns about n.
struct Shape2
{
    Vec3 n, up, aside;
    double half_width = 0, half_height = 0;  ///< m
    double mass = 0, inertia = 0;            ///< about the centre along n
    double w0 = 0;                           ///< sqrt(m g R / J about an edge), rad/s
    double kept() const { return kept_by_rocking(inertia / mass, half_width, half_height); }
    /// Angle from hanging straight down to the flat block, turning about n, on the edge at `side` * half_width aside.
    double flat_angle(double side) const
    {
        // Lever from the edge to the centre: -side b aside + h up; n x (-up) = -aside.
        return std::atan2(side * half_width, -half_height);
    }
};

class Rocking final : public Solution
{
public:
    /// `tilt`: rad about n at the start, at rest on the edge that is low. `flat`: the pose when it lies.
    Rocking(std::string id, std::string ground, const Shape2& block, const State& flat, double tilt, double until)
        : id_(std::move(id)), ground_(std::move(ground)), block_(block), flat_(flat)
    {
        const double side = tilt > 0 ? 1 : -1;  // aside = n x up: a turn about +n leans towards it
        const double from = block.flat_angle(side);
        // By energy conservation: its speed when it falls flat is the speed from which it would rise to the same height.
        const double gain = 2 * block.w0 * block.w0 * (std::cos(from) - std::cos(from + tilt));
        double speed = std::sqrt(std::max(gain, 0.0)) * (tilt < 0 ? 1 : -1), edge = side;
        const double first = std::fabs(speed);
        pieces_.push_back({0, edge, PendulumMotion(block.w0, from + tilt, 0)});
        double t = PendulumMotion(block.w0, from, -speed).time_of_turn();
        const double r = block.kept();
        while (t <= until && r > 0 && std::fabs(speed) * r > 1e-9 * first)
        {
            edge = -edge, speed *= r;
            const PendulumMotion motion(block.w0, block.flat_angle(edge), speed);
            pieces_.push_back({t, edge, motion});
            impacts_.push_back(t);
            // It returns at the speed at which it left.
            t += 2 * motion.time_of_turn(), speed = -speed;
        }
        end_ = t;
    }
    bool state(const std::string& id, double t, State& out) const override
    {
        if (id != id_) return false;
        out = flat_;
        if (t >= end_) return true;
        const auto next = std::upper_bound(pieces_.begin(), pieces_.end(), t, [](double x, const Piece& p) { return x < p.begin; });
        const Piece& piece = *std::prev(next);
        double angle = 0, speed = 0;
        piece.motion.at(t - piece.begin, angle, speed);
        const double before = block_.flat_angle(piece.edge);
        // The law counts whole turns of its own.
        const Quat turn = exp_rotation(block_.n * (angle - before));
        const Vec3 edge = flat_.position + block_.aside * (piece.edge * block_.half_width) - block_.up * block_.half_height;
        const Vec3 lever = rotate(turn, flat_.position - edge);
        out.position = edge + lever, out.orientation = turn * flat_.orientation;
        out.angular_velocity = block_.n * speed, out.velocity = cross(out.angular_velocity, lever);
        return true;
    }
    double precision(double until) const override { return precision_after(20 * block_.w0 * until); }
    bool knows_contacts() const override { return true; }
    std::vector<ContactStart> contacts(double until) const override
    {
        std::vector<ContactStart> out;
        const auto& [a, b] = std::minmax(id_, ground_);
        for (const double t : impacts_)
            if (t <= until) out.push_back({"contact.impact", a, b, t});
        return out;
    }
    std::string words() const override
    {
        return "closed form of a rocking block: keeps " + model::format_real(block_.kept()) + " of its turning speed at each impact";
    }

private:
    struct Piece
    {
        double begin, edge;
        PendulumMotion motion;
    };
    std::string id_, ground_;
    Shape2 block_;
    State flat_;
    std::vector<Piece> pieces_;
    std::vector<double> impacts_;
    double end_ = 0;
};

/// The face that is nearly down, and the level axis about which the block is turned. Axes of the box, by number.
Result<Shape2> shape_of(const Geometry& box, const Quat& q, const Vec3& up, double& tilt, int& upright)
{
    Shape2 out;
    out.up = up, upright = -1;
    int axle = -1;
    for (int i = 0; i < 3; ++i)
    {
        const double along = std::fabs(dot(rotate(q, Vec3{i == 0 ? 1.0 : 0, i == 1 ? 1.0 : 0, i == 2 ? 1.0 : 0}), up));
        if (along > std::sqrt(0.5)) upright = i;
        if (along < 1e-12) axle = i;
    }
    if (upright < 0 || axle < 0) return reason("the box is not tilted about one of its own level axes by less than 45 degrees");
    const auto axis = [&](int i) { return rotate(q, Vec3{i == 0 ? 1.0 : 0, i == 1 ? 1.0 : 0, i == 2 ? 1.0 : 0}); };
    out.n = axis(axle), out.aside = cross(out.n, up);
    const Vec3 top = axis(upright) * (dot(axis(upright), up) < 0 ? -1.0 : 1.0);
    tilt = std::atan2(dot(out.n, cross(up, top)), dot(up, top));
    out.half_height = box.size[upright], out.half_width = box.size[3 - upright - axle];
    return out;
}

}  // namespace

Result<std::unique_ptr<Solution>> make_rocking(const SceneFacts& facts, double until)
{
    const auto place = body_and_plane(facts);
    if (!place) return place.errors();
    const auto box = only_shape(facts, place->body, GeometryKind::Box, "box");
    if (!box) return box.errors();
    const State start = present(facts, place->body);
    const std::uint32_t row = facts.world().component(place->body).host_index;
    const Vec3 up = place->normal, g = facts.gravity();
    if (length(cross(g, up)) > 1e-12 * length(g) || !(dot(g, up) < 0)) return reason("the plane is not level against gravity");
    if (length(box->pose.p - facts.bodies().center_B[row]) > 1e-12 * length(box->size))
        return reason("its centre of mass is not the box's");
    if (length(start.velocity) > 0 || length(start.angular_velocity) > 0) return reason("it does not start at rest");
    const auto e = law_of(facts, "restitution"), mu = law_of(facts, "friction");
    if (!e || !mu) return e ? mu.errors() : e.errors();
    if (*e != 0) return reason("this form is about restitution 0");
    double tilt = 0;
    int upright = 0;
    auto block = shape_of(*box, start.orientation * box->pose.q, up, tilt, upright);
    if (!block) return block.errors();
    const Vec3 Ln = rotate(start.orientation, facts.bodies().inertia_B[row] * rotate(conjugate(start.orientation), block->n));
    block->mass = facts.bodies().mass[row], block->inertia = dot(block->n, Ln);
    const double b = block->half_width, h = block->half_height, R2 = b * b + h * h;
    block->w0 = std::sqrt(block->mass * length(g) * std::sqrt(R2) / (block->inertia + block->mass * R2));
    if (tilt == 0 || std::fabs(tilt) >= std::atan2(b, h)) return reason("the block lies flat, or topples");
    // Flat on the edge that is now lower.
    const double side = tilt > 0 ? 1 : -1;
    const Quat back = exp_rotation(block->n * -tilt);
    const Vec3 edge = start.position + rotate(conjugate(back), block->aside * (side * b) - block->up * h);
    if (std::fabs(dot(edge - place->point, up)) > 1e-9 * std::sqrt(R2)) return reason("no edge of the box is on the plane");
    State flat = start;
    flat.position = edge - block->aside * (side * b) + block->up * h, flat.orientation = back * start.orientation;
    const double r = block->kept();
    if (r > 0 && *mu < h * (1 - r) / (b * (1 + r))) return reason("friction is too small to keep its edges from slipping at an impact");
    return std::unique_ptr<Solution>(
        std::make_unique<Rocking>(facts.world().id_of(place->body), facts.world().id_of(place->plane), *block, flat, tilt, until));
}

}  // namespace plab::exact
