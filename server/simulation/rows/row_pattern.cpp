#include <algorithm>
#include <map>
#include <utility>

#include "simulation/rows/row_equations.h"

namespace plab::simulation
{

/// The symbolic analysis: nodes and edges of the matrix from the rows, in their fixed order. Indices are given in the order in which
/// participants first appear, so that neither host rows nor load order influence the rounding of sums.
class RowEquations::Analysis
{
public:
    Analysis(RowEquations& out, std::span<const ConstraintRow> rows) : out_(out), rows_(rows) {}

    void run()
    {
        out_.pattern_.clear();
        for (const Held& h : out_.held_) out_.pattern_.push_back({rows_[h.row].component, out_.participants_of(rows_[h.row])});
        out_.members_.clear(), out_.joints_.clear(), out_.slots_.clear(), out_.entries_.clear();
        for (std::uint32_t i = 0; i < out_.held_.size(); ++i) take(i);
        out_.find_loops();
        make_matrix();
        out_.implied_.reserve(out_.slots_.size());
        out_.forget_implied();
    }

private:
    void take(std::uint32_t held)
    {
        const auto members = members_of(held);
        if (members.empty()) return;  // no dynamic participant
        Slot slot;
        slot.held = held, slot.row = out_.held_[held].row, slot.piece = out_.held_[held].piece;
        slot.joint = joint_for(held, members);
        slot.place = out_.joints_[slot.joint].rows++;
        slot.first_entry = static_cast<std::uint32_t>(out_.entries_.size());
        slot.entries = static_cast<std::uint32_t>(members.size());
        for (const std::uint32_t m : members) out_.entries_.push_back({m, edge_of(slot.joint, m), {}});
        out_.slots_.push_back(slot);
    }

    std::vector<std::uint32_t> members_of(std::uint32_t held)
    {
        std::vector<std::uint32_t> members;
        for (const Participant& p : out_.pattern_[held].participants)
        {
            if (!p.mobile) continue;
            const auto [at, fresh] = member_of_.emplace(p.ref, static_cast<std::uint32_t>(out_.members_.size()));
            if (fresh) out_.members_.push_back({p.ref, 0, 0});
            if (std::find(members.begin(), members.end(), at->second) == members.end()) members.push_back(at->second);
        }
        return members;
    }

    bool is_grounded(std::uint32_t held, std::size_t members) const
    {
        if (members < 2) return true;
        for (std::uint32_t k = 0; k < rows_[out_.held_[held].row].count; ++k)
            if (!out_.pattern_[held].participants[k].mobile) return true;
        return false;
    }

    /// Rows between the same members form one joint, up to the size of a block.
    std::uint32_t joint_for(std::uint32_t held, std::vector<std::uint32_t> members)
    {
        std::sort(members.begin(), members.end());
        const bool grounded = is_grounded(held, members.size());
        const std::uint32_t piece = out_.held_[held].piece;
        const auto key = std::pair(members, grounded);
        const auto known = open_joint_.find(key);
        if (known != open_joint_.end() && out_.joints_[known->second].rows < linear::SparseBlocks::kMostSize)
        {
            if (piece_of_joint_[known->second] != piece) out_.joints_[known->second].compliant = true;
            return known->second;
        }
        const auto joint = static_cast<std::uint32_t>(out_.joints_.size());
        out_.joints_.push_back({members, 0, grounded, false, false, kNoIndex});
        piece_of_joint_.push_back(piece);
        open_joint_[key] = joint;
        return joint;
    }

    std::uint32_t edge_of(std::uint32_t joint, std::uint32_t member)
    {
        const auto [at, fresh] = edge_.emplace(std::pair(joint, member), static_cast<std::uint32_t>(edges_.size()));
        if (fresh) edges_.push_back({joint, member});
        return at->second;
    }

