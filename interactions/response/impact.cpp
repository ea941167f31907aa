#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "impact_law.h"
#include "impulse.h"

namespace plab::response
{
namespace
{
/// What an impulse changes of a body.
struct Motions
{
    Vec3 velocity, spin, momentum;
};

/// Patch by patch, the one that closes fastest first, until none closes: how Mirtich's bodies meet.
class ImpactSequence
{
public:
    ImpactSequence(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact)
        : settings_(settings), work_(work), bodies_(bodies), contacts_(impact.contacts)
    {
    }
    void run(Impact& impact);

private:
    void prepare();
    void group();
    double closing_speed(std::uint32_t contact) const { return -work_.points[contact].velocity(bodies_).z; }
    double closing_speed(const Patch& patch) const;
    bool rests(const Contact& contact, double speed) const;
    void hit(const Patch& patch, bool plastic);
    void hit_point(std::uint32_t contact, double restitution);
    void hit_face(const Patch& patch, double restitution);
    double try_face(const Patch& patch, double restitution);

    const ImpactSettings& settings_;
    Workspace& work_;
    Bodies& bodies_;
    std::span<Contact> contacts_;
    double threshold_ = 0;  // m/s, closing speed that is none
};

void ImpactSequence::prepare()
{
    work_.points.clear(), work_.order.clear();
    double speed = 0;
    for (std::uint32_t i = 0; i < contacts_.size(); ++i)
    {
        contacts_[i].impulse = {};
        work_.points.emplace_back(contacts_[i], bodies_);
        if (!work_.points.back().moves()) continue;
        work_.order.push_back(i);
        speed = std::max(speed, length(work_.points.back().velocity(bodies_)));
    }
    threshold_ = std::max(settings_.tolerance, 0x1p-46 * speed);
}

/// Contacts of one pair of bodies side by side; the pairs in the order of their first contact's id.
void ImpactSequence::group()
{
    auto& order = work_.order;
    const auto pair_of = [&](std::uint32_t i) { return std::tie(contacts_[i].a, contacts_[i].b); };
    std::sort(order.begin(), order.end(),
              [&](auto i, auto j)
              { return std::tuple_cat(pair_of(i), std::tie(contacts_[i].id)) < std::tuple_cat(pair_of(j), std::tie(contacts_[j].id)); });
    work_.patches.clear();
    for (std::uint32_t k = 0; k < order.size(); ++k)
    {
        if (k == 0 || pair_of(order[k]) != pair_of(order[k - 1])) work_.patches.push_back({k, k, contacts_[order[k]].id});
        work_.patches.back().end = k + 1;
    }
    std::sort(work_.patches.begin(), work_.patches.end(), [](const Patch& p, const Patch& q) { return p.id < q.id; });
}

double ImpactSequence::closing_speed(const Patch& patch) const
{
    double fastest = -HUGE_VAL;
    for (std::uint32_t k = patch.first; k < patch.end; ++k) fastest = std::max(fastest, closing_speed(work_.order[k]));
    return fastest;
}

/// Whether a contact that parts at `speed` stays: h = v^2 / 2a, and no lower than what its position can tell apart.
bool ImpactSequence::rests(const Contact& contact, double speed) const
{
    if (speed < 0) return false;
    const double pressing = -contact.normal_acceleration;
    if (!(pressing > 0)) return speed <= settings_.rest_speed;
    const double height = std::max(settings_.rest_height, 0x1p-48 * length(contact.point));
    return speed * speed <= 2 * pressing * height;
}

void ImpactSequence::hit(const Patch& patch, bool plastic)
{
    const double closing = closing_speed(patch);
    double restitution = plastic ? 0.0 : 1.0;
    for (std::uint32_t k = patch.first; k < patch.end; ++k)
    {
        const Contact& c = contacts_[work_.order[k]];
        restitution = std::min(restitution, c.restitution);
        if (rests(c, c.restitution * closing)) restitution = 0;
    }
    if (patch.end - patch.first == 1)
        hit_point(work_.order[patch.first], restitution);
    else
        hit_face(patch, restitution);
}

void ImpactSequence::hit_point(std::uint32_t contact, double restitution)
{
    const ContactPoint& point = work_.points[contact];
    const ImpactResult r = solve_impact(point.K(), point.velocity(bodies_), contacts_[contact].friction, restitution);
    point.apply(bodies_, r.impulse, r.velocity.z);
    contacts_[contact].impulse += point.to_world(r.impulse);
}

/// Several points of one pair meet at once, u_n' >= -e u_n at each: a box that lands flat bounces flat. With friction
/// Newton's law may give back more than there was; then less is given back, and nothing at last.
void ImpactSequence::hit_face(const Patch& patch, double restitution)
{
    constexpr int kTrials = 6;
    const Contact& first = contacts_[work_.order[patch.first]];
    const std::array<std::uint32_t, 2> pair{first.a.index, first.b.index};
    std::array<Motions, 2> saved;
    for (std::size_t i = 0; i < 2; ++i)
        saved[i] = {bodies_.velocity[pair[i]], bodies_.angular_velocity[pair[i]], bodies_.angular_momentum[pair[i]]};
    for (int trial = 1; try_face(patch, restitution) > 0 && restitution > 0; ++trial)
    {
        for (std::size_t i = 0; i < 2; ++i)
        {
            bodies_.velocity[pair[i]] = saved[i].velocity;
            bodies_.angular_velocity[pair[i]] = saved[i].spin;
            bodies_.angular_momentum[pair[i]] = saved[i].momentum;
        }
        restitution = trial < kTrials ? 0.5 * restitution : 0.0;
    }
    for (std::uint32_t k = patch.first; k < patch.end; ++k)
    {
        const ConeContact& cone = work_.cones[k - patch.first];
        contacts_[work_.order[k]].impulse += cone.point->to_world(cone.impulse);
    }
}

/// Energy gained beyond rounding, J: the sum of j . (u + u') / 2.
double ImpactSequence::try_face(const Patch& patch, double restitution)
{
    work_.cones.clear();
    work_.before.clear();
    for (std::uint32_t k = patch.first; k < patch.end; ++k)
    {
        const std::uint32_t i = work_.order[k];
        const Vec3 u = work_.points[i].velocity(bodies_);
        work_.before.push_back(u);
        work_.cones.push_back({&work_.points[i], contacts_[i].friction, u.z < 0 ? -restitution * u.z : 0.0, {}});
    }
    solve_cones(work_.cones, bodies_, 0.1 * threshold_, settings_.max_iterations);
    double gain = 0, size = 0;
    for (std::size_t k = 0; k < work_.cones.size(); ++k)
    {
        const ConeContact& c = work_.cones[k];
        const double work = 0.5 * dot(c.impulse, work_.before[k] + c.point->velocity(bodies_));
        gain += work;
        size += length(c.impulse) * length(work_.before[k]);
    }
    return gain > 1e-12 * size ? gain : 0.0;
}

void ImpactSequence::run(Impact& impact)
{
    prepare();
    group();
    const int budget = settings_.max_iterations * static_cast<int>(std::max<std::size_t>(1, work_.patches.size()));
    double fastest = 0;
    for (impact.iterations = 0; impact.iterations < budget; ++impact.iterations)
    {
        const Patch* next = nullptr;
        fastest = threshold_;
        for (const Patch& p : work_.patches)
            if (const double v = closing_speed(p); v > fastest) fastest = v, next = &p;
        if (!next) break;
        // Bodies caught between others may bounce for ever; what is left by then is taken out without bounce.
        hit(*next, impact.iterations > budget / 2);
    }
    impact.residual = 0;
    for (const std::uint32_t i : work_.order)
    {
        const double closing = closing_speed(i);
        impact.residual = std::max(impact.residual, closing);
        contacts_[i].resting = closing <= threshold_ && rests(contacts_[i], std::max(0.0, -closing));
    }
    impact.converged = impact.residual <= threshold_;
}
}  // namespace

void respond_impact(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact)
{
    ImpactSequence(settings, work, bodies, impact).run(impact);
}

}  // namespace plab::response
