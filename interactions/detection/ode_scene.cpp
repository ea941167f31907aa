#include "ode_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace plab::detection
{
namespace
{
/// Sizes of parts. They do not depend on the number of threads. Contacts of kChunksAtOnce chunks wait to be delivered in order.
constexpr std::size_t kMembersMoved = 512, kPairsPerChunk = 128, kChunksAtOnce = 128;

/// Encodes the shapes of the two bodies and the feature within that pair of shapes. Numbers wrap around for bodies with more
/// than 64 shapes; flush() keeps the features of one pair of bodies distinct even then.
std::uint32_t feature_of(std::uint32_t slot_a, std::uint32_t slot_b, std::uint32_t local)
{
    return ((slot_a & 63u) << 26) | ((slot_b & 63u) << 20) | (local % kFeatures);
}

bool same_shapes(const RefList& now, std::span<const std::uint32_t> built)
{
    return std::equal(now.begin(), now.end(), built.begin(), built.end(), [](const Ref& r, std::uint32_t s) { return r.index == s; });
}

/// The extra cost of a pair with hulls or triangles, as a number of pairs of simple shapes.
double further_pairs_of(const Collider& a, const Collider& b, std::size_t triangles)
{
    constexpr double kVertex = 1.0 / 64;
    const double vertices = kVertex * static_cast<double>(a.hull().vertices.size() + b.hull().vertices.size());
    return vertices + static_cast<double>(triangles) * (1 + vertices);
}

using FeatureOrder = std::array<std::uint8_t, ContactPoints::kCapacity>;

/// The places of contact points in the order of their features, by insertion: mostly there are four of them.
FeatureOrder by_feature(std::span<const ContactPoint> points)
{
    FeatureOrder order;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        std::size_t at = i;
        for (; at > 0 && points[order[at - 1]].feature > points[i].feature; --at) order[at] = order[at - 1];
        order[at] = static_cast<std::uint8_t>(i);
    }
    return order;
}

}  // namespace

bool OdeScene::is_current(const std::string& space, const RefList& between, const RefList& against, const Bodies& bodies,
                          const Shapes& shapes, const ContactSink& order) const
{
    if (space != space_ || between != between_ || against != against_ || member_of_body_.size() != bodies.size()) return false;
    for (std::size_t i = 0; i < members_.size(); ++i)
    {
        const Member& m = members_[i];
        const std::span built(body_shapes_.data() + m.first_shape, m.end_shape - m.first_shape);
        if (bodies.dynamic(m.body) != m.membership.dynamic || !same_shapes(bodies.shapes[m.body], built)) return false;
        if (i > 0 && !against.empty() && !order.precedes({Facet::Body, members_[i - 1].body}, {Facet::Body, m.body})) return false;
    }
    for (std::size_t c = 0; c < colliders_.size(); ++c)
        if (!colliders_[c].built_from(shapes.geometry[shape_of_collider_[c]])) return false;
    return true;
}

bool OdeScene::update(const StepContext& context, const std::string& space, const RefList& between, const RefList& against,
                      const Bodies& bodies, const Shapes& shapes, const ContactSink& order)
{
    if (!context.active_bodies.empty() && !members_.empty())
    {
        // The narrow phase of pairs that are named reads the present poses itself.
        if (order.only_persistent()) return false;
        list_active(context, between, against);
        for (const std::uint32_t m : active_) move_member(members_[m], bodies);
        return false;
    }
    const bool rebuilds = !is_current(space, between, against, bodies, shapes, order);
    if (rebuilds)
    {
        space_ = space, between_ = between, against_ = against;
        rebuild(bodies, shapes, order);
    }
    move_parts(bodies, rebuilds, context.workers);
    return rebuilds;
}

void OdeScene::add_members(const RefList& bodies, bool between, const Bodies& table)
{
    for (const Ref& r : bodies)
    {
        std::uint32_t& index = member_of_body_[r.index];
        if (index != kNoIndex) continue;  // a body in both roles counts as one of `between`
        index = static_cast<std::uint32_t>(members_.size());
        members_.push_back({r.index, {between, table.dynamic(r.index)}, 0, 0, 0, 0, {}, {}});
    }
}