    void make_matrix()
    {
        const auto count = static_cast<std::uint32_t>(out_.members_.size());
        std::vector<linear::SparseNode> nodes;
        for (const Member& m : out_.members_) nodes.push_back({out_.size_of(m), false, false});
        for (const Joint& j : out_.joints_) nodes.push_back({j.rows, true, !j.loop, j.toward_ground});
        for (linear::SparseEdge& e : edges_) e.a += count;
        out_.factors_.analyse(nodes, edges_);
        for (auto* v : {&out_.rhs_, &out_.x_, &out_.r_, &out_.before_, &out_.blunt_, &out_.scale_})
            v->assign(out_.factors_.unknowns(), 0.0);
        for (auto* v : {&out_.joint_error_, &out_.joint_scale_, &out_.joint_load_}) v->assign(out_.joints_.size(), 0.0);
    }

    RowEquations& out_;
    std::span<const ConstraintRow> rows_;
    std::map<Ref, std::uint32_t> member_of_;
    std::map<std::pair<std::vector<std::uint32_t>, bool>, std::uint32_t> open_joint_;
    std::vector<std::uint32_t> piece_of_joint_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edge_;
    std::vector<linear::SparseEdge> edges_;
};

namespace
{

/// Bridges of a graph by depth-first search with low-link numbers (R. Tarjan, "A note on finding the bridges of a graph", 1974).
class Bridges
{
public:
    explicit Bridges(std::size_t vertices) : adjacent_(vertices), number_(vertices, 0), low_(vertices, 0) {}
    void add(std::uint32_t a, std::uint32_t b)
    {
        adjacent_[a].push_back({b, edges_}), adjacent_[b].push_back({a, edges_});
        ++edges_;
    }
    /// By edge: 1 if removing it disconnects the graph.
    std::vector<std::uint8_t> find()
    {
        std::vector<std::uint8_t> bridge(edges_, 0);
        for (std::uint32_t v = 0; v < adjacent_.size(); ++v)
            if (number_[v] == 0) search(v, bridge);
        return bridge;
    }

private:
    struct Arc
    {
        std::uint32_t to = 0, edge = 0;
    };
    struct Visit
    {
        std::uint32_t vertex = 0, by = kNoIndex;
        std::size_t next = 0;
    };

    void search(std::uint32_t start, std::vector<std::uint8_t>& bridge)
    {
        stack_.push_back({start});
        number_[start] = low_[start] = ++count_;
        while (!stack_.empty())
        {
            Visit& top = stack_.back();
            if (top.next < adjacent_[top.vertex].size())
                follow(top, adjacent_[top.vertex][top.next++]);
            else
                leave(bridge);
        }
    }
    void follow(const Visit& from, const Arc& arc)
    {
        if (arc.edge == from.by) return;
        if (number_[arc.to] != 0)
        {
            low_[from.vertex] = std::min(low_[from.vertex], number_[arc.to]);
            return;
        }
        number_[arc.to] = low_[arc.to] = ++count_;
        stack_.push_back({arc.to, arc.edge, 0});
    }
    void leave(std::vector<std::uint8_t>& bridge)
    {
        const Visit done = stack_.back();
        stack_.pop_back();
        if (stack_.empty()) return;
        const std::uint32_t parent = stack_.back().vertex;
        low_[parent] = std::min(low_[parent], low_[done.vertex]);
        if (low_[done.vertex] > number_[parent]) bridge[done.by] = 1;
    }

