// One object on one linear spring: written in a script, declared between two points, along a slider or about an axle.
#include <cmath>

#include "exact/facts.h"
#include "exact/motions.h"
#include "model/numbers.h"

namespace plab::exact
{
namespace
{

/// The law holds for each coordinate of the place about `center`, and for the angle about `center_angle`.
class Oscillator final : public Solution
{
public:
    Oscillator(std::string id, const Damped& law, const Vec3& center, double center_angle, const State& start)
        : id_(std::move(id)), law_(law), center_(center), center_angle_(center_angle), start_(start)
    {
    }
    bool state(const std::string& id, double t, State& out) const override
    {
        if (id != id_) return false;
        out = start_;
        for (int i = 0; i < 3; ++i) law_.at(t, start_.position[i] - center_[i], start_.velocity[i], out.position[i], out.velocity[i]);
        out.position += center_;
        law_.at(t, start_.angle - center_angle_, start_.speed, out.angle, out.speed);
        out.angle += center_angle_;
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
    double center_angle_;
    State start_;
};

/// The line along which a declared spring acts, and the rest position of the body on it.
struct Line
{
    Vec3 u;              ///< unit vector
    double stretch = 0;  ///< m, at the start, along u
};

Result<Line> line_of(const SceneFacts& facts, std::uint32_t spring, std::uint32_t object, const State& start)
{
    const world::World& world = facts.world();
    const std::uint32_t row = world.component(object).host_index;
    for (const std::uint32_t other : participants(facts, spring, "a"))
        if (facts.bodies().motion[world.component(other).host_index] != Motion::Static) return reason("the spring's other end moves");
    if (!participants(facts, spring, "a").empty()) return reason("the spring is held by a body ; this form is for one held by the world");
    const Vec3 arm = rotate(start.orientation, vector_of(facts, spring, "point_b") - facts.bodies().center_B[row]);
    const Vec3 offset = start.position + arm - vector_of(facts, spring, "point_a");
    if (world.type_of(spring)->info.name == "Constraint/SpringDamper")
    {
        const double now = length(offset), given = real_of(facts, spring, "length");
        const double rest = std::isfinite(given) ? given : real_of(facts, spring, "placed_length");
        if (!(now > 0)) return reason("the spring has no length and so no direction");
        if (length(cross(arm, offset)) > 1e-12 * now * now) return reason("the spring does not pull at the body's centre of mass");
        return Line{offset / now, now - rest};
    }
    const Value along = world.get(spring, "along");
    if (std::get<std::string>(along) != "slide") return reason("the spring turns a body ; this form is for one that slides, or a shaft");
    const Vec3 u = vector_of(facts, spring, "travel_axis");
    return Line{u, dot(u, offset) - real_of(facts, spring, "rest")};
}

/// A declared spring: forces across its line must not move the body, unless a slider holds it.
Result<std::unique_ptr<Solution>> make_on_spring(const SceneFacts& facts, std::uint32_t spring, std::uint32_t object)
{
    const world::World& world = facts.world();
    const std::string id = world.id_of(object);
    if (const auto other =
            facts.foreign_force({"Field/Gravity", "Constraint/SpringDamper", "Constraint/TorsionSpring", "Constraint/Slider"});
        !other.empty())
        return reason(other + " acts too; only Field/Gravity, the spring and a slider may");
    const double k = real_of(facts, spring, "stiffness"), c = real_of(facts, spring, "damping");
    if (!(k > 0)) return reason("the spring has no stiffness");
    State start = present(facts, object);
    if (world.component(object).facet == Facet::Shaft)
    {
        const double J = facts.shafts().inertia[world.component(object).host_index];
        return std::unique_ptr<Solution>(
            std::make_unique<Oscillator>(id, Damped{k / J, 0.5 * c / J}, Vec3{}, real_of(facts, spring, "rest"), start));
    }
    const auto line = line_of(facts, spring, object, start);
    if (!line) return line.errors();
    const std::vector<std::uint32_t> sliders = facts.of_type("Constraint/Slider");
    const Vec3 u = line->u, g = facts.gravity(), across = g - u * dot(u, g);
    if (sliders.size() > 1) return reason("it has several sliders");
    if (sliders.empty() && length(across) > 1e-12 * length(g)) return reason("its weight pulls it off the spring's line");
    if (!sliders.empty())
    {
        const Value frame = world.get(sliders.front(), "frame_b");
        const Vec3 n = rotate(start.orientation * std::get<Quat>(frame), Vec3{0, 0, 1});
        if (length(cross(n, u)) > 1e-12) return reason("the slider's axis is not the spring's");
    }
    if (length(cross(start.velocity, u)) > 1e-12 * length(start.velocity) || length(start.angular_velocity) > 0)
        return reason(id + " does more than move along the spring");
    const double m = facts.bodies().mass[world.component(object).host_index];
    const Vec3 center = start.position - u * (line->stretch - dot(u, g) * m / k);
    return std::unique_ptr<Solution>(std::make_unique<Oscillator>(id, Damped{k / m, 0.5 * c / m}, center, 0.0, start));
}

}  // namespace

Result<std::unique_ptr<Solution>> make_oscillator(const SceneFacts& facts, double)
{
    const auto object = only_object(facts);
    if (!object) return object.errors();
    std::vector<std::uint32_t> springs = facts.of_type("Constraint/SpringDamper");
    for (const std::uint32_t i : facts.of_type("Constraint/TorsionSpring")) springs.push_back(i);
    if (springs.size() > 1) return reason("it has " + std::to_string(springs.size()) + " springs ; this form is for one");
    if (!springs.empty()) return make_on_spring(facts, springs.front(), *object);
    const auto k = facts.number("stiffness");
    if (!k || !(*k > 0)) return missing_number("stiffness", "N/m or N m/rad, positive");
    const world::Component& c = facts.world().component(*object);
    const bool body = c.facet == Facet::Body;
    const double m = body ? facts.bodies().mass[c.host_index] : facts.shafts().inertia[c.host_index];
    const State start = present(facts, *object);
    if (body && length(start.angular_velocity) > 0)
        return reason(facts.world().id_of(*object) + " turns; this form is about its place only");
    const Vec3 center{facts.number("center_x").value_or(0), facts.number("center_y").value_or(0), facts.number("center_z").value_or(0)};
    return std::unique_ptr<Solution>(std::make_unique<Oscillator>(facts.world().id_of(*object),
                                                                  Damped{*k / m, 0.5 * facts.number("damping").value_or(0) / m},
                                                                  center + facts.gravity() * (m / *k), 0.0, start));
}

}  // namespace plab::exact
