/// The constraint graph of all shafts in reduced coordinates: one degree of freedom per connected component.
///
///   speed_i = rho_i speed_root,   angle_i = anchor_i + rho_i (angle_root - root_anchor_i)        derived, so no drift
///   J_root  = sum rho_i^2 J_i,    tau_root = sum rho_i tau_i,    alpha_root = tau_root / J_root
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

/// Shafts that move together. Its nodes are first .. first + count - 1, the root first, parents before children.
struct ShaftTree
{
    std::uint32_t root = 0;  ///< shaft: the prescribed one, else the first in the order of component ids
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t redundant = 0;  ///< couplings in it that say nothing new
    bool prescribed = false;      ///< a member does not move by forces, so none does
    double inertia = 0;           ///< of its dynamic members at the root, kg m^2
};

struct ShaftNode
{
    std::uint32_t shaft = 0;
    std::uint32_t parent = 0;            ///< node; a root's is its own
    std::uint32_t component = kNoIndex;  ///< that couples it to its parent
    bool drives_parent = false;          ///< it is that coupling's driver
    bool dynamic = true;
    double ratio = 1;            ///< turns per turn of the root
    double inertia = 0;          ///< at the root: ratio^2 J; 0 unless dynamic
    double inertia_inside = 0;   ///< sum over it and all below it
    double inertia_outside = 0;  ///< sum over all others of the tree
};

/// For each node of a tree the sum over it and all below it, and the sum over all others. Both are added up, neither is
/// a difference: torques across a mesh keep their digits at any ratio.
struct SideSums
{
    std::vector<double> inside, outside, passed;
    void resize(std::size_t nodes) { inside.resize(nodes), outside.resize(nodes), passed.resize(nodes); }
};

class ConstraintGraph final : public RatioGraph
{
public:
    // Phase::Connect -------------------------------------------------------------------------------------------------
    /// Forgets what was added. What was built stays until the next build() succeeds.
    void clear();
    void add(std::uint32_t component, Ref driver, Ref driven, const Ratio& ratio) override;
    /// A one-way drive (it reads driver and owns driven): joins nothing, but must not close a circle.
    void drive(std::uint32_t component, Ref driver, Ref driven);
    /// Joins what was added, and writes root, ratio and anchors of all shafts. To be called again after any change of
    /// couplings, inertia or motion of shafts, or when an angle was set. Where root and ratio stay as they were and the
    /// angle still follows from them, the anchors stay bit for bit. On error nothing has changed.
    Result<void> build(Shafts& shafts, const ShaftDirectory& directory);

    // The step -------------------------------------------------------------------------------------------------------
    /// Whether all speeds are derived from their roots' to the last bit.
    bool consistent(const Shafts& shafts) const;
    /// Brings speeds that are not consistent together, as a plastic impact would: w_root = sum rho J w / J_root. Books
    /// the work of each coupling (J, by component) in `work`, if given. Returns the change of kinetic energy (J).
    double engage(Shafts& shafts, std::vector<double>* work = nullptr);
    /// Angles and speeds of joined shafts from their roots'. `active` by shaft; empty: all.
    void derive(Shafts& shafts, std::span<const std::uint8_t> active = {}) const;

    // Facts ----------------------------------------------------------------------------------------------------------
    std::span<const ShaftTree> trees() const { return trees_; }
    std::span<const ShaftNode> nodes() const { return nodes_; }
    std::span<const ShaftNode> nodes(const ShaftTree& t) const { return nodes().subspan(t.first, t.count); }
    /// Of a shaft; null where nothing joins it.
    const ShaftTree* tree_of(std::uint32_t shaft) const
    {
        return shaft < tree_of_.size() && tree_of_[shaft] != kNoIndex ? &trees_[tree_of_[shaft]] : nullptr;
    }
    /// As they were added.
    std::span<const RatioEdge> edges() const { return edges_; }
    /// Components whose coupling closes a loop and agrees with it, in id order.
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
