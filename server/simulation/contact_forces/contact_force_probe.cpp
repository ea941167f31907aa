#include "simulation/contact_forces/contact_force_probe.h"

#include <algorithm>
#include <cmath>

#include "simulation/contacts/contacts.h"
#include "world/command_call.h"

namespace plab::simulation
{
namespace
{

void fit(Bodies& out)
{
    out.motion.resize(2), out.position.resize(2), out.orientation.resize(2), out.velocity.resize(2), out.angular_velocity.resize(2);
    out.angular_momentum.resize(2), out.mass.resize(2), out.inverse_mass.resize(2), out.needle.resize(2), out.inertia_B.resize(2);
    out.inverse_inertia_B.resize(2), out.center_B.resize(2), out.material.resize(2), out.shapes.resize(2);
}

void copy(const Bodies& from, std::uint32_t i, Bodies& to, std::uint32_t k)
{
    to.motion[k] = from.motion[i], to.position[k] = from.position[i], to.orientation[k] = from.orientation[i];
    to.mass[k] = from.mass[i], to.inverse_mass[k] = from.inverse_mass[i], to.needle[k] = from.needle[i];
    to.inertia_B[k] = from.inertia_B[i], to.inverse_inertia_B[k] = from.inverse_inertia_B[i], to.center_B[k] = from.center_B[i];
    to.material[k] = from.material[i];
}

}  // namespace

void run_force_laws(world::World& world, std::uint32_t response, const StepContext& context, std::span<Contact> contacts, Bodies& bodies,
                    Wrenches& wrenches)
{
    Impact impact;
    impact.dt = 1, impact.contacts = contacts;
    world::CommandCall call{context, {}};
    call.arguments.bodies = &bodies, call.arguments.wrenches = &wrenches, call.arguments.impact = &impact;
    call.select(world.table_of(response));
    (void)call.run(Phase::Touch, Rows(&world.component(response).row, 1));  // laws report trouble as events
}

void ForceProbe::take(const Bodies& bodies, const Contact& contact, double size, double h)
{
    contact_ = contact;
    axes_[0] = any_perpendicular(contact.normal), axes_[1] = cross(contact.normal, axes_[0]), axes_[2] = contact.normal;
    double of_a = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
        of_a = mobility_at(bodies, contact.a.index, contact.point, axes_[i]);
        mobility_[i] = of_a + mobility_at(bodies, contact.b.index, contact.point, axes_[i]);
    }
    share_a_ = mobility_[2] > 0 ? of_a / mobility_[2] : 0;
    speed_ = 0x1p-24 * size / h;
    size_ = 8 * size + length(bodies.position[contact.a.index]) + length(bodies.position[contact.b.index]);
    fit(bodies_);
    copy(bodies, contact.a.index, bodies_, 0), copy(bodies, contact.b.index, bodies_, 1);
    contact_.a = {Facet::Body, 0}, contact_.b = {Facet::Body, 1};
    wrenches_.bind(bodies_, shafts_);
    wrenches_.force.assign(2, {}), wrenches_.torque.assign(2, {});
}

Vec3 ForceProbe::force(world::World& world, std::uint32_t response, double depth, const Vec3& stretch, const Vec3& velocity)
{
    // The whole relative velocity is given to b: laws depend on the relative velocity only.
    for (std::size_t k = 0; k < 2; ++k)
    {
        bodies_.velocity[k] = k == 1 ? velocity : Vec3{};
        bodies_.angular_velocity[k] = bodies_.angular_momentum[k] = {};
        wrenches_.force[k] = wrenches_.torque[k] = {};
    }
    Contact c = contact_;
    c.depth = depth, c.stretch = stretch;
    StepContext context;
    run_force_laws(world, response, context, std::span(&c, 1), bodies_, wrenches_);
    return c.impulse;
}

double ForceProbe::normal_force(world::World& world, std::uint32_t response, double depth, double closing)
{
    return dot(force(world, response, depth, {}, contact_.normal * -closing), contact_.normal);
}

