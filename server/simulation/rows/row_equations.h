/// The linear equations of constrained motion over the bodies and shafts that constraint rows touch:
///
///   M x - J^T lambda = g,   J x = b         x: accelerations, speeds or displacements;  lambda: one multiplier per row
///
/// The same solver serves accelerations (g: forces) and the corrections of speeds and positions (g = 0). The unknowns of a body are its
/// velocity in W and its angular velocity in B, where its inertia is constant; the unknown of a shaft is the speed of the root of its
/// train.
///
/// With y = -lambda the equations become one symmetric matrix, K = [M J^T; J -C] (x; y) = (g; b), where C >= 0 is a small diagonal
/// compliance. M is positive definite and -C is negative (semi)definite; such a quasi-definite matrix has a factorisation L D L^T with a
/// diagonal D in a fixed order of elimination, without pivoting for size (linear/sparse_blocks.h). Nodes of K are members (bodies, shafts)
/// and joints: rows between the same members form one joint of up to six rows. Mass and Jacobian are never multiplied out to J M^-1 J^T:
/// along a tree of joints, elimination from the leaves causes no fill, takes linear time, and keeps its digits at large mass ratios.
///
/// A tree of joints gets C = 0, because its rows are independent of one another. Rows that may depend on one another (joints on a closed
/// loop, or several components between the same members) get C = kCompliance times the row's own mobility J M^-1 J^T. That makes K
/// regular whatever the rank of J is, and selects the multipliers of least norm, so no decision about the rank is needed. Iterative
/// refinement against the equations with C = 0 then removes the effect of the compliance (this is the proximal point iteration: R. T.
/// Rockafellar, SIAM J. Control Optim. 14, 1976).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "linear/sparse_blocks.h"
#include "plab/rows.h"
#include "simulation/shafts/constraint_graph.h"
#include "world/host_tables.h"

namespace plab::simulation
{

/// The rows of one component: a contiguous part of the list of rows.
struct RowPiece
{
    std::uint32_t component = 0;
    std::uint32_t first = 0, count = 0;
    friend bool operator==(const RowPiece&, const RowPiece&) = default;
};

class RowEquations
{
public:
    /// Compliance of rows that may be dependent, relative to the row's own mobility. Close to a singular configuration, rounding errors e
    /// of rows cause displacements of at most e / (2 sqrt(kCompliance)).
    static constexpr double kCompliance = 1e-8;
    /// Compliance when rows contradict one another: the solution is then one of least squares, where the loss of digits does not matter.
    static constexpr double kSoftCompliance = 1e-6;
    /// Compliance of rows that become dependent only in a singular configuration: see sharpen().
    static constexpr double kSharpCompliance = 1e-12;
    /// A row is redundant if the other rows leave it less than this share of its own mobility.
    static constexpr double kRedundant = 1e-6;

    /// A body or shaft that rows can move. Its node in the matrix has the same index.
    struct Member
    {
        Ref participant;
        double inertia = 0;       ///< of a shaft's whole train, reduced to its root, kg m^2
        double inverse_mass = 0;  ///< 1/kg
    };

    void bind(const world::HostTables& host, const ConstraintGraph& graph) { host_ = &host, graph_ = &graph; }
    /// Takes over the rows at the present state of the host tables. Shafts are represented by the roots of their trains. Rows that may
    /// yield (limits, motors with a bounded force) are skipped. The symbolic analysis is repeated only if the participants of the rows
    /// have changed.
    void set_rows(std::span<const ConstraintRow> rows, std::span<const RowPiece> pieces);
    /// Only the symbolic part of set_rows(). Returns compliant(): whether rows may depend on one another.
    bool analyse(std::span<const ConstraintRow> rows, std::span<const RowPiece> pieces);
    void factor(double compliance = kCompliance) { factor(compliance, compliance); }
    /// Compliance of the last factorisation, relative to the rows' mobilities.
    double compliance() const { return compliance_; }

    void clear_right_hand_side();
    /// g of a member: force in W (N) and torque in B (N m) of a body, or the torque on a shaft's train at its root (N m).
    double* load(std::size_t member) { return &rhs_[factors_.offset(static_cast<std::uint32_t>(member))]; }
    /// b of row slots()[slot].
    double& wanted(std::size_t slot) { return rhs_[unknown_of(slots_[slot])]; }
    /// Solves with the last factorisation, that is, for the rows and the compliance as they were when factor() was called; the solution
    /// is in result() and multiplier(). Returns false if it is not finite.
    bool solve();
    /// Like solve(), then refines the solution against the present rows without compliance.
    bool solve_refined();
    /// Records which rows are implied by the others at the present state of the tables, and factors again. To be called where the members
    /// satisfy their rows: elsewhere, dependent rows appear to be independent and contradict one another.
    void note_implied();
    /// Discards that record. Without a record sharpen() does nothing.
    void forget_implied() { implied_.clear(); }
    /// To be called after solve_refined(). Close to a singular configuration more rows depend on one another than note_implied()
    /// recorded, and refinement stops too early: the compliance lets the members move in the direction that is about to become free. This
    /// function solves again with kSharpCompliance for the rows that were not recorded as implied; the recorded ones keep kCompliance
    /// because at the stages of a solver the members do not satisfy their rows exactly. The new solution is accepted only if its residual
    /// is smaller and the members do not move faster, so that errors of rows never turn into motion.
    void sharpen();
    /// The residual of the solution in the present equations without compliance, relative to the sizes of the terms.
    double left() { return residual(); }

