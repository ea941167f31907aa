#include "tree_search.h"

#include <algorithm>

namespace plab::detection
{
namespace
{
/// Sizes of the jobs into which a search is divided. They do not depend on the number of threads.
constexpr std::size_t kTreeParts = 64, kBoxesPerJob = 128;
/// Room for nodes still to visit, so that a search in a warm step allocates nothing.
constexpr std::size_t kStack = 256;
}  // namespace

TreeSearch::TreeSearch(std::size_t parts)
    : boxes_(parts), memberships_(parts), has_box_(parts, 0), is_moved_(parts, 0), is_stale_(parts, 0), is_asked_(parts, 0)
{
    bounded_.reserve(parts), moved_.reserve(parts), stale_.reserve(parts);
    searchers_.resize(1);
    searchers_.front().stack.reserve(kStack), searchers_.front().node_pairs.reserve(kStack);
}

void TreeSearch::add_box(std::uint32_t part, Membership membership)
{
    memberships_[part] = membership;
    has_box_[part] = 1;
    bounded_.push_back(part);
}

void TreeSearch::add_half_space(std::uint32_t part, Membership membership)
{
    memberships_[part] = membership;
    half_spaces_.push_back({part, {0, 0, 1}, 0});
}

void TreeSearch::note_moved(std::uint32_t part)
{
    if (is_moved_[part] == 0) moved_.push_back(part);
    is_moved_[part] = 1;
    if (has_box_[part] == 0) return;
    if (is_stale_[part] == 0) stale_.push_back(part);
    is_stale_[part] = 1;
}

void TreeSearch::set_box(std::uint32_t part, const Box& box)
{
    boxes_[part] = box;
    note_moved(part);
}

void TreeSearch::set_half_space(std::uint32_t part, const Vec3& normal, double offset)
{
    for (HalfSpace& h : half_spaces_)
        if (h.part == part) h.normal = normal, h.offset = offset;
    note_moved(part);
}

/// Runs job(i, searcher) for each i < count, and adds the pairs that they find in the order of jobs.
template <class Job>
void TreeSearch::search_in_parts(std::size_t count, std::vector<PartPair>& pairs, Workers* workers, Job&& job)
{
    const bool alone = !workers || workers->threads() < 2 || count < 2;
    if (searchers_.size() < (alone ? 1 : count)) searchers_.resize(alone ? 1 : count);
    if (alone)
    {
        searchers_.front().pairs.swap(pairs);
        for (std::size_t i = 0; i < count; ++i) job(i, searchers_.front());
        searchers_.front().pairs.swap(pairs);
        return;
    }
    workers->run(count,
                 [&](std::size_t i)
                 {
                     searchers_[i].pairs.clear();
                     job(i, searchers_[i]);
                 });
    for (std::size_t i = 0; i < count; ++i) pairs.insert(pairs.end(), searchers_[i].pairs.begin(), searchers_[i].pairs.end());
}

void TreeSearch::add_of_half_spaces(std::span<const std::uint32_t> parts, std::vector<PartPair>& pairs) const
{
    for (const HalfSpace& h : half_spaces_)
        for (const std::uint32_t i : parts)
            if (may_meet(memberships_[h.part], memberships_[i]) && reaches(h.normal, h.offset, boxes_[i]))
                pairs.push_back(std::minmax(h.part, i));
}

/// Searches for all pairs.
void TreeSearch::find_all(std::vector<PartPair>& pairs, Workers* workers)
{
    pairs.clear();
    const auto tree_parts = tree_.divide_pairs(kTreeParts);
    search_in_parts(tree_parts.size(), pairs, workers,
                    [&](std::size_t k, Searcher& s)
                    {
                        tree_.query_pairs(tree_parts[k], s.node_pairs,
                                          [&](std::uint32_t i, std::uint32_t j)
                                          {
                                              if (may_meet(memberships_[i], memberships_[j])) s.pairs.push_back(std::minmax(i, j));
                                          });
                    });
    add_of_half_spaces(bounded_, pairs);
}

/// Adds the pairs with at least one of `parts`; if both are, the one of lower index reports the pair.
void TreeSearch::find_chosen(std::span<const std::uint32_t> parts, std::span<const std::uint8_t> is_chosen, std::vector<PartPair>& pairs,
                             Workers* workers)
{
    for (const HalfSpace& h : half_spaces_)
        for (const std::uint32_t i : is_chosen[h.part] != 0 ? std::span<const std::uint32_t>(bounded_) : parts)
            if (has_box_[i] != 0 && may_meet(memberships_[h.part], memberships_[i]) && reaches(h.normal, h.offset, boxes_[i]))
                pairs.push_back(std::minmax(h.part, i));
    const auto search_for = [&](std::uint32_t i, Searcher& s)
    {
        if (has_box_[i] == 0) return;
        tree_.query(boxes_[i], s.stack,
                    [&](std::uint32_t j)
                    {
                        if (j == i || (is_chosen[j] != 0 && j < i) || !may_meet(memberships_[i], memberships_[j])) return;
                        s.pairs.push_back(std::minmax(i, j));
                    });
    };
    search_in_parts((parts.size() + kBoxesPerJob - 1) / kBoxesPerJob, pairs, workers,
                    [&](std::size_t k, Searcher& s)
                    {
                        const std::size_t first = k * kBoxesPerJob;
                        for (const std::uint32_t i : parts.subspan(first, std::min(kBoxesPerJob, parts.size() - first))) search_for(i, s);
                    });
}

/// Enters the boxes that have changed into the tree; returns whether many have. Single boxes are reinserted, many are fitted where they
/// are. After as many insertions as there are boxes, or if the tree has become worse, a rebuilt tree is cheaper.
bool TreeSearch::refresh_tree()
{
    constexpr std::size_t kRefitsPerMove = 32;  // so many fitted boxes do the harm of one reinsertion
    const bool many = fresh_ || 4 * stale_.size() > bounded_.size();
    moves_since_build_ += many ? stale_.size() / kRefitsPerMove : stale_.size();
    bool rebuilds = fresh_ || moves_since_build_ > bounded_.size();
    if (!rebuilds && many) rebuilds = !tree_.refit(boxes_, stale_);
    if (rebuilds)
    {
        tree_.build(boxes_, bounded_);
        moves_since_build_ = 0;
        fresh_ = false;
    }
    else if (!many)
        for (const std::uint32_t i : stale_) tree_.move(i, boxes_[i]);
    for (const std::uint32_t i : stale_) is_stale_[i] = 0;
    stale_.clear();
    return rebuilds || many;
}

void TreeSearch::find(std::vector<PartPair>& pairs, Workers* workers)
{
    if (refresh_tree() || 4 * moved_.size() > bounded_.size())
        find_all(pairs, workers);
    else
    {
        std::erase_if(pairs, [&](const PartPair& p) { return is_moved_[p.first] != 0 || is_moved_[p.second] != 0; });
        find_chosen(moved_, is_moved_, pairs, workers);
    }
    for (const std::uint32_t i : moved_) is_moved_[i] = 0;
    moved_.clear();
}

bool TreeSearch::find_of(std::span<const std::uint32_t> parts, std::vector<PartPair>& pairs)
{
    refresh_tree();
    pairs.clear();
    if (parts.size() == bounded_.size() + half_spaces_.size()) return find_all(pairs, nullptr), true;
    for (const std::uint32_t i : parts) is_asked_[i] = 1;
    find_chosen(parts, is_asked_, pairs, nullptr);
    for (const std::uint32_t i : parts) is_asked_[i] = 0;
    return true;
}

}  // namespace plab::detection
