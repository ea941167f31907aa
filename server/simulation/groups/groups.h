/// Solver groups: the objects that forces or couplings connect in this step, which are therefore integrated as one system.
///
/// Fields that act on each body separately connect nothing, and neither do static and prescribed bodies. A role that only reads an object
/// orders two groups without joining them: the forces of the reading group need the state of the other one, but not vice versa.
///
/// The groups are the connected components of a graph: its vertices are the dynamic objects, and an interaction that couples the objects
/// on which it acts connects all of them. They are found by union-find when the structure of the scene changes, not in each step. Contacts
/// come and go, so they are not part of this graph: they join groups to islands within a step (held_islands.h, contact_forces.h). Groups
/// that read one another form a cluster. Its groups have equations of their own but one solver, because a solver evaluates forces at
/// stages inside the step, and a group can read the state of another one there only if that one has a stage at the same time.
#pragma once

#include <string>
#include <vector>

#include "simulation/groups/index_set.h"
#include "simulation/groups/schedule.h"

namespace plab::simulation
{

/// A row of Schedule::of(Phase::Force), Couple or Constrain that acts on a group.
struct BlockRow
{
    std::uint32_t block = 0;
    std::uint32_t rank = 0;  ///< rank of the component, which is the order within the block
    Row row = 0;
    friend auto operator<=>(const BlockRow&, const BlockRow&) = default;
};

struct Group
{
    std::vector<std::uint32_t> bodies;                                ///< dynamic, in id order
    std::vector<std::uint32_t> shafts;                                ///< dynamic, in id order
    std::vector<std::uint32_t> quantities;                            ///< in id order
    std::vector<std::uint32_t> prescribed_bodies, prescribed_shafts;  ///< each has a group of its own
    std::vector<std::uint32_t> upstream;                              ///< groups whose state the forces of this group read, ascending
    std::vector<BlockRow> forces, couplings, rows;
    std::uint32_t solver = kNoIndex;  ///< component; kNoIndex for prescribed motion
    bool mixed_solvers = false;       ///< members named different solvers; the one of the highest order was taken
    std::uint32_t cluster = 0;        ///< groups that are connected by reading; advanced in one batch
};

struct Groups
{
    std::vector<Group> all;
    std::vector<std::uint32_t> group_of_body, group_of_shaft, group_of_quantities;  ///< kNoIndex: static
    std::uint32_t clusters = 0;
    std::vector<std::uint32_t> cluster_begin;         ///< by cluster, and one more: where its groups begin in groups_by_cluster
    std::vector<std::uint32_t> groups_by_cluster;     ///< ascending within a cluster
    std::vector<std::uint8_t> cluster_has_couplings;  ///< by cluster: whether coupling sweeps are needed

    std::span<const std::uint32_t> of_cluster(std::uint32_t cluster) const
    {
        return std::span(groups_by_cluster).subspan(cluster_begin[cluster], cluster_begin[cluster + 1] - cluster_begin[cluster]);
    }

    std::uint32_t of(Ref ref) const
    {
        if (ref.facet == Facet::Body) return group_of_body[ref.index];
        if (ref.facet == Facet::Shaft) return group_of_shaft[ref.index];
        if (ref.facet == Facet::Quantities) return group_of_quantities[ref.index];
        return kNoIndex;
    }
};

/// Replaces `groups` by those of the present structure, in their memory. `part`: objects outside it are in no group; null: all are in.
void build_groups(const world::World& world, const Schedule& schedule, Groups& groups, const Selection* part = nullptr);

/// How the groups of a structure differ from those of the one before.
struct GroupsChange
{
    /// Members, clusters or solvers differ, or ranks do, so that nothing can be said of single groups.
    bool all = true;
    std::vector<std::uint32_t> changed;  ///< otherwise: the groups on which other rows act than before, ascending
};
/// `before` are the groups of the schedule `old`, `now` those of `schedule`. Ranks and rows of objects must be the same in both.
GroupsChange compare_groups(const Groups& before, const Schedule& old, const Groups& now, const Schedule& schedule);

/// Chooses the solver of each group anew, after components that only advance others were exchanged or changed. The result is that of
/// build_groups().
void choose_solvers(const world::World& world, Groups& groups);

/// Disjoint sets (union-find) with the lowest member as representative, so that the result does not depend on the order of joins.
class DisjointSets
{
public:
    explicit DisjointSets(std::size_t n = 0) { reset(n); }
    void reset(std::size_t n);
    std::size_t size() const { return parent_.size(); }
    /// Makes single sets of `members` again; to be called for all members that were joined.
    void separate(std::span<const std::uint32_t> members)
    {
        for (const std::uint32_t i : members) parent_[i] = i;
    }
    std::uint32_t find(std::uint32_t i);
    void join(std::uint32_t a, std::uint32_t b);

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace plab::simulation