    /// Of the last solve, in the norm of M: sqrt(g . M^-1 g) of the loads, and sqrt(c . M c) with c = M^-1 J^T lambda of what the rows
    /// added.
    struct Norms
    {
        double loads = 0, reactions = 0;
    };
    Norms norms() const;
    /// Whether some rows have compliance: rows on loops, or of several components between the same members.
    bool compliant() const { return any_compliant_; }

    std::span<const Member> members() const { return members_; }
    const double* result(std::size_t member) const { return &x_[factors_.offset(static_cast<std::uint32_t>(member))]; }

    /// A row that takes part in the equations.
    struct Slot
    {
        std::uint32_t row = 0;                       ///< index in the list that was given to set_rows()
        std::uint32_t piece = 0;                     ///< piece (component) that it belongs to
        std::uint32_t held = 0;                      ///< its number among the rows that cannot yield
        std::uint32_t joint = 0, place = 0;          ///< joint node in the matrix (after the members), and the row's number in that node
        std::uint32_t first_entry = 0, entries = 0;  ///< one entry for each member
        double mobility = 0;                         ///< J M^-1 J^T of this row alone
    };
    std::span<const Slot> slots() const { return slots_; }
    /// lambda of the last solve, by slot.
    double multiplier(std::size_t slot) const { return -x_[unknown_of(slots_[slot])]; }
    /// J x of the last solve, by slot.
    double moved(std::size_t slot) const;
    /// Whether the other rows already imply this one, according to the last factorisation.
    bool redundant(std::size_t slot) const;

private:
    struct Entry
    {
        std::uint32_t member = 0, edge = 0;
        std::array<double, 6> j{};  ///< linear in W, angular in B; for a shaft only j[0]
    };
    struct Joint
    {
        std::vector<std::uint32_t> members;  ///< ascending
        std::uint32_t rows = 0;
        bool grounded = false;  ///< also attached to something that is not dynamic
        bool compliant = false;
        bool loop = false;
        std::uint32_t toward_ground = kNoIndex;  ///< the member on the side of the ground; none: the ground itself, or there is none
    };
    struct Participant
    {
        Ref ref;
        bool mobile = false;
        friend bool operator==(const Participant&, const Participant&) = default;
    };
    using Participants = std::array<Participant, ConstraintRow::kMostBlocks>;
    /// A row that cannot yield.
    struct Held
    {
        std::uint32_t row = 0, piece = 0;
    };
    /// What the symbolic analysis depends on. Rows that may yield are not part of it, so they may come and go.
    struct Pattern
    {
        std::uint32_t component = 0;
        Participants participants;
        friend bool operator==(const Pattern&, const Pattern&) = default;
    };

    class Analysis;
    bool is_mobile(Ref participant) const
    {
        return participant.facet == Facet::Body ? host_->bodies.dynamic(participant.index)
                                                : participant.facet == Facet::Shaft && host_->shafts.dynamic(participant.index);
    }
    Participants participants_of(const ConstraintRow& row) const;
    void list_held(std::span<const ConstraintRow> rows, std::span<const RowPiece> pieces);
    bool same_pattern(std::span<const ConstraintRow> rows) const;
    void find_loops();
    void find_ground(std::uint32_t ground);
    void fill(Slot& slot, const ConstraintRow& row);
    void fill_masses();
    void factor(double implied, double others);
    bool rank_fell() const;
    double speed_of_result() const;
    void weigh(Member& member) const;
    void times_mass(const Member& member, const double* x, double* out) const;
    void over_mass(const Member& member, const double* g, double* out) const;
    double mobility_of(const Entry& entry) const;
    bool is_finite() const;
    void find_joint_loads();
    double worst_of_loads() const;
    double residual();
    void subtract_rows();
    double worst_of_rows() const;
    double worst_of_members() const;
    std::uint32_t size_of(const Member& m) const { return m.participant.facet == Facet::Body ? 6u : 1u; }
    std::uint32_t unknown_of(const Slot& s) const
    {
        return factors_.offset(static_cast<std::uint32_t>(members_.size()) + s.joint) + s.place;
    }

    const world::HostTables* host_ = nullptr;
    const ConstraintGraph* graph_ = nullptr;

    std::vector<Held> held_;  ///< of the present list of rows
    // Input and results of the symbolic analysis.
    std::vector<Pattern> pattern_;
    std::vector<Member> members_;
    std::vector<Joint> joints_;
    std::vector<Slot> slots_;
    std::vector<Entry> entries_;
    bool any_compliant_ = false;

    linear::SparseBlocks factors_;
    double compliance_ = -1;  ///< -1: not factored yet
    bool any_small_ = false;
    std::vector<std::uint8_t> implied_;                           // by slot; empty: not noted
    std::vector<double> rhs_, x_, r_, before_, blunt_, scale_;    // by unknown
    std::vector<double> joint_error_, joint_scale_, joint_load_;  // by joint; loads: speeds per s that they alone would give
};

}  // namespace plab::simulation