void OdeScene::add_colliders(const Bodies& bodies, const Shapes& shapes)
{
    for (const Member& m : members_)
        for (const Ref& shape : bodies.shapes[m.body])
        {
            // Compounds have a collider too although they do not collide themselves: it serves to detect a change of the
            // compound.
            const std::vector<std::uint32_t>& of_compound = shapes.geometry[shape.index].parts;
            shape_of_collider_.push_back(shape.index);
            shape_of_collider_.insert(shape_of_collider_.end(), of_compound.begin(), of_compound.end());
        }
    std::sort(shape_of_collider_.begin(), shape_of_collider_.end());
    shape_of_collider_.erase(std::unique(shape_of_collider_.begin(), shape_of_collider_.end()), shape_of_collider_.end());
    colliders_.reserve(shape_of_collider_.size());
    for (const std::uint32_t shape : shape_of_collider_) colliders_.emplace_back(shapes.geometry[shape]);
}

void OdeScene::add_part(std::uint32_t member, std::uint32_t own, std::uint32_t shape, const Pose& X_BP)
{
    const auto at = std::lower_bound(shape_of_collider_.begin(), shape_of_collider_.end(), shape);
    const auto collider = static_cast<std::uint32_t>(at - shape_of_collider_.begin());
    const Pose X_BS = X_BP * colliders_[collider].pose();
    parts_.push_back({member, collider, own, X_BS, X_BS.q != Quat{}});
}

void OdeScene::rebuild(const Bodies& bodies, const Shapes& shapes, const ContactSink& order)
{
    members_.clear(), parts_.clear(), body_shapes_.clear(), colliders_.clear(), shape_of_collider_.clear();
    member_of_body_.assign(bodies.size(), kNoIndex);
    add_members(between_, true, bodies);
    add_members(against_, false, bodies);
    std::sort(members_.begin(), members_.end(),
              [&](const Member& a, const Member& b) {
                  return order.precedes({Facet::Body, a.body}, {Facet::Body, b.body});
              });
    add_colliders(bodies, shapes);
    for (std::uint32_t i = 0; i < members_.size(); ++i)
    {
        Member& m = members_[i];
        member_of_body_[m.body] = i;
        m.first_part = static_cast<std::uint32_t>(parts_.size());
        m.first_shape = static_cast<std::uint32_t>(body_shapes_.size());
        for (const Ref& shape : bodies.shapes[m.body])
        {
            const Geometry& geometry = shapes.geometry[shape.index];
            body_shapes_.push_back(shape.index);
            if (geometry.kind != GeometryKind::Compound) add_part(i, shape.index, shape.index, {});
            for (const std::uint32_t part : geometry.parts) add_part(i, shape.index, part, geometry.pose);
        }
        m.end_part = static_cast<std::uint32_t>(parts_.size());
        m.end_shape = static_cast<std::uint32_t>(body_shapes_.size());
    }
    broad_.reset(space_, parts_.size());
    is_searched_ = false;
    near_.reserve(parts_.size());
    if (narrow_.empty()) narrow_.resize(1);
    narrow_.front().found.reserve(ContactPoints::kCapacity * std::min(2 * parts_.size(), kPairsPerChunk));
    for (const Part& part : parts_) broad_.add(colliders_[part.collider], part.member, members_[part.member].membership);
}

void OdeScene::move_member(Member& m, const Bodies& bodies)
{
    m.position = bodies.position[m.body], m.orientation = bodies.orientation[m.body];
    const Pose X_WB = bodies.pose(m.body);
    for (std::uint32_t p = m.first_part; p < m.end_part; ++p)
    {
        const Collider& c = colliders_[parts_[p].collider];
        broad_.move(p, c, X_WB * c.pose());
    }
}

void OdeScene::move_parts(const Bodies& bodies, bool all, Workers* workers)
{
    // Poses are compared, since not only the solver moves bodies: requests and rewinds do so as well.
    const auto move_some = [&](std::size_t begin, std::size_t end)
    {
        for (std::size_t i = begin; i < end; ++i)
            if (Member& m = members_[i]; all || m.position != bodies.position[m.body] || m.orientation != bodies.orientation[m.body])
                move_member(m, bodies);
    };
    for_parts(workers, members_.size(), kMembersMoved, move_some);
}

/// The host may name the active participants, so that an impact of two bodies costs no pass over all of them.
void OdeScene::list_active(const StepContext& context, const RefList& between, const RefList& against)
{
    active_.clear();
    for (const RefList* list : {&between, &against})
        for (const Ref& r : context.among(*list))
            if (const std::uint32_t m = member_of_body_[r.index]; m != kNoIndex && context.active_bodies[r.index] != 0)
                active_.push_back(m);
}

