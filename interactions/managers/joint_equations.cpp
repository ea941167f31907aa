#include "joint_equations.h"

#include <algorithm>
#include <cmath>

#include "joint_solver.h"

namespace plab::managers
{

void JointEquations::list_rows(const Problem& problem)
{
    fresh_rows_.clear(), hard_.assign(problem.lines.size(), 0), shafts_.clear();
    for (const Anchor& m : problem.anchors) shafts_.push_back(m.shaft ? 1 : 0);
    for (std::uint32_t i = 0; i < problem.lines.size(); ++i)
    {
        const Line& line = problem.lines[i];
        if (!is_joint(line)) continue;
        hard_[i] = line.compliance == 0 ? 1 : 0;
        Row& row = fresh_rows_.emplace_back();
        row.line = i;
        row.movers.fill(kNoIndex);
        std::copy_n(line.mover.begin(), line.count, row.movers.begin());
        std::sort(row.movers.begin(), row.movers.end());
        const auto end = std::unique(row.movers.begin(), row.movers.end());
        std::fill(end, row.movers.end(), kNoIndex);
    }
    std::sort(fresh_rows_.begin(), fresh_rows_.end());
}

void JointEquations::list_joints(const Problem& problem)
{
    joints_.clear();
    joint_of_.assign(problem.lines.size(), kNoIndex), place_.assign(problem.lines.size(), 0), unknown_.assign(problem.lines.size(), 0);
    for (const Row& row : rows_)
    {
        if (joints_.empty() || joints_.back().movers != row.movers || joints_.back().rows == linear::SparseBlocks::kMostSize)
        {
            Joint& fresh = joints_.emplace_back();
            fresh.movers = row.movers;
            fresh.count = static_cast<std::uint32_t>(std::ranges::count_if(row.movers, [](std::uint32_t m) { return m != kNoIndex; }));
        }
        Joint& joint = joints_.back();
        joint_of_[row.line] = static_cast<std::uint32_t>(joints_.size() - 1), place_[row.line] = joint.rows++;
        joint.hard += hard_[row.line];
    }
}

/// Goes through a joint from one of its movers, or from the ground, and reaches the others. It closes a loop if its rows are more than the
/// others have ways to move.
void JointEquations::reach(std::uint32_t number, std::uint32_t from)
{
    Joint& joint = joints_[number];
    joint.toward_root = from;
    std::uint32_t ways = 0;
    for (std::uint32_t k = 0; k < joint.count; ++k)
    {
        std::uint8_t& reached = reached_[joint.movers[k]];
        if (reached != 0) continue;
        ways += shafts_[joint.movers[k]] != 0 ? 1 : 6;
        reached = 1, waiting_.push_back(joint.movers[k]);
    }
    joint.closes = joint.hard > ways;
}

/// Joints of two movers first: a coupling that refers to the two bodies of a hinge adds the shaft to them.
void JointEquations::find_tree(const Problem& problem)
{
    reached_.assign(problem.movers.size(), 0);
    if (joints_of_.size() < problem.movers.size()) joints_of_.resize(problem.movers.size());
    for (auto& list : joints_of_) list.clear();
    std::vector<std::uint8_t> done(joints_.size(), 0);
    std::vector<std::uint32_t> wide;
    waiting_.clear();
    for (std::uint32_t j = 0; j < joints_.size(); ++j)
        for (std::uint32_t k = 0; k < joints_[j].count; ++k) joints_of_[joints_[j].movers[k]].push_back(j);
    const auto go_through = [&](std::uint32_t j, std::uint32_t from)
    {
        done[j] = 1;
        reach(j, from);
    };
    std::size_t next = 0, next_wide = 0;
    const auto follow = [&]
    {
        while (next < waiting_.size() || next_wide < wide.size())
        {
            if (next == waiting_.size())
            {
                const std::uint32_t j = wide[next_wide++];
                if (done[j] != 0) continue;
                const auto from = std::ranges::find_if(joints_[j].movers, [&](std::uint32_t m) { return reached_[m] != 0; });
                go_through(j, *from);
                continue;
            }
            const std::uint32_t mover = waiting_[next++];
            for (const std::uint32_t j : joints_of_[mover])
                if (done[j] == 0 && joints_[j].count > 2)
                    wide.push_back(j);
                else if (done[j] == 0)
                    go_through(j, mover);
        }
    };
    for (std::uint32_t j = 0; j < joints_.size(); ++j)
        if (joints_[j].count == 1) go_through(j, kNoIndex);
    follow();
    for (std::uint32_t m = 0; m < problem.movers.size(); ++m)
    {
        if (reached_[m] != 0 || joints_of_[m].empty()) continue;
        reached_[m] = 1, waiting_.push_back(m);
        follow();
    }
}

void JointEquations::analyse(std::size_t movers)
{
    std::vector<linear::SparseNode> nodes(movers, {linear::SparseBlocks::kMostSize});
    std::vector<linear::SparseEdge> edges;
    for (Joint& joint : joints_)
    {
        for (std::uint32_t k = 0; k < joint.count; ++k)
        {
            joint.edges[k] = static_cast<std::uint32_t>(edges.size());
            edges.push_back({static_cast<std::uint32_t>(nodes.size()), joint.movers[k]});
        }
        nodes.push_back({joint.rows, true, true, joint.toward_root});
    }
    matrix_.analyse(nodes, edges);
    for (std::uint32_t i = 0; i < joint_of_.size(); ++i)
        if (joint_of_[i] != kNoIndex) unknown_[i] = matrix_.offset(static_cast<std::uint32_t>(movers) + joint_of_[i]) + place_[i];
    x_.assign(matrix_.unknowns(), 0.0);
}

/// Leaves out the rows that close loops.
void JointEquations::find_joints(const Problem& problem)
{
    list_joints(problem);
    find_tree(problem);
    const auto closes = [this](const Row& row) { return joints_[joint_of_[row.line]].closes; };
    if (std::erase_if(rows_, closes) > 0)
    {
        list_joints(problem);
        find_tree(problem);
    }
    holds_.assign(problem.lines.size(), 0);
    for (const Row& row : rows_) holds_[row.line] = 1;
    if (std::ranges::none_of(joints_, [](const Joint& j) { return j.hard > 0; })) joints_.clear();
    if (!joints_.empty()) analyse(problem.movers.size());
}

bool JointEquations::shape(const Problem& problem)
{
    list_rows(problem);
    const bool same = fresh_rows_ == known_rows_ && hard_ == known_hard_ && shafts_ == known_shafts_;
    if (same && !narrowed_) return !joints_.empty();
    known_rows_ = rows_ = fresh_rows_, known_hard_ = hard_, known_shafts_ = shafts_, narrowed_ = false;
    find_joints(problem);
    return !joints_.empty();
}

bool JointEquations::factor(const Problem& problem)
{
    constexpr int kTries = 4;
    for (int i = 0; i < kTries && !joints_.empty(); ++i)
    {
        fill(problem);
        if (!matrix_.factor(problem.interruption)) return false;
        const auto implied = [this](const Row& row) { return matrix_.small()[unknown_[row.line]] != 0; };
        if (std::erase_if(rows_, implied) == 0) return true;
        narrowed_ = true;
        find_joints(problem);
    }
    return false;
}

void JointEquations::fill(const Problem& problem)
{
    constexpr std::size_t n = linear::SparseBlocks::kMostSize;
    matrix_.clear();
    for (std::uint32_t i = 0; i < problem.movers.size(); ++i)
    {
        double* const d = matrix_.diagonal(i);
        const Anchor& m = problem.anchors[i];
        d[0] = d[7] = d[14] = m.mass;
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c <= r; ++c) d[n * (3 + r) + 3 + c] = m.inertia.m[r][c];
    }
    const auto movers = static_cast<std::uint32_t>(problem.movers.size());
    for (const Row& row : rows_)
    {
        const Line& line = problem.lines[row.line];
        const Joint& joint = joints_[joint_of_[row.line]];
        const std::uint32_t place = place_[row.line];
        for (std::uint32_t k = 0; k < line.count; ++k)
        {
            std::uint32_t e = 0;
            while (joint.movers[e] != line.mover[k]) ++e;
            for (std::uint32_t c = 0; c < 3; ++c)
            {
                matrix_.add(joint.edges[e], place, c, line.linear[k][c]);
                matrix_.add(joint.edges[e], place, 3 + c, line.angular[k][c]);
            }
        }
        matrix_.diagonal(movers + joint_of_[row.line])[place * (joint.rows + 1)] = -line.compliance;
        matrix_.set_floor(unknown_[row.line], 0, line.mobility);
    }
}

