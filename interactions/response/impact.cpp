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
constexpr double kSameSpeed = 1e-6;
/// Fraction of the fastest approach that may remain where bodies are trapped between others.
constexpr double kStill = 1e-6;
/// Links of a mechanism that are pressed against one another pass an impact on for ever: each acts on all of their contacts.
constexpr int kMostOfJoined = 60;
/// What a power series of a slip path and a contact of a cone solver cost, in visits of a sweep, by counted instructions.
constexpr std::int64_t kSeriesVisits = 40, kConeVisits = 5;

/// Answers one pair of bodies after the other, the one that closes fastest first, until none closes (Mirtich's sequential collisions).
class ImpactSequence
{
public:
    ImpactSequence(const ImpactSettings& settings, Workspace& work, Bodies& bodies, Impact& impact)
        : settings_(settings), work_(work), velocities_(work.velocities), bodies_(bodies), contacts_(impact.contacts)
    {
    }
    void run(Impact& impact);

private:
    void prepare(const Impact& impact);
    void group();
    double closing_speed(std::uint32_t contact) const { return -velocities_.at(contact).z; }
    double closing_speed(const PairManifold& manifold) const;
    void choose(std::uint32_t fastest, double speed);
    bool share_body(const PairManifold& p, const PairManifold& q) const;
    void hit(bool plastic);
    double restitution_of(const PairManifold& manifold, bool plastic) const;
    void hit_point(std::uint32_t contact, double restitution);
    void hit_at_once();
    void choose_all();
    bool try_at_once(double share);
    void count(int sweeps);

    const ImpactSettings& settings_;
    Workspace& work_;
    ContactVelocities& velocities_;
    Bodies& bodies_;
    std::span<Contact> contacts_;
    double threshold_ = 0;     // m/s, a closing speed up to this counts as zero
    std::int64_t spent_ = 0;   // impacts of single points and sweeps of the others
    std::int64_t visits_ = 0;  // contacts visited by them
};

void ImpactSequence::prepare(const Impact& impact)
{
    for (Contact& c : contacts_) c.impulse = {};
    work_.gather(impact, bodies_);
    double speed = 0;
    for (const std::uint32_t i : work_.order) speed = std::max(speed, length(velocities_.at(i)));
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
    if (velocities_.are_joined()) return true;
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
    work_.hit.clear(), work_.restitution.clear();
    for (const std::uint32_t p : work_.together)
    {
        const PairManifold& manifold = work_.manifolds[p];
        const double restitution = restitution_of(manifold, plastic);
        for (std::uint32_t k = manifold.first; k < manifold.end; ++k)
            work_.hit.push_back(work_.order[k]), work_.restitution.push_back(restitution);
    }
    hit_at_once();
}

void ImpactSequence::hit_point(std::uint32_t contact, double restitution)
{
    const ImpactResult r = solve_impact(velocities_.K(contact), velocities_.at(contact), contacts_[contact].friction, restitution);
    velocities_.apply(contact, r.impulse, r.velocity.z);
    contacts_[contact].impulse += velocities_.to_world(contact, r.impulse);
    ++spent_, visits_ += 1 + kSeriesVisits * r.series;
}

/// Answers several points simultaneously, u_n' >= -e u_n at each: a box that lands flat bounces flat. With friction, Newton's
/// law may return more energy than there was; then less is returned, finally none, and at last friction acts less.
void ImpactSequence::hit_at_once()
{
    constexpr int kTrials = 6;
    velocities_.keep(work_.hit);
    const bool bounces = std::ranges::any_of(work_.restitution, [](double e) { return e > 0; });
    double share = bounces ? 1 : 0;
    bool gains = try_at_once(share);
    for (int trial = 1; gains && share > 0; ++trial)
    {
        velocities_.put_back();
        share = trial < kTrials ? 0.5 * share : 0.0;
        gains = try_at_once(share);
    }
    if (gains)
        count(reduce_friction(work_.cones, work_.before, velocities_, 0.1 * threshold_, settings_.max_iterations, settings_.interruption)
                  .sweeps);
    for (const ConeContact& c : work_.cones) contacts_[c.contact].impulse += velocities_.to_world(c.contact, c.impulse);
}

void ImpactSequence::count(int sweeps)
{
    spent_ += sweeps, visits_ += kConeVisits * static_cast<std::int64_t>(work_.cones.size()) * sweeps;
}

/// Returns whether energy is gained beyond rounding.
bool ImpactSequence::try_at_once(double share)
{
    work_.cones.clear();
    work_.before.clear();
    for (std::size_t k = 0; k < work_.hit.size(); ++k)
    {
        const std::uint32_t i = work_.hit[k];
        const Vec3 u = velocities_.at(i);
        work_.before.push_back(u);
        work_.cones.push_back({i, contacts_[i].friction, u.z < 0 ? -share * work_.restitution[k] * u.z : 0.0, {}});
    }
    count(solve_cones(work_.cones, velocities_, 0.1 * threshold_, settings_.max_iterations, settings_.interruption).sweeps);
    return energy_gained(work_.cones, work_.before, velocities_) > 0;
}

void ImpactSequence::run(Impact& impact)
{
    prepare(impact);
    group();
    const int most = velocities_.are_joined() ? std::min(kMostOfJoined, settings_.max_iterations) : settings_.max_iterations;
    const std::int64_t budget = most * static_cast<std::int64_t>(std::max<std::size_t>(1, work_.manifolds.size()));
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
