#include "exact/closed_form.h"

#include "model/names.h"
#include "model/numbers.h"
#include "model/text.h"

namespace plab::exact
{
namespace
{

constexpr Entry kRegistry[] = {
    {"parabola", "x = x0 + v0 t + g t^2/2; attitude by Jacobi's elliptic functions", "bodies under uniform gravity alone, no collision",
     &make_flight},
    {"torque-free", "Euler's equations by Jacobi's elliptic functions, precession by quadrature", "the same scene as parabola",
     &make_flight},
    {"oscillator", "x'' = -(k/m)(x - c) - (d/m) x', over-damped too",
     "one body or shaft on one Constraint/SpringDamper or TorsionSpring (a body: along a slider or its weight), or numbers stiffness and "
     "damping of a script",
     &make_oscillator},
    {"pendulum", "theta'' = -(w/J) sin theta by Jacobi's elliptic functions",
     "one body on a hinge, or in a plane on a ball; or one shaft with number weight_moment (m g l, N m: the torque at a right angle)",
     &make_pendulum},
    {"kepler", "x'' = -mu x/|x|^3 by Kepler's equation", "one body on an ellipse; number mu (m^3/s^2)", &make_kepler},
    {"bounce", "a ball that falls, rebounds with restitution e, and rests when its bounces have summed up",
     "one ball above one horizontal plane, gravity along -z, no spin, no sliding", &make_bounce},
    {"spring-bounce", "flights, and in between x'' = -g - (k/m) x - (d/m) x'",
     "the same on Response/Penalty: stiffness, damping, damping_ratio, restitution; pulls is true", &make_spring_bounce},
    {"slide", "v t - a t^2/2, rest or back down; across a slope v = C (1 + w^2) w^(k-1)/2 with w = tan(phi/2)",
     "one box flat on one plane, level or sloping, Coulomb friction", &make_slide},
    {"rocking", "an upside-down pendulum from edge to edge, Housner's loss at each impact",
     "one box at rest on an edge of level ground, restitution 0, friction that holds", &make_rocking},
    {"rest", "nothing moves", "boxes flat upon one another in columns on level ground, at rest, that do not topple", &make_rest},
    {"gears", "a = T/J, J = sum of ratio^2 J_i; speeds engage by sum of ratio J w",
     "shafts and couplings (rings that close too); torques of Field/Load, or number torque of a script on what it drives", &make_gears},
};

Result<std::map<std::string, double>> parse_given(std::string_view text)
{
    std::map<std::string, double> out;
    while (!text.empty())
    {
        const std::size_t comma = text.find(',');
        const std::string_view pair = text.substr(0, comma);
        const std::size_t equal = pair.find('=');
        if (equal == std::string_view::npos) return reason("'" + std::string(pair) + "' is not of the form key=value");
        auto value = model::parse_real(model::trimmed(pair.substr(equal + 1)));
        if (!value) return reason(std::string(pair) + ": " + value.error().reason);
        out[std::string(model::trimmed(pair.substr(0, equal)))] = *value;
        text = comma == std::string_view::npos ? std::string_view() : text.substr(comma + 1);
    }
    return out;
}

}  // namespace

std::span<const Entry> closed_forms() { return kRegistry; }

std::vector<std::uint32_t> SceneFacts::dynamic(Facet facet) const
{
    std::vector<std::uint32_t> out;
    for (const std::uint32_t i : world().in_id_order())
    {
        const world::Component& c = world().component(i);
        if (c.facet != facet) continue;
        if (facet == Facet::Body ? bodies().dynamic(c.host_index) : shafts().dynamic(c.host_index)) out.push_back(i);
    }
    return out;
}

std::vector<std::uint32_t> SceneFacts::of_type(const std::string& prefix) const
{
    std::vector<std::uint32_t> out;
    for (const std::uint32_t i : world().in_id_order())
        if (const auto* type = world().type_of(i); type && type->info.name.starts_with(prefix)) out.push_back(i);
    return out;
}

std::optional<double> SceneFacts::number(const std::string& name) const
{
    if (const auto found = given_.find(name); found != given_.end()) return found->second;
    for (const std::uint32_t i : world().in_id_order())
    {
        if (world().component(i).facet != Facet::Component) continue;
        const Value entry = world().get(i, "parameters." + name);
        if (const auto* d = std::get_if<double>(&entry)) return *d;
        const auto* type = world().type_of(i);
        const Field* field = type ? type->schema.find_field(name) : nullptr;
        // Values that a component computes are not properties of the scene.
        if (!field || field->kind == FieldKind::Output || field->type != FieldType::Real) continue;
        return std::get<double>(world().get(i, name));
    }
    return {};
}

Vec3 SceneFacts::gravity() const
{
    Vec3 g;
    for (const std::uint32_t i : of_type("Field/Gravity")) g += std::get<Vec3>(world().get(i, "acceleration"));
    return g;
}

std::string SceneFacts::foreign_force(const std::vector<std::string>& known) const
{
    for (const std::uint32_t i : world().in_id_order())
    {
        const auto* type = world().type_of(i);
        if (!type || !(type->takes_part(Phase::Force) || type->takes_part(Phase::Constrain))) continue;
        bool fine = false;
        for (const std::string& prefix : known) fine = fine || type->info.name.starts_with(prefix);
        if (!fine) return world().id_of(i) + " (" + type->info.name + ")";
    }
    return {};
}

Result<std::unique_ptr<Solution>> make_solution(const std::string& text, const simulation::Simulation& s, double until)
{
    const std::string name = text.substr(0, text.find(':'));
    auto given = parse_given(name.size() < text.size() ? std::string_view(text).substr(name.size() + 1) : std::string_view());
    if (!given) return reason("--reference exact:" + text + ": " + given.error().reason);
    std::vector<std::string> names;
    for (const Entry& e : kRegistry)
    {
        names.emplace_back(e.name);
        if (e.name != name) continue;
        auto made = e.make(SceneFacts(s, given.take()), until);
        if (!made) return reason("the closed form '" + name + "' does not describe this scene: " + made.error().reason);
        return made;
    }
    return reason("there is no closed form '" + name + "'" + model::did_you_mean(name, names) + "; there are " + model::quoted_list(names));
}

}  // namespace plab::exact
