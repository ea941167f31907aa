/// Finds pairs of overlapping boxes with a bounding-box tree; searches again only for boxes that have moved.
#pragma once

#include "box_tree.h"
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
    void find(std::vector<PartPair>& pairs) override;

private:
    struct HalfSpace
    {
        std::uint32_t part = 0;
        Vec3 normal;
        double offset = 0;  // m
    };
    void find_all(std::vector<PartPair>& pairs);
    void find_moved(std::vector<PartPair>& pairs);
    void note_moved(std::uint32_t part);

    BoxTree tree_;
    std::vector<Box> boxes_;               // by part
    std::vector<Membership> memberships_;  // by part
    std::vector<std::uint8_t> has_box_;    // by part
    std::vector<std::uint8_t> is_moved_;   // by part
    std::vector<std::uint32_t> bounded_;   // parts with a box
    std::vector<std::uint32_t> moved_;     // since the last find()
    std::vector<HalfSpace> half_spaces_;
    bool fresh_ = true;  // no tree has been built yet
    std::size_t moves_since_build_ = 0;
};

}  // namespace plab::detection
