#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "simulation/rows/sparse_ldlt.h"

namespace plab::simulation
{
namespace
{

/// The graph of what is not eliminated yet. Whoever is eliminated leaves its neighbours joined to one another.
class EliminationGraph
{
public:
    EliminationGraph(std::span<const SparseNode> nodes, std::span<const SparseEdge> edges)
        : nodes_(nodes), neighbours_(nodes.size()), regular_(nodes.size(), 0)
    {
        for (const SparseEdge& e : edges) neighbours_[e.joint].push_back(e.body), neighbours_[e.body].push_back(e.joint);
        for (auto& n : neighbours_) std::sort(n.begin(), n.end());
        for (std::uint32_t i = 0; i < nodes.size(); ++i)
            if (eligible(i)) queue_.insert({neighbours_[i].size(), i});
    }

    bool done() const { return queue_.empty(); }
    std::uint32_t next() const { return queue_.begin()->second; }

    void eliminate(std::uint32_t k)
    {
        queue_.erase({neighbours_[k].size(), k});
        const std::vector<std::uint32_t> around = std::exchange(neighbours_[k], {});
        for (const std::uint32_t i : around)
        {
            queue_.erase({neighbours_[i].size(), i});
            if (!nodes_[k].negative) regular_[i] = 1;
            merged_.clear();
            std::set_union(neighbours_[i].begin(), neighbours_[i].end(), around.begin(), around.end(), std::back_inserter(merged_));
            std::erase_if(merged_, [i, k](std::uint32_t j) { return j == i || j == k; });
            neighbours_[i] = merged_;
            if (eligible(i)) queue_.insert({neighbours_[i].size(), i});
        }
    }

private:
    /// A joint's pivot is regular once enough of the bodies around it are gone: in a tree one, and all but one; in a loop all.
    bool eligible(std::uint32_t i) const
    {
        if (!nodes_[i].negative) return true;
        const auto bodies =
            std::count_if(neighbours_[i].begin(), neighbours_[i].end(), [&](std::uint32_t j) { return !nodes_[j].negative; });
        return regular_[i] != 0 && bodies <= (nodes_[i].early ? 1 : 0);
    }

    std::span<const SparseNode> nodes_;
    std::vector<std::vector<std::uint32_t>> neighbours_;
    std::vector<std::uint8_t> regular_;  // a joint that has lost a body
    std::vector<std::uint32_t> merged_;
    std::set<std::pair<std::size_t, std::uint32_t>> queue_;  // by degree
};

}  // namespace

std::vector<std::uint32_t> order_of_elimination(std::span<const SparseNode> nodes, std::span<const SparseEdge> edges)
{
    EliminationGraph graph(nodes, edges);
    std::vector<std::uint32_t> order;
    order.reserve(nodes.size());
    while (!graph.done())
    {
        order.push_back(graph.next());
        graph.eliminate(order.back());
    }
    return order;
}

}  // namespace plab::simulation