    std::vector<std::vector<Arc>> adjacent_;
    std::vector<std::uint32_t> number_, low_;
    std::vector<Visit> stack_;
    std::uint32_t edges_ = 0, count_ = 0;
};

}  // namespace

void RowEquations::find_loops()
{
    const auto members = static_cast<std::uint32_t>(members_.size());
    const auto ground = members + static_cast<std::uint32_t>(joints_.size());
    Bridges graph(ground + 1);
    std::vector<std::uint32_t> joint_of_edge;
    for (std::uint32_t j = 0; j < joints_.size(); ++j)
    {
        for (const std::uint32_t m : joints_[j].members) graph.add(members + j, m), joint_of_edge.push_back(j);
        if (joints_[j].grounded) graph.add(members + j, ground), joint_of_edge.push_back(j);
    }
    const auto bridge = graph.find();
    for (std::size_t e = 0; e < bridge.size(); ++e)
        if (bridge[e] == 0) joints_[joint_of_edge[e]].loop = joints_[joint_of_edge[e]].compliant = true;
    find_ground(ground);
    any_compliant_ = std::any_of(joints_.begin(), joints_.end(), [](const Joint& j) { return j.compliant; });
}

/// Breadth first from the ground: the member by which a joint is reached is the one on its side.
void RowEquations::find_ground(std::uint32_t ground)
{
    std::vector<std::vector<std::uint32_t>> joints_of(members_.size());
    std::vector<std::uint8_t> reached(ground, 0);
    std::vector<std::uint32_t> waiting;  // members
    const auto leave = [&](std::uint32_t joint)
    {
        for (const std::uint32_t m : joints_[joint].members)
            if (reached[m] == 0) reached[m] = 1, waiting.push_back(m);
    };
    for (std::uint32_t j = 0; j < joints_.size(); ++j)
        for (const std::uint32_t m : joints_[j].members) joints_of[m].push_back(j);
    for (std::uint32_t j = 0; j < joints_.size(); ++j)
        if (joints_[j].grounded) reached[members_.size() + j] = 1, leave(j);
    for (std::size_t next = 0; next < waiting.size(); ++next)
        for (const std::uint32_t j : joints_of[waiting[next]])
        {
            if (reached[members_.size() + j] != 0) continue;
            reached[members_.size() + j] = 1, joints_[j].toward_ground = waiting[next];
            leave(j);
        }
}

RowEquations::Participants RowEquations::participants_of(const ConstraintRow& row) const
{
    Participants out;
    for (std::uint32_t k = 0; k < row.count; ++k) out[k] = {row.blocks[k].participant, is_mobile(row.blocks[k].participant)};
    return out;
}

void RowEquations::list_held(std::span<const ConstraintRow> rows, std::span<const RowPiece> pieces)
{
    held_.clear();
    for (std::uint32_t p = 0; p < pieces.size(); ++p)
        for (std::uint32_t row = pieces[p].first; row < pieces[p].first + pieces[p].count; ++row)
            if (!rows[row].may_yield()) held_.push_back({row, p});
}

bool RowEquations::same_pattern(std::span<const ConstraintRow> rows) const
{
    if (held_.size() != pattern_.size()) return false;
    for (std::size_t i = 0; i < held_.size(); ++i)
    {
        const ConstraintRow& row = rows[held_[i].row];
        const Pattern& known = pattern_[i];
        if (row.component != known.component) return false;
        for (std::uint32_t k = 0; k < row.count; ++k)
            if (row.blocks[k].participant != known.participants[k].ref ||
                is_mobile(row.blocks[k].participant) != known.participants[k].mobile)
                return false;
        if (row.count < known.participants.size() && known.participants[row.count].ref.valid()) return false;
    }
    return true;
}

bool RowEquations::analyse(std::span<const ConstraintRow> rows, std::span<const RowPiece> pieces)
{
    list_held(rows, pieces);
    if (!same_pattern(rows))
        Analysis(*this, rows).run();
    else
        for (Slot& slot : slots_) slot.row = held_[slot.held].row, slot.piece = held_[slot.held].piece;
    return any_compliant_;
}

void RowEquations::set_rows(std::span<const ConstraintRow> rows, std::span<const RowPiece> pieces)
{
    (void)analyse(rows, pieces);
    for (Member& m : members_) weigh(m);
    for (Slot& slot : slots_) fill(slot, rows[slot.row]);
}

}  // namespace plab::simulation
