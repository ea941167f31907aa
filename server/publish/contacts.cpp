#include "publish/contacts.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace plab::publish
{

using simulation::LoggedContact;

void ContactRecords::list(const simulation::Simulation& s)
{
    const simulation::ContactLog& log = s.stepper().contact_log();
    points_.clear();
    for (const LoggedContact& c : log.entries()) points_.push_back({&c, c.impulse, false});
    const double h = s.stepper().frame().step;
    const auto is_part = [&](const LoggedContact& c) { return c.begin > 0 || c.end < h; };
    if (std::any_of(log.entries().begin(), log.entries().end(), is_part)) add_up_parts(s.world());
    for (const LoggedContact& c : log.sleeping()) points_.push_back({&c, c.impulse, true});
}

/// A step that an event has divided has several entries for a point. The last one tells where it is.
void ContactRecords::add_up_parts(const world::World& world)
{
    const auto key = [&](const Point& p) {
        return std::tuple(world.rank(p.at->detector), world.rank(p.at->a), world.rank(p.at->b), p.at->is_impact, p.at->feature,
                          p.at->begin);
    };
    std::sort(points_.begin(), points_.end(),
              [&](const Point& x, const Point& y) { return key(x) != key(y) ? key(x) < key(y) : x.at < y.at; });
    std::size_t kept = 0;
    for (const Point& p : points_)
    {
        const bool goes_on =
            kept > 0 && is_same_point(*points_[kept - 1].at, *p.at) && !p.at->is_impact && !points_[kept - 1].at->is_impact;
        if (goes_on)
            points_[kept - 1] = {p.at, points_[kept - 1].impulse + p.impulse, false};
        else
            points_[kept++] = p;
    }
    points_.resize(kept);
}

/// Leaves order_ with the points that the record gets, in their order.
void ContactRecords::limit(double h, wire::ContactForces& out)
{
    order_.resize(points_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    out.left_out = 0, out.force_left_out = 0;
    if (points_.size() <= kMostContactPoints) return;
    normal_.clear();
    for (const Point& p : points_) normal_.push_back(dot(p.impulse, p.at->normal));
    const auto middle = order_.begin() + kMostContactPoints;
    std::nth_element(order_.begin(), middle, order_.end(),
                     [&](std::uint32_t x, std::uint32_t y) { return normal_[x] != normal_[y] ? normal_[x] > normal_[y] : x < y; });
    out.left_out = static_cast<std::uint32_t>(order_.end() - middle);
    for (auto i = middle; i != order_.end(); ++i) out.force_left_out += normal_[*i] / h;
    order_.resize(kMostContactPoints);
    std::sort(order_.begin(), order_.end());
}

void ContactRecords::fill(const simulation::Simulation& s, wire::ContactForces& out)
{
    const world::World& world = s.world();
    const double h = s.stepper().frame().step;
    out.run = s.run(), out.step = s.tick(), out.time = s.time(), out.step_length = h;
    list(s);
    limit(h, out);
    // Entries and their points keep their memory.
    std::size_t count = 0;
    const Point* last = nullptr;
    for (const std::uint32_t i : order_)
    {
        const Point& p = points_[i];
        const LoggedContact& c = *p.at;
        if (!last || last->at->detector != c.detector || last->at->a != c.a || last->at->b != c.b || last->asleep != p.asleep)
        {
            if (out.entries.size() == count) out.entries.emplace_back();
            wire::ContactInfo& entry = out.entries[count++];
            entry.detector = world.id_of(c.detector), entry.a = world.id_of(c.a), entry.b = world.id_of(c.b);
            entry.asleep = p.asleep, entry.points.clear();
        }
        last = &p;
        const Vec3 force = p.impulse / h;
        const double normal_force = dot(force, c.normal);
        out.entries[count - 1].points.push_back({c.point, c.normal, c.depth, normal_force, force - c.normal * normal_force, c.is_impact});
    }
    out.entries.resize(count);
}

}  // namespace plab::publish