bool OdeScene::may_meet(const Member& a, const Member& b, const StepContext& context) const
{
    if (a.body == b.body || !(a.membership.dynamic || b.membership.dynamic)) return false;
    if (!(a.membership.between || b.membership.between) || filter_->excludes_bodies(a.body, b.body)) return false;
    return context.active({Facet::Body, a.body}) || context.active({Facet::Body, b.body});
}

/// Of members that may meet.
bool OdeScene::is_excluded(const Part& a, const Part& b, const CollisionFilter& filter) const
{
    return filter.has_shapes() && filter.excludes_shapes(members_[a.member].body, a.shape, members_[b.member].body, b.shape);
}

void OdeScene::collect_persistent(const StepContext& context, const ContactSink& sink)
{
    persistent_.clear();
    for (const PersistentPair& pair : sink.persistent())
    {
        if (pair.a.index >= member_of_body_.size() || pair.b.index >= member_of_body_.size()) continue;
        PersistentQuery s{member_of_body_[pair.a.index], member_of_body_[pair.b.index], pair.shift};
        if (s.a == kNoIndex || s.b == kNoIndex || !may_meet(members_[s.a], members_[s.b], context)) continue;
        if (s.a > s.b) std::swap(s.a, s.b), s.shift = -s.shift;
        persistent_.push_back(s);
    }
    const auto key = [](const PersistentQuery& s) { return std::tie(s.a, s.b); };
    std::sort(persistent_.begin(), persistent_.end(), [&](const PersistentQuery& x, const PersistentQuery& y) { return key(x) < key(y); });
}

bool OdeScene::is_persistent(std::uint32_t a, std::uint32_t b) const
{
    const auto before = [](const PersistentQuery& s, const BroadPhase::Pair& p)
    { return std::tie(s.a, s.b) < std::tie(p.first, p.second); };
    const auto at = std::lower_bound(persistent_.begin(), persistent_.end(), BroadPhase::Pair{a, b}, before);
    return at != persistent_.end() && at->a == a && at->b == b;
}

Pose OdeScene::place(const Part& part, const Vec3& p_OC, const Bodies& bodies) const
{
    const std::uint32_t body = members_[part.member].body;
    const Quat& q = bodies.orientation[body];
    const Vec3 p_CS = part.in_body.p - bodies.center_B[body];
    return {p_CS == Vec3{} ? p_OC : p_OC + rotate(q, p_CS), part.turned ? q * part.in_body.q : q};
}

void OdeScene::query(std::uint32_t part_a, std::uint32_t part_b, const Vec3& shift, const Bodies& bodies, Narrow& narrow) const
{
    const Part &pa = parts_[part_a], &pb = parts_[part_b];
    if (is_excluded(pa, pb, *filter_)) return;
    const Member &ma = members_[pa.member], &mb = members_[pb.member];
    const Collider &ca = colliders_[pa.collider], &cb = colliders_[pb.collider];
    // All poses are relative to the centre of mass of a, so that two bodies far from the origin of W lose no digits between
    // them.
    const Vec3 origin = bodies.position[ma.body];
    const Pose X_a = place(pa, {}, bodies);
    const Pose X_b = place(pb, (bodies.position[mb.body] - origin) + shift, bodies);
    ContactPoints& contact_points = narrow.contact_points;
    // Of bodies with several parts some contacts may turn out to be none.
    const bool of_parts = ma.end_part - ma.first_part > 1 || mb.end_part - mb.first_part > 1;
    contact_points.clear(of_parts ? std::max(margin_, seam_margin(ca, cb)) : margin_);
    contact_points.set_level_rims(level_rims_);
    collide(ca, X_a, cb, X_b, contact_points);
    narrow.further_pairs += further_pairs_of(ca, cb, contact_points.triangles()) + (narrow.parts_met++ > 0 ? 1.0 : 0.0);
    const std::span<const ContactPoint> all = contact_points.all();
    const FeatureOrder order = by_feature(all);
    for (std::size_t k = 0; k < all.size(); ++k)
    {
        const ContactPoint& contact_point = all[order[k]];
        ContactPoint& at = narrow.found.emplace_back(MemberContact{pa.member, pb.member, contact_point}).at;
        at.point += origin;
        at.feature = feature_of(part_a - ma.first_part, part_b - mb.first_part, contact_point.feature);
    }
    if (all.empty() || !of_parts) return;
    const ContactPoint& deepest = *std::ranges::max_element(all, {}, &ContactPoint::depth);
    const std::size_t end = narrow.found.size();
    narrow.part_contacts.push_back(
        {&ca, &cb, X_a, {X_b.p - shift, X_b.q}, end - all.size(), end, deepest.normal, deepest.depth - length(shift)});
}

