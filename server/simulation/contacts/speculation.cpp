#include "simulation/contacts/speculation.h"

#include <algorithm>
#include <cmath>

namespace plab::simulation
{
namespace
{

/// Safety factor on speeds, which change while a manager solves, as neighbours push.
constexpr double kSpeculationReserve = 2;

/// m/s: speed of the fastest point of a body about its centre.
double turning(const Bodies& bodies, std::span<const double> radius, std::uint32_t b)
{
    return std::isfinite(radius[b]) ? length(bodies.angular_velocity[b]) * radius[b] : 0.0;
}

/// m/s: speed of the fastest point of a body.
double fastest_point(const Bodies& bodies, std::span<const double> radius, std::uint32_t b)
{
    return length(bodies.velocity[b]) + turning(bodies, radius, b);
}

double step_of_acceleration(const Bodies& bodies, const Contact& c, double acceleration, double h)
{
    const double moving = (bodies.dynamic(c.a.index) ? 1 : 0) + (bodies.dynamic(c.b.index) ? 1 : 0);
    return moving * acceleration * h * h;
}

}  // namespace

double speculative_margin(const Bodies& bodies, std::span<const double> radius_of_body, double acceleration, double h)
{
    // In the worst case the two fastest bodies meet.
    double first = 0, second = 0;
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        const double speed = bodies.motion[b] == Motion::Static ? 0 : fastest_point(bodies, radius_of_body, b);
        second = std::max(second, std::min(first, speed)), first = std::max(first, speed);
    }
    return kSpeculationReserve * (first + second) * h + 2 * acceleration * h * h;
}

double closing_margin(const Bodies& bodies, std::span<const double> radius_of_body, Ref a, Ref b, const Vec3& normal, double h)
{
    const double closing = std::max(0.0, -dot(bodies.velocity[b.index] - bodies.velocity[a.index], normal)) +
                           turning(bodies, radius_of_body, a.index) + turning(bodies, radius_of_body, b.index);
    const double size = std::min(radius_of_body[a.index], radius_of_body[b.index]);
    return std::min(kSpeculationReserve * closing * h, 0.5 * size);
}

bool may_close(const Bodies& bodies, std::span<const double> radius_of_body, const Contact& contact, double acceleration, double h)
{
    if (contact.depth >= 0) return true;
    const Vec3 apart = bodies.velocity[contact.b.index] - bodies.velocity[contact.a.index];
    const double closing = std::max(0.0, -dot(apart, contact.normal)) + turning(bodies, radius_of_body, contact.a.index) +
                           turning(bodies, radius_of_body, contact.b.index);
    return -contact.depth <= kSpeculationReserve * closing * h + step_of_acceleration(bodies, contact, acceleration, h);
}

}  // namespace plab::simulation
