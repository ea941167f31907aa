#include "workspace.h"

namespace plab::response
{

bool rests(const Contact& contact, double speed, const BounceLimit& limit)
{
    if (speed < 0) return false;
    const double pressing = -contact.normal_acceleration;
    if (!(pressing > 0)) return speed <= limit.rest_speed;
    const double height = std::max(limit.rest_height, 0x1p-48 * length(contact.point));
    return speed * speed <= 2 * pressing * height;
}

void describe_impact_law(Schema& s, Column<double>& friction, Column<double>& restitution)
{
    s.param(friction, "friction", unit::one, "Coulomb coefficient, unless a Material/Pair overrides it").or_else(0).not_negative();
    s.param(restitution, "restitution", unit::one,
            "coefficient of restitution: fraction of the approach speed that an impact returns, unless a "
            "Material/Pair overrides it")
        .or_else(0)
        .not_negative()
        .at_most(1);
}

void describe_rolling_resistance(Schema& s, Column<double>& rolling, Column<double>& spinning)
{
    s.param(rolling, "rolling_friction", unit::metre,
            "a couple of at most so much times the normal force resists that bodies roll on one another while they stay in touch, unless "
            "a Material/Pair overrides it")
        .or_else(0)
        .not_negative();
    s.param(spinning, "spinning_friction", unit::metre, "likewise that they spin about the normal").or_else(0).not_negative();
}

void Workspace::gather(const Impact& impact, Bodies& bodies)
{
    velocities.begin(impact.contacts, bodies, impact.mobility);
    order.clear();
    for (std::uint32_t i = 0; i < impact.contacts.size(); ++i)
        if (velocities.moves(i)) order.push_back(i);
}

void Workspace::sort_by_id(std::span<const Contact> contacts)
{
    std::sort(order.begin(), order.end(), [&](auto i, auto j) { return contacts[i].id < contacts[j].id; });
    before.clear();
    for (const std::uint32_t i : order) before.push_back(velocities.at(i));
}

}  // namespace plab::response
