/// Finds pairs of overlapping boxes with ODE's collision spaces.
///
/// ODE's hash space is not offered: in version 0.16.2 it misses overlapping pairs.
#pragma once

#include "ode_handles.h"
#include "pair_search.h"

namespace plab::detection
{

class OdeSpace final : public PairSearch
{
public:
    /// `kind`: "simple", "sweep_and_prune" or "quadtree".
    OdeSpace(std::string_view kind, std::size_t parts);

    void add_box(std::uint32_t part, Membership membership) override;
    void add_half_space(std::uint32_t part, Membership membership) override;
    void set_box(std::uint32_t part, const Box& box) override;
    void set_half_space(std::uint32_t part, const Vec3& normal, double offset) override;
    void find(std::vector<PartPair>& pairs, Workers* /*workers*/) override;

private:
    static void note(void* pairs, dxGeom* a, dxGeom* b);
    void adopt(std::uint32_t part, dxGeom* geom, Membership membership);
    void fit_tree();

    SpaceHandle space_;              // declared before the geometries, whose destructors remove them from it
    std::vector<GeomHandle> geoms_;  // by part
    std::vector<Box> boxes_;         // by part; empty for half-spaces
    bool quadtree_ = false;
    Box tree_bounds_;  // of ODE's quadtree
};

}  // namespace plab::detection
