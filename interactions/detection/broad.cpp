#include "broad.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace plab::detection
{
namespace
{
/// Fraction by which tight boxes are larger than their shapes, so that rounding loses no touching pair.
constexpr double kMargin = 1e-6;
/// Fraction by which boxes in the search structure are larger still, so that small motions need no new search.
constexpr double kSlack = 0.1;
/// The same, as a fraction of the requested margin.
constexpr double kSlackOfMargin = 2;
/// A box that has become this many times as large as requested is replaced.
constexpr double kMostSlack = 4;
/// Members whose pairs one thread sorts at once.
constexpr std::size_t kMembersPerPart = 512;
/// m: no box extends further than this.
constexpr double kLargest = 1e30;
/// Half extents, along the axes of W, of a box with half extents h rotated by q.
Vec3 turned_half(const Quat& q, const Vec3& h)
{
    const Mat3 R = rotation_matrix(q);
    Vec3 out;
    for (int i = 0; i < 3; ++i) out[i] = std::fabs(R(i, 0)) * h.x + std::fabs(R(i, 1)) * h.y + std::fabs(R(i, 2)) * h.z;
    return out;
}

double largest(const Vec3& v) { return std::max({v.x, v.y, v.z}); }
}  // namespace

void BroadPhase::reset(const std::string& kind, std::size_t parts)
{
    parts_.clear(), member_of_.clear();
    parts_.reserve(parts), member_of_.reserve(parts);
    near_.clear(), half_spaces_.clear();
    raised_ = covered_ = 0, single_ = true;
    search_ = make_pair_search(kind, parts);
    grown_search_ = std::make_unique<TreeSearch>(parts);
    stale_ = true;
}

void BroadPhase::add(const Collider& collider, std::uint32_t member, Membership membership)
{
    const auto index = static_cast<std::uint32_t>(parts_.size());
    Part& part = parts_.emplace_back();
    member_of_.push_back(member);
    single_ = single_ && member == index;
    part.unbounded = collider.kind() == ColliderKind::Plane;
    part.collides = collider.kind() != ColliderKind::None;
    if (!part.collides) return;
    for (PairSearch* search : {search_.get(), static_cast<PairSearch*>(grown_search_.get())})
        if (part.unbounded)
            search->add_half_space(index, membership);
        else
            search->add_box(index, membership);
    if (part.unbounded) half_spaces_.push_back(index);
}

/// Whether the box in the search structure covers the tight box with its margin, and is not far too large for it.
bool BroadPhase::fits(const Part& part) const
{
    const double most = 2 * kMostSlack * (largest(part.tight.upper - part.tight.lower) + 2 * growth_);
    for (int k = 0; k < 3; ++k)
    {
        if (!(part.wide.lower[k] <= part.tight.lower[k] - growth_ && part.tight.upper[k] + growth_ <= part.wide.upper[k])) return false;
        if (part.wide.upper[k] - part.wide.lower[k] > most) return false;
    }
    return true;
}

void BroadPhase::widen(std::uint32_t index)
{
    Part& part = parts_[index];
    const Vec3 half = (part.tight.upper - part.tight.lower) * 0.5, center = (part.tight.upper + part.tight.lower) * 0.5;
    const double slack = kSlack * largest(half) + (1 + kSlackOfMargin) * growth_;
    const Vec3 wide = half + Vec3{slack, slack, slack};
    part.wide = {center - wide, center + wide};
    search_->set_box(index, part.wide);
    stale_ = true;
}

void BroadPhase::widen_if_needed(std::uint32_t index)
{
    if (const Part& part = parts_[index]; part.collides && !part.unbounded && !fits(part)) widen(index);
}

void BroadPhase::move(std::uint32_t index, const Collider& collider, const Pose& X_WS)
{
    Part& part = parts_[index];
    if (!part.collides) return;
    if (part.unbounded)
    {
        const Vec3 n = part.normal = rotate(X_WS.q, {0, 0, 1});
        part.offset = dot(n, X_WS.p);
        part.tilted = true;
        return;
    }
    const bool round = collider.kind() == ColliderKind::Sphere;
    const Vec3 half = (round ? collider.bound_half() : turned_half(X_WS.q, collider.bound_half())) * (1 + kMargin);
    const Vec3 center = X_WS * collider.bound_center();
    part.tight = {center - half, center + half};
}

/// Boxes and half-spaces are each grown by half the margin, with some slack so that small changes of the margin need no new
/// search.
void BroadPhase::raise_half_spaces()
{
    const bool raises = growth_ > raised_ || (growth_ > 0 && raised_ > 4 * kSlackOfMargin * growth_);
    if (raises) raised_ = kSlackOfMargin * growth_;
    for (const std::uint32_t i : half_spaces_)
    {
        if (!raises && !parts_[i].tilted) continue;
        search_->set_half_space(i, parts_[i].normal, parts_[i].offset + raised_);
        parts_[i].tilted = false;
        stale_ = true;
    }
}

bool BroadPhase::near(const Part& a, const Part& b) const
{
    if (a.unbounded || b.unbounded)
    {
        const Part &half_space = a.unbounded ? a : b, &other = a.unbounded ? b : a;
        return reaches(half_space.normal, half_space.offset, other.tight, 2 * growth_);
    }
    const double growth = 2 * growth_;
    for (int k = 0; k < 3; ++k)
        if (a.tight.lower[k] > b.tight.upper[k] + growth || b.tight.lower[k] > a.tight.upper[k] + growth) return false;
    return true;
}

void BroadPhase::search(Workers* workers)
{
    search_->find(near_, workers);
    sort_pairs(workers);
    stale_ = false;
}

/// The order in which a search finds pairs depends on which part moved last; sorting removes that dependence. Parts are numbered by member,
/// so pairs are first distributed by the member of their first part, which leaves short runs to sort.
void BroadPhase::sort_pairs(Workers* workers)
{
    const std::size_t members = member_of_.empty() ? 0 : member_of_.back() + std::size_t{1};
    run_ends_.assign(members + 1, 0);
    for (const Pair& p : near_) ++run_ends_[member_of_[p.first] + std::size_t{1}];
    for (std::size_t m = 1; m <= members; ++m) run_ends_[m] += run_ends_[m - 1];
    sorted_.resize(near_.size());
    for (const Pair& p : near_) sorted_[run_ends_[member_of_[p.first]]++] = p;  // a run's start becomes its end
    const auto before = [&](const Pair& x, const Pair& y)
    { return std::tuple(member_of_[x.second], x.first, x.second) < std::tuple(member_of_[y.second], y.first, y.second); };
    // Where each member has one part, the pairs of a run differ in the second part only.
    const auto second_before = [](const Pair& x, const Pair& y) { return x.second < y.second; };
    const auto sort_runs = [&](std::size_t first, std::size_t end)
    {
        for (std::size_t m = first, begin = m == 0 ? 0 : run_ends_[m - 1]; m < end; begin = run_ends_[m++])
        {
            const auto run = std::span(sorted_).subspan(begin, run_ends_[m] - begin);
            single_ ? std::sort(run.begin(), run.end(), second_before) : std::sort(run.begin(), run.end(), before);
        }
    };
    for_parts(workers, members, kMembersPerPart, sort_runs);
    near_.swap(sorted_);
    near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
}

const std::vector<BroadPhase::Pair>& BroadPhase::find_candidates(double margin, Workers* workers)
{
    growth_ = std::min(0.5 * margin, kLargest);
    for (std::uint32_t i = 0; i < parts_.size(); ++i) widen_if_needed(i);
    covered_ = growth_;
    raise_half_spaces();
    if (stale_) search(workers);
    return near_;
}

const std::vector<BroadPhase::Pair>* BroadPhase::find_candidates_of(std::span<const std::uint32_t> parts, double margin)
{
    growth_ = std::min(0.5 * margin, kLargest);
    if (growth_ > covered_)
    {
        for (std::uint32_t i = 0; i < parts_.size(); ++i) widen_if_needed(i);
        covered_ = growth_;
    }
    else
        for (const std::uint32_t i : parts) widen_if_needed(i);
    raise_half_spaces();
    if (!search_->find_of(parts, near_few_)) return nullptr;
    const auto before = [&](const Pair& x, const Pair& y)
    {
        return std::tuple(member_of_[x.first], member_of_[x.second], x.first, x.second) <
               std::tuple(member_of_[y.first], member_of_[y.second], y.first, y.second);
    };
    std::sort(near_few_.begin(), near_few_.end(), before);
    near_few_.erase(std::unique(near_few_.begin(), near_few_.end()), near_few_.end());
    return &near_few_;
}

const std::vector<BroadPhase::Pair>& BroadPhase::find_pairs(double margin)
{
    pairs_.clear();
    for (const Pair& p : find_candidates(margin, nullptr))
        if (is_near(p)) pairs_.push_back(p);
    return pairs_;
}

void BroadPhase::grow(std::uint32_t part, double margin)
{
    const Part& p = parts_[part];
    if (!p.collides) return;
    const double growth = std::min(margin, kLargest);
    if (p.unbounded) return grown_search_->set_half_space(part, p.normal, p.offset + growth);
    const Vec3 by{growth, growth, growth};
    grown_search_->set_box(part, {p.tight.lower - by, p.tight.upper + by});
}

}  // namespace plab::detection