/// After the last query for a pair of members: sorts its contacts and keeps their features distinct.
void OdeScene::finish_pair(double shift, Narrow& narrow) const
{
    drop_seams(narrow.part_contacts, narrow.found, narrow.first, margin_);
    const auto key = [](const MemberContact& t) { return std::tie(t.at.feature, t.at.point.x, t.at.point.y, t.at.point.z); };
    const auto before = [&](const MemberContact& s, const MemberContact& t) { return key(s) < key(t); };
    const auto own = std::span(narrow.found).subspan(narrow.first);
    if (!std::is_sorted(own.begin(), own.end(), before)) std::sort(own.begin(), own.end(), before);
    std::uint32_t next = 0;
    for (MemberContact& c : own)
    {
        c.at.feature = std::max(c.at.feature, next);
        c.at.depth -= shift;
        next = c.at.feature + 1;
        narrow.penetration = std::max(narrow.penetration, c.at.depth);
    }
    narrow.first = narrow.found.size();
    narrow.parts_met = 0;
}

void OdeScene::deliver(const Narrow& narrow, ContactSink& sink)
{
    Contact c;
    for (const MemberContact& found : narrow.found)
    {
        c.a = {Facet::Body, members_[found.a].body}, c.b = {Facet::Body, members_[found.b].body};
        c.feature = found.at.feature, c.point = found.at.point, c.normal = found.at.normal, c.depth = found.at.depth;
        c.pivot = found.at.pivot;
        sink.add(c);
    }
    pairs_ += narrow.pairs;
    further_pairs_ += narrow.further_pairs;  // multiples of 1/64: exact in any order
    penetration_ = std::max(penetration_, narrow.penetration);
}

void OdeScene::measure(GapQuery& query, const Bodies& bodies, const CollisionFilter& filter) const
{
    query.gap = HUGE_VAL;
    const auto member_of = [&](Ref r) { return r.index < member_of_body_.size() ? member_of_body_[r.index] : kNoIndex; };
    const std::uint32_t ia = member_of(query.a), ib = member_of(query.b);
    if (ia == kNoIndex || ib == kNoIndex || filter.excludes_bodies(query.a.index, query.b.index)) return;
    const Member &a = members_[ia], &b = members_[ib];
    const Vec3 origin = bodies.position[a.body], p_OC = bodies.position[b.body] - origin;
    std::size_t parts_met = 0;
    for (std::uint32_t p = a.first_part; p < a.end_part; ++p)
        for (std::uint32_t q = b.first_part; q < b.end_part; ++q)
        {
            const Collider &ca = colliders_[parts_[p].collider], &cb = colliders_[parts_[q].collider];
            if (!meets(ca.kind(), cb.kind()) || is_excluded(parts_[p], parts_[q], filter)) continue;
            const Separation s = separation(ca, place(parts_[p], {}, bodies), cb, place(parts_[q], p_OC, bodies));
            query.further_pairs += further_pairs_of(ca, cb, s.triangles) + (parts_met++ > 0 ? 1.0 : 0.0);
            if (!(s.gap < query.gap)) continue;
            query.gap = s.gap, query.normal = s.normal;
            query.point_a = origin + s.point_a, query.point_b = origin + s.point_b;
        }
}

void OdeScene::report_near(const StepContext& context, ContactSink& sink)
{
    const std::span<const double> motion_margin = sink.motion_margin();
    const bool all = context.active_bodies.empty();
    asked_.clear();
    const auto ask = [&](const Member& m)
    {
        for (std::uint32_t p = m.first_part; p < m.end_part; ++p) broad_.grow(p, motion_margin[m.body]), asked_.push_back(p);
    };
    if (all)
        for (const Member& m : members_) ask(m);
    else
        for (const std::uint32_t m : active_) ask(members_[m]);
    broad_.find_grown(asked_, near_);
    if (filter_->has_shapes())
        std::erase_if(near_, [&](const BroadPhase::Pair& p) { return is_excluded(parts_[p.first], parts_[p.second], *filter_); });
    for (BroadPhase::Pair& pair : near_) pair = {parts_[pair.first].member, parts_[pair.second].member};
    // Pairs of bodies with several parts may occur several times.
    std::sort(near_.begin(), near_.end());
    near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
    for (const auto& [i, j] : near_)
        if (may_meet(members_[i], members_[j], context)) sink.near({Facet::Body, members_[i].body}, {Facet::Body, members_[j].body});
}

