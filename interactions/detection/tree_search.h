/// Finds pairs of overlapping boxes with a bounding-box tree; searches again only for boxes that have moved, or are asked for.
#pragma once

#include "geometry/box_tree.h"
#include "pair_search.h"

namespace plab::detection
{

class TreeSearch final : public PairSearch
{
public:
    explicit TreeSearch(std::size_t parts);

    void add_box(std::uint32_t part, Membership membership) override;
    void add_half_space(std::uint32_t part, Membership membership) override;
    void set_box(std::uint32_t part, const Box& box) override;
    void set_half_space(std::uint32_t part, const Vec3& normal, double offset) override;
    void find(std::vector<PartPair>& pairs, Workers* workers) override;
    bool find_of(std::span<const std::uint32_t> parts, std::vector<PartPair>& pairs) override;

private:
    struct HalfSpace
    {
        std::uint32_t part = 0;
        Vec3 normal;
        double offset = 0;  // m
    };
    /// What one thread needs to search a part of the tree.
    struct Searcher
    {
        std::vector<PartPair> pairs;
        std::vector<std::uint32_t> stack;
        std::vector<geometry::BoxTree::NodePair> node_pairs;
    };
    template <class Job>
    void search_in_parts(std::size_t count, std::vector<PartPair>& pairs, Workers* workers, Job&& job);
    void note_moved(std::uint32_t part);
    bool refresh_tree();
    void find_all(std::vector<PartPair>& pairs, Workers* workers);
    void find_chosen(std::span<const std::uint32_t> parts, std::span<const std::uint8_t> is_chosen, std::vector<PartPair>& pairs,
                     Workers* workers);
    void add_of_half_spaces(std::span<const std::uint32_t> parts, std::vector<PartPair>& pairs) const;

    geometry::BoxTree tree_;
    std::vector<Box> boxes_;               // by part
    std::vector<Membership> memberships_;  // by part
    std::vector<std::uint8_t> has_box_;    // by part
    std::vector<std::uint8_t> is_moved_;   // by part: since the last find()
    std::vector<std::uint8_t> is_stale_;   // by part: the tree still has an earlier box
    std::vector<std::uint8_t> is_asked_;   // by part, scratch
    std::vector<std::uint32_t> bounded_;   // parts with a box
    std::vector<std::uint32_t> moved_;     // parts with is_moved_
    std::vector<std::uint32_t> stale_;     // parts with is_stale_
    std::vector<HalfSpace> half_spaces_;
    std::vector<Searcher> searchers_;  // by job; the first serves a search without threads
    bool fresh_ = true;                // no tree has been built yet
    std::size_t moves_since_build_ = 0;
};

}  // namespace plab::detection
