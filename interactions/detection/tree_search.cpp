#include "tree_search.h"

#include <algorithm>

namespace plab::detection
{

TreeSearch::TreeSearch(std::size_t parts)
    : boxes_(parts), memberships_(parts), has_box_(parts, 0), is_moved_(parts, 0), is_stale_(parts, 0), is_asked_(parts, 0)
{
    bounded_.reserve(parts), moved_.reserve(parts), stale_.reserve(parts);
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

/// Searches for all pairs.
void TreeSearch::find_all(std::vector<PartPair>& pairs)
{
    pairs.clear();
    tree_.query_pairs(
        [&](std::uint32_t i, std::uint32_t j)
        {
            if (may_meet(memberships_[i], memberships_[j])) pairs.push_back(std::minmax(i, j));
        });
    for (const HalfSpace& h : half_spaces_)
        for (const std::uint32_t i : bounded_)
            if (may_meet(memberships_[h.part], memberships_[i]) && reaches(h.normal, h.offset, boxes_[i]))
                pairs.push_back(std::minmax(h.part, i));
}

/// Adds the pairs with at least one of `parts`; if both are, the one of lower index reports the pair.
void TreeSearch::find_chosen(std::span<const std::uint32_t> parts, std::span<const std::uint8_t> is_chosen, std::vector<PartPair>& pairs)
{
    for (const HalfSpace& h : half_spaces_)
        for (const std::uint32_t i : is_chosen[h.part] != 0 ? std::span<const std::uint32_t>(bounded_) : parts)
            if (has_box_[i] != 0 && may_meet(memberships_[h.part], memberships_[i]) && reaches(h.normal, h.offset, boxes_[i]))
                pairs.push_back(std::minmax(h.part, i));
    for (const std::uint32_t i : parts)
    {
        if (has_box_[i] == 0) continue;
        tree_.query(boxes_[i],
                    [&](std::uint32_t j)
                    {
                        if (j == i || (is_chosen[j] != 0 && j < i) || !may_meet(memberships_[i], memberships_[j])) return;
                        pairs.push_back(std::minmax(i, j));
                    });
    }
}

/// Enters the boxes that have changed into the tree. If many have, or after as many changes as there are boxes, a rebuilt tree is
/// cheaper and better; returns whether it was rebuilt.
bool TreeSearch::refresh_tree()
{
    moves_since_build_ += stale_.size();
    const bool rebuilds = fresh_ || 4 * stale_.size() > bounded_.size() || moves_since_build_ > bounded_.size();
    if (rebuilds)
    {
        tree_.build(boxes_, bounded_);
        moves_since_build_ = 0;
        fresh_ = false;
    }
    else
        for (const std::uint32_t i : stale_) tree_.move(i, boxes_[i]);
    for (const std::uint32_t i : stale_) is_stale_[i] = 0;
    stale_.clear();
    return rebuilds;
}

void TreeSearch::find(std::vector<PartPair>& pairs)
{
    if (refresh_tree() || 4 * moved_.size() > bounded_.size())
        find_all(pairs);
    else
    {
        std::erase_if(pairs, [&](const PartPair& p) { return is_moved_[p.first] != 0 || is_moved_[p.second] != 0; });
        find_chosen(moved_, is_moved_, pairs);
    }
    for (const std::uint32_t i : moved_) is_moved_[i] = 0;
    moved_.clear();
}

void TreeSearch::find_of(std::span<const std::uint32_t> parts, std::vector<PartPair>& pairs)
{
    refresh_tree();
    pairs.clear();
    if (parts.size() == bounded_.size() + half_spaces_.size()) return find_all(pairs);
    for (const std::uint32_t i : parts) is_asked_[i] = 1;
    find_chosen(parts, is_asked_, pairs);
    for (const std::uint32_t i : parts) is_asked_[i] = 0;
}

}  // namespace plab::detection
