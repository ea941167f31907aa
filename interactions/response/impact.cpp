#include <algorithm>
#include <cmath>
#include <tuple>

#include "impact_law.h"
#include "impulse.h"

namespace plab::response
{
namespace
{
/// Pairs whose closing speeds differ by less than this fraction count as equally fast.
constexpr double kSameSpeed = 1e-9;
/// Fraction of the fastest approach that may remain where bodies are trapped between others.
constexpr double kStill = 1e-6;
/// What a power series of a slip path and a contact of a cone solver cost, in visits of a sweep, by counted instructions.
constexpr std::int64_t kSeriesVisits = 40, kConeVisits = 5;

/// Answers one pair of bodies after the other, the one that closes fastest first, until none closes (Mirtich's sequential collisions).
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
    double closing_speed(const PairManifold& manifold) const;
    void choose(std::uint32_t fastest, double speed);
    bool share_body(const PairManifold& p, const PairManifold& q) const;
    void hit(bool plastic);
    double restitution_of(const PairManifold& manifold, bool plastic) const;
    void hit_point(std::uint32_t contact, double restitution);
    void hit_at_once();
    void choose_all();
    void save_bodies();
    double try_at_once(double share);

    const ImpactSettings& settings_;
    Workspace& work_;
    Bodies& bodies_;
    std::span<Contact> contacts_;
    double threshold_ = 0;     // m/s, a closing speed up to this counts as zero
    std::int64_t spent_ = 0;   // impacts of single points and sweeps of the others
    std::int64_t visits_ = 0;  // contacts visited by them
};

void ImpactSequence::prepare()
{
    for (Contact& c : contacts_) c.impulse = {};
    work_.gather(contacts_, bodies_);
    double speed = 0;
    for (const std::uint32_t i : work_.order) speed = std::max(speed, length(work_.points[i].velocity(bodies_)));
    threshold_ = std::max(settings_.tolerance, 0x1p-46 * speed);
}

/// Sorts contacts by pairs of bodies, and the pairs by their smallest contact id.
void ImpactSequence::group()
{
    auto& order = work_.order;
    const auto pair_of = [&](std::uint32_t i) { return std::tie(contacts_[i].a, contacts_[i].b); };
    std::sort(order.begin(), order.end(),
              [&](auto i, auto j)
              { return std::tuple_cat(pair_of(i), std::tie(contacts_[i].id)) < std::tuple_cat(pair_of(j), std::tie(contacts_[j].id)); });
    work_.manifolds.clear();
    for (std::uint32_t k = 0; k < order.size(); ++k)
    {
        if (k == 0 || pair_of(order[k]) != pair_of(order[k - 1])) work_.manifolds.push_back({k, k, contacts_[order[k]].id});
        work_.manifolds.back().end = k + 1;
    }
    std::sort(work_.manifolds.begin(), work_.manifolds.end(), [](const PairManifold& p, const PairManifold& q) { return p.id < q.id; });
}

double ImpactSequence::closing_speed(const PairManifold& manifold) const
{
    double fastest = -HUGE_VAL;
    for (std::uint32_t k = manifold.first; k < manifold.end; ++k) fastest = std::max(fastest, closing_speed(work_.order[k]));
    return fastest;
}

bool ImpactSequence::share_body(const PairManifold& p, const PairManifold& q) const
{
    const Contact &x = contacts_[work_.order[p.first]], &y = contacts_[work_.order[q.first]];
    const auto same = [&](Ref r, Ref t) { return r == t && bodies_.dynamic(r.index); };
    return same(x.a, y.a) || same(x.a, y.b) || same(x.b, y.a) || same(x.b, y.b);
}

/// Chooses the pair that closes fastest, and those that close equally fast on the same bodies. Answered one after the other,
/// their order would be arbitrary and would break the symmetry of the scene.
void ImpactSequence::choose(std::uint32_t fastest, double speed)
{
    auto& chosen = work_.together;
    chosen.assign(1, fastest);
    if (work_.manifolds.size() == 1) return;
    for (std::size_t k = 0; k < chosen.size(); ++k, visits_ += static_cast<std::int64_t>(work_.manifolds.size()))
        for (std::uint32_t p = 0; p < work_.manifolds.size(); ++p)
        {
            const PairManifold& manifold = work_.manifolds[p];
            if (std::find(chosen.begin(), chosen.end(), p) != chosen.end() || !share_body(work_.manifolds[chosen[k]], manifold)) continue;
            if (closing_speed(manifold) >= (1 - kSameSpeed) * speed) chosen.push_back(p);
        }
    std::sort(chosen.begin(), chosen.end());
}

void ImpactSequence::choose_all()
{
    work_.together.clear();
    for (std::uint32_t p = 0; p < work_.manifolds.size(); ++p) work_.together.push_back(p);
}

double ImpactSequence::restitution_of(const PairManifold& manifold, bool plastic) const
{
    const double closing = closing_speed(manifold);
    double restitution = plastic ? 0.0 : 1.0;
    for (std::uint32_t k = manifold.first; k < manifold.end; ++k)
    {
        const Contact& c = contacts_[work_.order[k]];
        restitution = std::min(restitution, c.restitution);
        if (rests(c, c.restitution * closing, settings_.bounce)) restitution = 0;
    }
    return restitution;
}

void ImpactSequence::hit(bool plastic)
{
    const PairManifold& first = work_.manifolds[work_.together.front()];
    if (work_.together.size() == 1 && first.end - first.first == 1)
        return hit_point(work_.order[first.first], restitution_of(first, plastic));
    work_.hit.clear();
    for (const std::uint32_t p : work_.together)
    {
        const PairManifold& manifold = work_.manifolds[p];
        const double restitution = restitution_of(manifold, plastic);
        for (std::uint32_t k = manifold.first; k < manifold.end; ++k) work_.hit.push_back({work_.order[k], restitution});
    }
    hit_at_once();
}

void ImpactSequence::hit_point(std::uint32_t contact, double restitution)
{
    const ContactPoint& point = work_.points[contact];
    const ImpactResult r = solve_impact(point.K(), point.velocity(bodies_), contacts_[contact].friction, restitution);
    point.apply(bodies_, r.impulse, r.velocity.z);
    contacts_[contact].impulse += point.to_world(r.impulse);
    ++spent_, visits_ += 1 + kSeriesVisits * r.series;
}

void ImpactSequence::save_bodies()
{
    work_.saved.clear();
    for (const HitContact& h : work_.hit)
        for (const Ref r : {contacts_[h.contact].a, contacts_[h.contact].b})
            if (std::none_of(work_.saved.begin(), work_.saved.end(), [&](const HitBody& b) { return b.body == r.index; }))
                work_.saved.push_back(
                    {r.index, bodies_.velocity[r.index], bodies_.angular_velocity[r.index], bodies_.angular_momentum[r.index]});
}

/// Answers several points simultaneously, u_n' >= -e u_n at each: a box that lands flat bounces flat. With friction, Newton's
/// law may return more energy than there was; then less is returned, and finally none.
void ImpactSequence::hit_at_once()
{
    constexpr int kTrials = 6;
    save_bodies();
    const auto gives_back = [](const HitContact& h) { return h.restitution > 0; };
    const bool bounces = std::any_of(work_.hit.begin(), work_.hit.end(), gives_back);
    double share = 1;
    for (int trial = 1; try_at_once(share) > 0 && bounces && share > 0; ++trial)
    {
        for (const HitBody& b : work_.saved)
        {
            bodies_.velocity[b.body] = b.velocity;
            bodies_.angular_velocity[b.body] = b.spin;
            bodies_.angular_momentum[b.body] = b.momentum;
        }
        share = trial < kTrials ? 0.5 * share : 0.0;
    }
    for (std::size_t k = 0; k < work_.hit.size(); ++k)
        contacts_[work_.hit[k].contact].impulse += work_.cones[k].point->to_world(work_.cones[k].impulse);
}

/// Returns the energy gained beyond rounding, J: the sum of j . (u + u') / 2.
double ImpactSequence::try_at_once(double share)
{
    work_.cones.clear();
    work_.before.clear();
    for (const HitContact& h : work_.hit)
    {
        const Vec3 u = work_.points[h.contact].velocity(bodies_);
        work_.before.push_back(u);
        work_.cones.push_back({&work_.points[h.contact], contacts_[h.contact].friction, u.z < 0 ? -share * h.restitution * u.z : 0.0, {}});
    }
    const int sweeps = solve_cones(work_.cones, bodies_, 0.1 * threshold_, settings_.max_iterations, settings_.interruption).sweeps;
    spent_ += sweeps, visits_ += kConeVisits * static_cast<std::int64_t>(work_.cones.size()) * sweeps;
    return energy_gained(work_.cones, work_.before, bodies_);
}

void ImpactSequence::run(Impact& impact)
{
    prepare();
    group();
    const std::int64_t budget = settings_.max_iterations * static_cast<std::int64_t>(std::max<std::size_t>(1, work_.manifolds.size()));
    bool plastic = false;
    double hardest = 0;  // m/s
    for (impact.iterations = 0; spent_ < budget && !(settings_.interruption && settings_.interruption->due()); ++impact.iterations)
    {
        std::uint32_t next = kNoIndex;
        double fastest = threshold_;
        visits_ += static_cast<std::int64_t>(work_.order.size());
        for (std::uint32_t p = 0; p < work_.manifolds.size(); ++p)
            if (const double v = closing_speed(work_.manifolds[p]); v > fastest) fastest = v, next = p;
        if (next == kNoIndex) break;
        // Bodies trapped between others might bounce forever; what remains after half of the budget is answered at once and
        // without bounce.
        hardest = std::max(hardest, fastest);
        plastic = spent_ > budget / 2;
        if (plastic)
            choose_all();
        else
            choose(next, fastest);
        hit(plastic);
    }
    impact.residual = 0;
    // After a plastic impact the contacts rest even if the sweeps have left a little speed: otherwise the impact would recur.
    const double still = plastic ? std::max(threshold_, kStill * hardest) : threshold_;
    for (const std::uint32_t i : work_.order)
    {
        const double closing = closing_speed(i);
        impact.residual = std::max(impact.residual, closing);
        contacts_[i].resting =
            closing <= still && (rests(contacts_[i], std::max(0.0, -closing), settings_.bounce) || (plastic && -closing <= still));
    }
    impact.converged = impact.residual <= threshold_;
    impact.visits = visits_;
}
}  // namespace

void respond_impact(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact)
{
    ImpactSequence(settings, work, bodies, impact).run(impact);
}

}  // namespace plab::response
