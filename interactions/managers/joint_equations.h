/// How impulses move the movers of an island whose joints hold:
///
///   M (v - v0) - J^T lambda = push,   J v + C lambda = target
///
/// J: the rows that no bound limits (joints, couplings, changes of forces), C: their compliance, 0 but for changes of forces; lambda: their
/// impulses. The matrix [M J^T; J -C] is factored as it stands, along the tree of joints (linear/sparse_blocks.h): neither a stiffness
/// stands for a joint, as in joint_solver.h, nor is J M^-1 J^T multiplied out. A link of a hundred-thousandth of the mass, as between the
/// axes of one shoulder, so costs no digits. Rows that close a loop may depend on others, and are left out.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "island_matrix.h"

namespace plab::managers
{

class JointEquations
{
public:
    /// Finds the joints. False if there are none.
    bool shape(const Problem& problem);
    /// Of the present attitudes. Rows that others imply there are left out until shape() is called again: a solution must not depend on
    /// what was solved before. False if nothing is left, or in an interrupted step.
    bool factor(const Problem& problem);
    /// By line: 1 if it is one of the rows that hold here.
    std::span<const std::uint8_t> holds() const { return holds_; }

    /// `x`: the sum of all other impulses on each mover (N s, N m s), which becomes its velocities (m/s, rad/s).
    void move_with(const Problem& problem, std::span<Column6> x);
    /// The part of them that is due to `x`.
    void respond(std::span<Column6> x);
    /// Takes what rounding has left of the rows at the present velocities: adds to their impulses.
    void correct(Problem& problem);
    /// lambda of the last call of move_with().
    double impulse(std::size_t line) const { return -x_[unknown_[line]]; }

private:
    using Movers = std::array<std::uint32_t, ConstraintRow::kMostBlocks>;
    /// Rows between the same movers, at most as many as a block has unknowns.
    struct Joint
    {
        Movers movers{};  ///< ascending; the rest is kNoIndex
        std::uint32_t count = 0, rows = 0, hard = 0;
        std::uint32_t toward_root = kNoIndex;
        bool closes = false;  ///< a loop
        std::array<std::uint32_t, ConstraintRow::kMostBlocks> edges{};
    };
    struct Row
    {
        Movers movers{};
        std::uint32_t line = 0;
        friend auto operator<=>(const Row&, const Row&) = default;
    };

    void list_rows(const Problem& problem);
    void list_joints(const Problem& problem);
    void find_tree(const Problem& problem);
    void reach(std::uint32_t joint, std::uint32_t from);
    void find_joints(const Problem& problem);
    void analyse(std::size_t movers);
    void fill(const Problem& problem);
    void put(std::span<const Column6> x);
    void solve(std::span<Column6> x);

    linear::SparseBlocks matrix_;
    std::vector<std::uint8_t> holds_;
    std::vector<Row> rows_;                            ///< of the joints
    std::vector<Row> fresh_rows_, known_rows_;         ///< with those that close loops: of this problem, and of the last analysis
    std::vector<std::uint8_t> hard_, known_hard_;      ///< by line: has no compliance
    std::vector<std::uint8_t> shafts_, known_shafts_;  ///< by mover: is one
    bool narrowed_ = false;                            ///< rows_ lacks some that the present attitudes imply
    std::vector<Joint> joints_;
    std::vector<std::uint32_t> joint_of_, place_, unknown_;  ///< by line
    std::vector<std::uint8_t> reached_;                      ///< by mover
    std::vector<std::vector<std::uint32_t>> joints_of_;      ///< by mover
    std::vector<std::uint32_t> waiting_;
    std::vector<double> x_;
};

}  // namespace plab::managers