void JointEquations::put(std::span<const Column6> x)
{
    std::ranges::fill(x_, 0.0);
    for (std::size_t i = 0; i < x.size(); ++i) std::copy_n(x[i].begin(), x[i].size(), &x_[x[i].size() * i]);
}

void JointEquations::solve(std::span<Column6> x)
{
    matrix_.solve(x_);
    for (std::size_t i = 0; i < x.size(); ++i) std::copy_n(&x_[x[i].size() * i], x[i].size(), x[i].begin());
}

void JointEquations::respond(std::span<Column6> x)
{
    put(x);
    solve(x);
}

void JointEquations::correct(Problem& problem)
{
    std::ranges::fill(x_, 0.0);
    for (const Row& row : rows_) x_[unknown_[row.line]] = -problem.gap(problem.lines[row.line]);
    matrix_.solve(x_);
    for (const Row& row : rows_) problem.lines[row.line].impulse += impulse(row.line);
}

void JointEquations::move_with(const Problem& problem, std::span<Column6> x)
{
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        const Anchor& m = problem.anchors[i];
        add(x[i], m.v * m.mass, m.inertia * m.w);
    }
    put(x);
    for (const Row& row : rows_)
    {
        const Line& line = problem.lines[row.line];
        x_[unknown_[row.line]] = line.target - line.given - line.turning;
    }
    solve(x);
}

}  // namespace plab::managers