double ForceProbe::open_depth(world::World& world, std::uint32_t response)
{
    if (contact_.preload == 0 && contact_.rest_depth == 0) return 0;
    // The static force rises with depth: bracket its zero downwards, then bisect.
    const auto pushes = [&](double depth) { return normal_force(world, response, depth, 0) > 0; };
    double high = std::max(contact_.depth, contact_.rest_depth), step = 1e-12 * size_;
    double low = high - step;
    for (int i = 0; i < 100 && pushes(low); ++i) step *= 4, high = low, low = high - step;
    for (int i = 0; i < 200; ++i)
    {
        const double middle = 0.5 * (low + high);
        if (!(middle > low && middle < high)) break;
        (pushes(middle) ? high : low) = middle;
    }
    return low;
}

double ForceProbe::peak_depth(world::World& world, std::uint32_t response, double open_depth, double closing)
{
    if (!(closing > 0) || !(mobility_[2] > 0)) return open_depth;
    // Solve f(x) x = m v^2 to a few per cent: for a linear spring x is the amplitude exactly, for other powers approximately.
    const double energy = closing * closing / mobility_[2];
    const auto share = [&](double x) { return normal_force(world, response, open_depth + x, 0) * x / energy; };
    const double small = 1e-9 * size_;
    double x = small * std::sqrt(1 / std::max(share(small), 1e-40));
    const double first = share(x);
    if (std::fabs(first - 1) < 0.05) return open_depth + x;
    double low = x, high = x;
    for (int i = 0; i < 100 && share(low) > 1; ++i) low /= 4;
    for (int i = 0; i < 100 && share(high) < 1; ++i) high *= 4;
    for (int i = 0; i < 6; ++i)
    {
        x = std::sqrt(low * high);
        (share(x) < 1 ? low : high) = x;
    }
    return open_depth + high;
}

double ForceProbe::stored(world::World& world, std::uint32_t response, double depth, double rest_depth)
{
    // Gauss and Legendre's rule of order 10: exact for powers up to 9, and to 1e-4 for Hertz's law.
    constexpr std::array<double, 5> at{0.04691007703066802, 0.23076534494715845, 0.5, 0.7692346550528415, 0.9530899229693319};
    constexpr std::array<double, 5> weight{0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324,
                                           0.11846344252809454};
    contact_.rest_depth = rest_depth;
    const double travel = depth - rest_depth;
    double sum = 0;
    for (std::size_t i = 0; i < at.size(); ++i) sum += weight[i] * normal_force(world, response, rest_depth + at[i] * travel, 0);
    return sum * travel;
}

double ForceProbe::rest_depth_that_stores(world::World& world, std::uint32_t response, double depth, double energy)
{
    if (!(energy > 0)) return depth;
    double low = 0, high = depth;
    if (stored(world, response, depth, low) <= energy) return low;
    for (int i = 0; i < 40; ++i)
    {
        const double middle = 0.5 * (low + high);
        (stored(world, response, depth, middle) > energy ? low : high) = middle;
    }
    return high;
}

ContactRates ForceProbe::rates(world::World& world, std::uint32_t response, double depth)
{
    ContactRates out;
    const double step = std::max(1e-6 * std::fabs(depth - contact_.rest_depth), 1e-12 * size_);
    const double at_rest = normal_force(world, response, depth, 0);
    out.normal = std::fabs(normal_force(world, response, depth + step, 0) - at_rest) / step * mobility_[2];
    const double speed = speed_;
    out.damping = std::fabs(normal_force(world, response, depth, speed) - at_rest) / speed * mobility_[2];
    for (std::size_t i = 0; i < 2; ++i)
    {
        const auto along = [&](const Vec3& stretch, const Vec3& velocity)
        { return std::fabs(dot(force(world, response, depth, stretch, velocity), axes_[i])); };
        // Small enough to stay within Coulomb's cone wherever there is a force to speak of.
        const double small = 1e-3 * step;
        out.tangential = std::max(out.tangential, along(axes_[i] * small, {}) / small * mobility_[i]);
        out.damping = std::max(out.damping, along({}, axes_[i] * (1e-3 * speed)) / (1e-3 * speed) * mobility_[i]);
    }
    out.mobility = mobility_[2], out.share_a = share_a_;
    return out;
}

double ForceProbe::stiction(world::World& world, std::uint32_t response, double depth)
{
    const double small = 1e-9 * std::max(std::fabs(depth - contact_.rest_depth), 1e-12 * size_);
    return std::fabs(dot(force(world, response, depth, axes_[0] * small, {}), axes_[0])) / small;
}

}  // namespace plab::simulation