void OdeScene::detect(const StepContext& context, const Bodies& bodies, const CollisionFilter& filter, ContactSink& sink)
{
    filter_ = &filter;
    if (!sink.motion_margin().empty()) return report_near(context, sink);
    penetration_ = 0, further_pairs_ = 0;
    margin_ = sink.margin(), level_rims_ = sink.level_rims();
    if (narrow_.empty()) narrow_.resize(1);
    collect_persistent(context, sink);
    query_persistent(bodies, sink);
    if (!sink.only_persistent()) query_near(context, bodies, sink);
    sink.took(further_pairs_);
}

void OdeScene::query_persistent(const Bodies& bodies, ContactSink& sink)
{
    Narrow& narrow = narrow_.front();
    narrow.clear();
    for (std::size_t i = 0; i < persistent_.size(); ++i)
    {
        const PersistentQuery& s = persistent_[i];
        if (i > 0 && s.a == persistent_[i - 1].a && s.b == persistent_[i - 1].b) continue;
        const Member &a = members_[s.a], &b = members_[s.b];
        for (std::uint32_t p = a.first_part; p < a.end_part; ++p)
            for (std::uint32_t q = b.first_part; q < b.end_part; ++q) query(p, q, s.shift, bodies, narrow);
        finish_pair(length(s.shift), narrow);
    }
    deliver(narrow, sink);
}

/// The narrow phase of the candidates of one chunk. A pair of members belongs to the chunk in which its first candidate lies.
void OdeScene::query_chunk(std::size_t chunk, const StepContext& context, const Bodies& bodies, Narrow& narrow) const
{
    narrow.clear();
    const auto goes_on = [&](std::size_t i)  // the pair of members of the candidate before
    { return i > 0 && i < candidates_.size() && members_of(candidates_[i]) == members_of(candidates_[i - 1]); };
    std::size_t i = chunk * kPairsPerChunk, end = std::min(i + kPairsPerChunk, candidates_.size());
    while (goes_on(i)) ++i;
    while (goes_on(end)) ++end;
    for (; i < end; ++i)
    {
        if (broad_.is_near(candidates_[i]))
        {
            ++narrow.pairs;
            const auto [a, b] = members_of(candidates_[i]);
            if (may_meet(members_[a], members_[b], context) && !is_persistent(a, b))
                query(candidates_[i].first, candidates_[i].second, {}, bodies, narrow);
        }
        if (!goes_on(i + 1)) finish_pair(0, narrow);
    }
}

/// Where few bodies are active, only their pairs are searched for.
std::span<const BroadPhase::Pair> OdeScene::candidates(const StepContext& context)
{
    if (!context.active_bodies.empty() && !context.shortlists.empty() && is_searched_)
    {
        asked_.clear();
        for (const std::uint32_t m : active_)
            for (std::uint32_t p = members_[m].first_part; p < members_[m].end_part; ++p) asked_.push_back(p);
        std::sort(asked_.begin(), asked_.end());
        asked_.erase(std::unique(asked_.begin(), asked_.end()), asked_.end());
        if (const auto* some = broad_.find_candidates_of(asked_, margin_)) return *some;
    }
    is_searched_ = true;
    return broad_.find_candidates(margin_, context.workers);
}

void OdeScene::query_near(const StepContext& context, const Bodies& bodies, ContactSink& sink)
{
    candidates_ = candidates(context);
    pairs_ = 0;
    const std::size_t chunks = (candidates_.size() + kPairsPerChunk - 1) / kPairsPerChunk;
    const bool alone = !context.workers || context.workers->threads() < 2;
    const std::size_t at_once = alone ? 1 : std::min(chunks, kChunksAtOnce);
    if (narrow_.size() < at_once) narrow_.resize(at_once);
    for (std::size_t first = 0; first < chunks; first += at_once)
    {
        const std::size_t count = std::min(at_once, chunks - first);
        for_parts(context.workers, count, 1, [&](std::size_t k, std::size_t) { query_chunk(first + k, context, bodies, narrow_[k]); });
        for (std::size_t k = 0; k < count; ++k) deliver(narrow_[k], sink);
    }
}

}  // namespace plab::detection
