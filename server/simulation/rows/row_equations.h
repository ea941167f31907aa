/// The linear equations of constrained motion: M x - J^T lambda = g, J x = b, over the bodies and shafts that rows touch.
///
/// One solve serves accelerations (g: forces), speeds and positions (g = 0). Unknowns of a body: velocity in W and angular
/// velocity in B, so that its inertia is a constant; of a shaft: the speed of its train's root.
///
/// Rows of loops carry a small compliance (kCompliance of their own mobility): where rows depend on one another, that picks
/// the multipliers of least norm, and nothing has to be decided about the rank. Iterative refinement against the equations
/// without compliance takes its effect away (the proximal point iteration: R. T. Rockafellar, SIAM J. Control Optim. 14,
/// 1976).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "plab/rows.h"
#include "simulation/rows/sparse_ldlt.h"
#include "simulation/shafts/constraint_graph.h"
#include "world/host_tables.h"

namespace plab::simulation
{

/// The rows of one component: a piece of the list of rows.
struct RowPiece
{
    std::uint32_t component = 0;
    std::uint32_t first = 0, count = 0;
    friend bool operator==(const RowPiece&, const RowPiece&) = default;
};

class RowEquations
{
public:
    /// Share of a row's own mobility. Close to a singular configuration rounding errors e of rows become movements of
    /// e / (2 sqrt(kCompliance)) at most.
    static constexpr double kCompliance = 1e-8;
    /// The same where rows contradict one another: least squares, at a cost in digits that does not matter there.
    static constexpr double kSoftCompliance = 1e-6;
    /// The same for rows that nothing but a singular configuration makes depend on others: see sharpen().
    static constexpr double kSharpCompliance = 1e-12;
    /// A row is redundant if others leave it less than this share of its own mobility.
    static constexpr double kRedundant = 1e-6;

    /// A body or shaft that rows move. Its node in the matrix has the same number.
    struct Member
    {
        Ref who;
        double inertia = 0;       ///< of a shaft's train at its root, kg m^2
        double inverse_mass = 0;  ///< 1/kg
    };

    void bind(const world::HostTables& host, const ConstraintGraph& graph) { host_ = &host, graph_ = &graph; }
    /// Takes the rows in at the tables' present state; shafts stand for their roots. Rows that may yield are skipped.
    /// Analyses anew if who takes part in what has changed.
    void set_rows(std::span<const ConstraintRow> rows, std::span<const RowPiece> pieces);
    /// That part of set_rows() alone. True if rows may depend on one another: compliant().
    bool analyse(std::span<const ConstraintRow> rows, std::span<const RowPiece> pieces);
    void factor(double compliance = kCompliance) { factor(compliance, compliance); }
    /// Of the last factorisation.
    double compliance() const { return compliance_; }

    void clear_right_hand_side();
    /// g of a member: force in W (N) and torque in B (N m), or the torque on a train (N m).
    double* load(std::size_t member) { return &rhs_[factors_.offset(static_cast<std::uint32_t>(member))]; }
    /// b of row slots()[slot].
    double& wanted(std::size_t slot) { return rhs_[unknown_of(slots_[slot])]; }
    /// Into result() and multiplier(), by the last factorisation: with compliance as it stands, and of rows as they were
    /// then. False: something is not finite.
    bool solve();
    /// The same, refined against the rows as they are now, without compliance.
    bool solve_refined();
    /// Notes which rows the others imply, at the tables' present state; factors anew. To be called where the members stand on
    /// their rows: off them, rows that imply one another seem not to, and contradict each other.
    void note_implied();
    /// As long as nothing is noted, sharpen() does nothing.
    void forget_implied() { implied_.clear(); }
    /// After solve_refined(). Close to a singular configuration, where more rows depend on one another than was noted, that ends
    /// too early: compliance lets members go in the direction that is about to become free. Solves again with
    /// kSharpCompliance for the rows that were not noted (the others keep theirs: stages are off the rows). Takes the result
    /// if it leaves less of the equations and moves the members no faster: errors of rows must not become movements.
    void sharpen();
    /// What the result leaves of the equations as they are now, without compliance, relative to the terms of their sums.
    double left() { return residual(); }

