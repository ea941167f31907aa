/// The constraint graph of all shafts, in reduced coordinates: each connected component (a train of shafts, for example meshing gears)
/// has one degree of freedom, the motion of its root. With rho_i the ratio of shaft i to the root:
///
///   speed_i = rho_i speed_root,   angle_i = anchor_i + rho_i (angle_root - root_anchor_i)     derived, so there is no drift
///   J_root  = sum rho_i^2 J_i,    tau_root = sum rho_i tau_i,    alpha_root = tau_root / J_root
///
/// The couplings are edges of a graph between shafts. A spanning forest (ratio_forest.h) assigns each shaft to a tree and multiplies the
/// ratios along the path from the root, exactly while that is possible (exact_ratio.h). An edge that is not in the forest closes a loop:
/// if the product around the loop is 1 the coupling is redundant, otherwise the scene is refused. Solvers integrate the roots only, and
/// the other shafts follow from them. The torque in a coupling is recovered afterwards from the sums of inertia and torque on both of its
/// sides (shaft_reactions.h). Couplings that are solved pair by pair, without this graph, are in shaft_coupling.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plab/ref.h"
#include "plab/result.h"
#include "plab/shafts.h"
#include "plab/tables.h"
#include "simulation/shafts/drive_order.h"
#include "simulation/shafts/ratio_forest.h"

namespace plab::simulation
{

/// A train of shafts that move together. Its nodes are first .. first + count - 1: the root first, parents before children.
struct ShaftTree
{
    std::uint32_t root = 0;  ///< shaft: the prescribed one, else the first in the order of component ids
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t redundant = 0;  ///< couplings in it that follow from the others
    bool prescribed = false;      ///< its root is prescribed or static, so forces cannot move the train
    double inertia = 0;           ///< of its dynamic members, reduced to the root, kg m^2
};

struct ShaftNode
{
    std::uint32_t shaft = 0;
    std::uint32_t parent = 0;            ///< index of the parent node; a root is its own parent
    std::uint32_t component = kNoIndex;  ///< that couples it to its parent
    bool drives_parent = false;          ///< this shaft, not its parent, is the coupling's driver
    bool dynamic = true;
    double ratio = 1;            ///< turns per turn of the root
    double inertia = 0;          ///< reduced to the root: ratio^2 J; 0 unless dynamic
    double inertia_inside = 0;   ///< sum over this node and its subtree
    double inertia_outside = 0;  ///< sum over all other nodes of the tree
};

/// For each node of a tree, the sum over its subtree and the sum over all other nodes. Both are accumulated directly rather than as total
/// minus part, so no digits cancel and coupling torques stay accurate at any ratio.
struct SideSums
{
    std::vector<double> inside, outside, passed;
    void resize(std::size_t nodes) { inside.resize(nodes), outside.resize(nodes), passed.resize(nodes); }
};

class ConstraintGraph final : public RatioGraph
{
public:
    // Phase::Connect -------------------------------------------------------------------------------------------------
    /// Removes the couplings that were added. The graph built from earlier ones stays valid until the next build() succeeds.
    void clear();
    void add(std::uint32_t component, Ref driver, Ref driven, const Ratio& ratio) override;
    /// A one-way drive (it reads the driver and prescribes the driven shaft). It joins no shafts, but drives must not form a cycle.
    void drive(std::uint32_t component, Ref driver, Ref driven);
    /// Builds the graph from the couplings that were added, and writes root, ratio and anchors of all shafts. To be called again after
    /// any change of couplings, of inertia or motion type of shafts, or when an angle was set. Where root and ratio are unchanged and the
    /// angle still follows from them, the anchors keep every bit. On error nothing has changed.
    Result<void> build(Shafts& shafts, const ShaftDirectory& directory);

    // The step -------------------------------------------------------------------------------------------------------
    /// Whether all speeds equal ratio times root speed to the last bit.
    bool consistent(const Shafts& shafts) const;
    /// Makes inconsistent speeds consistent, as a plastic impact would: w_root = sum rho J w / J_root. Books the work of each coupling
    /// (J, by component) in `work`, if given. Returns the change of kinetic energy (J).
    double engage(Shafts& shafts, std::vector<double>* work = nullptr);
    /// Computes angles and speeds of the joined shafts from their roots. `active`: by shaft; empty: all.
    void derive(Shafts& shafts, std::span<const std::uint8_t> active = {}) const;

    // Facts ----------------------------------------------------------------------------------------------------------
    std::span<const ShaftTree> trees() const { return trees_; }
    std::span<const ShaftNode> nodes() const { return nodes_; }
    std::span<const ShaftNode> nodes(const ShaftTree& t) const { return nodes().subspan(t.first, t.count); }
    /// The tree of a shaft; null if nothing is coupled to it.
    const ShaftTree* tree_of(std::uint32_t shaft) const
    {
        return shaft < tree_of_.size() && tree_of_[shaft] != kNoIndex ? &trees_[tree_of_[shaft]] : nullptr;
    }
    /// The couplings as they were added.
    std::span<const RatioEdge> edges() const { return edges_; }
    /// Components whose coupling closes a loop and is consistent with it, in id order.
    std::span<const std::uint32_t> redundant() const { return redundant_; }
    /// Sums over both sides of each node of a tree; `own` by node.
    void sum_sides(const ShaftTree& tree, std::span<const double> own, SideSums& sums) const;

private:
    struct Built
    {
        std::vector<ShaftTree> trees;
        std::vector<ShaftNode> nodes;
        std::vector<std::uint32_t> tree_of;
        std::vector<std::uint32_t> redundant;
    };
    static Built reduce(const RatioForest& forest, const Shafts& shafts);
    void weigh();
    void write(Shafts& shafts) const;
    bool consistent(const ShaftTree& tree, const Shafts& shafts) const;
    double engage(const ShaftTree& tree, Shafts& shafts, std::vector<double>* work);
    void book_engagement(const ShaftTree& tree, const Shafts& shafts, double speed, std::vector<double>& work);

    std::vector<RatioEdge> edges_;
    std::vector<OneWayDrive> drives_;
    std::vector<std::uint32_t> without_factor_;  // components

    std::vector<ShaftTree> trees_;
    std::vector<ShaftNode> nodes_;
    std::vector<std::uint32_t> tree_of_;  // by shaft
    std::vector<std::uint32_t> redundant_;
    SideSums sums_;
    std::vector<double> momentum_;  // by node
};

}  // namespace plab::simulation
