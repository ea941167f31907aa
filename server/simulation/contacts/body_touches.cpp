#include "simulation/contacts/body_touches.h"

#include <algorithm>
#include <numeric>

namespace plab::simulation
{

void BodyTouches::rebuild()
{
    const auto asks = [](const Block& block)
    {
        const auto& access = block.command->access;
        return std::any_of(access.begin(), access.end(), [](const Access& a) { return a.table == "Touches"; });
    };
    const auto& blocks = step_.schedule.of(Phase::Finish);
    wanted_ = std::any_of(blocks.begin(), blocks.end(), asks);
}

void BodyTouches::add_pair(Ref a, Ref b, const Vec3& point, const Vec3& normal, const Vec3& impulse, bool persists)
{
    found_.push_back({a.index, {b, point, normal, -impulse, persists, {}}});
    found_.push_back({b.index, {a, point, -normal, impulse, persists, {}}});
}

/// Points at the end of the step, with the impulses of the step where impulses hold them. Springs: with their force at the end of the step.
void BodyTouches::collect_contacts()
{
    std::size_t near = 0;
    for (const FoundContact& f : contacts_.found())
    {
        const Contact& c = f.contact;
        if (contacts_.detectors()[f.detector].by_force)
        {
            const auto& pairs = contacts_.cache().force_pairs();
            const std::uint32_t detector = contacts_.detectors()[f.detector].component;
            const auto pair = std::find_if(pairs.begin(), pairs.end(),
                                           [&](const ForcePair& p) { return p.detector == detector && p.a == c.a && p.b == c.b; });
            if (pair == pairs.end()) continue;
            for (const ForceContact& k : pair->all())
                if (k.feature == c.feature) add_pair(c.a, c.b, c.point, c.normal, step_.frame.step * k.force, true);
            continue;
        }
        const PairState* pair = contacts_.find_pair(f, near);
        if (!pair)
        {
            if (c.depth >= 0) add_pair(c.a, c.b, c.point, c.normal, {}, true);
            continue;
        }
        Vec3 impulse;
        if (pair->resting)
            for (const KnownContact& k : pair->all())
                if (k.feature == c.feature) impulse = k.impulse;
        if (!pair->ahead || !(impulse == Vec3{})) add_pair(c.a, c.b, c.point, c.normal, impulse, !pair->ahead);
    }
}

/// Impacts that the events of the step report. The impulse that is kept for a point does not contain that of its impact
/// (HeldIslands::keep_run), so nothing is counted twice.
void BodyTouches::collect_impacts()
{
    for (const Event& e : step_.events)
    {
        if (!e.contact || (e.kind != "contact.impact" && e.kind != "contact.rest")) continue;
        const auto& detectors = contacts_.detectors();
        const auto detector =
            std::find_if(detectors.begin(), detectors.end(), [&](const Detector& d) { return d.component == e.component; });
        if (detector == detectors.end() || detector->by_force) continue;
        add_pair(e.a, e.b, e.contact->point, e.contact->normal, e.contact->impulse, false);
    }
}

void BodyTouches::sort_by_body()
{
    begin_.assign(step_.world.host().bodies.size() + 1, 0);
    for (const Entry& e : found_) ++begin_[e.body + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    place_.assign(begin_.begin(), begin_.end());
    sorted_.resize(found_.size());
    for (const Entry& e : found_) sorted_[place_[e.body]++] = e.point;
}

void BodyTouches::collect()
{
    found_.clear(), added_.clear();
    collect_contacts();
    collect_impacts();
    sort_by_body();
}

std::span<const TouchPoint> BodyTouches::of(Ref body) const
{
    asked_.clear();
    if (body.facet != Facet::Body || body.index + 1 >= begin_.size()) return {};
    asked_.insert(asked_.end(), sorted_.begin() + begin_[body.index], sorted_.begin() + begin_[body.index + 1]);
    for (const Entry& e : added_)
        if (e.body == body.index) asked_.push_back(e.point);
    return asked_;
}

}  // namespace plab::simulation