    /// Of the last solve, in the norm of M: sqrt(g . M^-1 g) of the loads, and sqrt(c . M c), c = M^-1 J^T lambda, of what rows
    /// added.
    struct Norms
    {
        double loads = 0, reactions = 0;
    };
    Norms norms() const;
    /// Whether some rows have compliance: those of loops, or of several components between the same members.
    bool compliant() const { return any_compliant_; }

    std::span<const Member> members() const { return members_; }
    const double* result(std::size_t member) const { return &x_[factors_.offset(static_cast<std::uint32_t>(member))]; }

    /// A row that is held here.
    struct Slot
    {
        std::uint32_t row = 0;                       ///< in the list that set_rows() saw
        std::uint32_t piece = 0;                     ///< whose it is
        std::uint32_t held = 0;                      ///< its number among rows that do not yield
        std::uint32_t joint = 0, place = 0;          ///< node of the matrix beyond the members, and the row's number in it
        std::uint32_t first_entry = 0, entries = 0;  ///< one for each member
        double mobility = 0;                         ///< J M^-1 J^T of this row alone
    };
    std::span<const Slot> slots() const { return slots_; }
    /// lambda of the last solve, by slot.
    double multiplier(std::size_t slot) const { return -x_[unknown_of(slots_[slot])]; }
    /// J x of the last solve, by slot.
    double moved(std::size_t slot) const;
    /// Whether other rows leave this one nothing to do, at the last factorisation.
    bool redundant(std::size_t slot) const;

private:
    struct Entry
    {
        std::uint32_t member = 0, edge = 0;
        std::array<double, 6> j{};  ///< linear in W, angular in B; a shaft: j[0]
    };
    struct Joint
    {
        std::vector<std::uint32_t> members;  ///< ascending
        std::uint32_t rows = 0;
        bool grounded = false;  ///< it also holds on to something that does not move
        bool compliant = false;
        bool loop = false;
    };
    struct Participant
    {
        Ref who;
        bool mobile = false;
        friend bool operator==(const Participant&, const Participant&) = default;
    };
    using Participants = std::array<Participant, ConstraintRow::kMostBlocks>;
    /// A row that does not yield.
    struct Held
    {
        std::uint32_t row = 0, piece = 0;
    };
    /// What the analysis depends on: those that yield may come and go.
    struct Pattern
    {
        std::uint32_t component = 0;
        Participants who;
        friend bool operator==(const Pattern&, const Pattern&) = default;
    };

    class Analysis;
    bool is_mobile(Ref who) const
    {
        return who.facet == Facet::Body ? host_->bodies.dynamic(who.index) : who.facet == Facet::Shaft && host_->shafts.dynamic(who.index);
    }
    Participants participants_of(const ConstraintRow& row) const;
    void list_held(std::span<const ConstraintRow> rows, std::span<const RowPiece> pieces);
    bool same_pattern(std::span<const ConstraintRow> rows) const;
    void find_loops();
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
    double residual();
    void subtract_rows();
    double worst_of_rows() const;
    double worst_of_members() const;
    std::uint32_t size_of(const Member& m) const { return m.who.facet == Facet::Body ? 6u : 1u; }
    std::uint32_t unknown_of(const Slot& s) const
    {
        return factors_.offset(static_cast<std::uint32_t>(members_.size()) + s.joint) + s.place;
    }

    const world::HostTables* host_ = nullptr;
    const ConstraintGraph* graph_ = nullptr;

    std::vector<Held> held_;  ///< of the present rows
    // What the analysis was of, and found.
    std::vector<Pattern> pattern_;
    std::vector<Member> members_;
    std::vector<Joint> joints_;
    std::vector<Slot> slots_;
    std::vector<Entry> entries_;
    bool any_compliant_ = false;

    SparseLdlt factors_;
    double compliance_ = -1;  ///< -1: not factored yet
    bool any_small_ = false;
    std::vector<std::uint8_t> implied_;                         // by slot; empty: not noted
    std::vector<double> rhs_, x_, r_, before_, blunt_, scale_;  // by unknown
    std::vector<double> joint_error_, joint_scale_;             // by joint
};

}  // namespace plab::simulation
