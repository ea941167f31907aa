#include "simulation/shafts/ratio_forest.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "plab/ref.h"

namespace plab::simulation
{
namespace
{

// The exponent of rho is limited so that rho^2 J stays in the range of double precision.
constexpr int kLargestExponent = 400;

class Grower
{
public:
    Grower(std::vector<RatioEdge> edges, std::span<const std::uint8_t> prescribed, const ShaftDirectory& directory)
        : prescribed_(prescribed), directory_(directory), position_(prescribed.size(), kNoIndex)
    {
        forest_.edges = std::move(edges);
    }

    Result<RatioForest> run()
    {
        sort_edges();
        refuse_self_couplings();
        if (!errors_.empty()) return errors_;
        choose_tree_edges();
        for (const std::uint32_t shaft : root_candidates())
            if (position_[shaft] == kNoIndex) grow_tree(shaft);
        forest_.tree_begin.push_back(static_cast<std::uint32_t>(forest_.nodes.size()));
        for (std::uint32_t e = 0; e < forest_.edges.size(); ++e)
            if (!in_tree_[e]) close_loop(e);
        if (!errors_.empty()) return errors_;
        return std::move(forest_);
    }

private:
    struct Link
    {
        std::uint32_t edge;
        std::uint32_t other;  // shaft
    };

    void refuse(std::uint32_t component, std::string why) { errors_.push_back({{}, directory_.component_id(component), std::move(why)}); }

    void sort_edges()
    {
        const auto before = [this](const RatioEdge& a, const RatioEdge& b)
        { return directory_.rank_of_component(a.component) < directory_.rank_of_component(b.component); };
        // The couplings of one type come in the order of ids.
        if (!std::is_sorted(forest_.edges.begin(), forest_.edges.end(), before))
            std::stable_sort(forest_.edges.begin(), forest_.edges.end(), before);
    }

    void refuse_self_couplings()
    {
        for (const RatioEdge& e : forest_.edges)
            if (e.driver == e.driven)
                refuse(e.component, "couples " + directory_.shaft_id(e.driver) + " to itself; driver and driven must be two shafts");
    }

    // Kruskal's algorithm with the edges in the order of ids; union-find with path halving.
    void choose_tree_edges()
    {
        std::vector<std::uint32_t> set(prescribed_.size());
        std::iota(set.begin(), set.end(), 0u);
        const auto find = [&set](std::uint32_t i)
        {
            while (set[i] != i) i = set[i] = set[set[i]];
            return i;
        };
        in_tree_.assign(forest_.edges.size(), 0);
        links_of_.assign(prescribed_.size() + 1, 0);
        for (std::uint32_t e = 0; e < forest_.edges.size(); ++e)
        {
            const RatioEdge& edge = forest_.edges[e];
            const std::uint32_t a = find(edge.driver);
            const std::uint32_t b = find(edge.driven);
            if (a == b) continue;
            set[std::max(a, b)] = std::min(a, b);
            in_tree_[e] = 1;
            ++links_of_[edge.driver], ++links_of_[edge.driven];
        }
        fill_links();
    }

    // links_of_ first holds counts, then ends, and after filling the begins.
    void fill_links()
    {
        std::partial_sum(links_of_.begin(), links_of_.end(), links_of_.begin());
        links_.resize(links_of_.back());
        for (std::uint32_t k = static_cast<std::uint32_t>(forest_.edges.size()); k-- > 0;)
        {
            if (!in_tree_[k]) continue;
            const RatioEdge& edge = forest_.edges[k];
            links_[--links_of_[edge.driver]] = {k, edge.driven};
            links_[--links_of_[edge.driven]] = {k, edge.driver};
        }
    }

    std::span<const Link> links(std::uint32_t shaft) const
    {
        return {links_.data() + links_of_[shaft], links_of_[shaft + 1] - links_of_[shaft]};
    }

    // Shafts with links: prescribed ones first, then by rank. Ranks are small numbers that are all different, so none need be compared.
    std::vector<std::uint32_t> root_candidates() const
    {
        std::vector<std::uint32_t> at_rank, out;
        for (std::uint32_t i = 0; i < prescribed_.size(); ++i)
        {
            if (links(i).empty()) continue;
            const std::uint32_t rank = directory_.rank_of_shaft(i);
            if (rank >= at_rank.size()) at_rank.resize(rank + std::size_t{1}, kNoIndex);
            at_rank[rank] = i;
        }
        for (const bool prescribed : {true, false})
            for (const std::uint32_t i : at_rank)
                if (i != kNoIndex && (prescribed_[i] != 0) == prescribed) out.push_back(i);
        return out;
    }

    // Breadth first, so parents come before children.
    void grow_tree(std::uint32_t root)
    {
        auto& nodes = forest_.nodes;
        const auto begin = static_cast<std::uint32_t>(nodes.size());
        forest_.tree_begin.push_back(begin);
        position_[root] = begin;
        nodes.push_back({root, begin, kNoIndex, {}});
        for (std::uint32_t at = begin; at < nodes.size(); ++at)
            for (const Link& link : links(nodes[at].shaft))
                if (position_[link.other] == kNoIndex) add_child(root, at, link);
    }

    void add_child(std::uint32_t root, std::uint32_t parent, const Link& link)
    {
        const RatioEdge& edge = forest_.edges[link.edge];
        const ExactRatio step = edge.driven == link.other ? edge.ratio : edge.ratio.inverse();
        const ExactRatio ratio = forest_.nodes[parent].ratio * step;
        if (std::abs(ratio.exponent()) > kLargestExponent)
            refuse(edge.component, "makes " + directory_.shaft_id(link.other) + " turn " + ratio.text() + " times per turn of " +
                                       directory_.shaft_id(root) + "; must be between 2^-400 and 2^400");
        if (prescribed_[link.other] != 0)
            refuse(edge.component, "joins " + directory_.shaft_id(root) + " and " + directory_.shaft_id(link.other) +
                                       ", but the motion of both is prescribed; at most one may be");
        position_[link.other] = static_cast<std::uint32_t>(forest_.nodes.size());
        forest_.nodes.push_back({link.other, parent, link.edge, ratio});
    }

    void close_loop(std::uint32_t e)
    {
        const RatioEdge& edge = forest_.edges[e];
        const std::uint32_t from = position_[edge.driven];
        const std::uint32_t to = position_[edge.driver];
        const ExactRatio around = forest_.nodes[to].ratio * edge.ratio * forest_.nodes[from].ratio.inverse();
        if (around.same(ExactRatio{}, kLoopTolerance))
            forest_.redundant.push_back(e);
        else
            refuse(edge.component, "contradiction: the loop " + path_text(from, to) + directory_.component_id(edge.component) +
                                       " multiplies to " + around.text() + ", must be 1; change a factor or remove one of them");
    }

    // "g1 -> g2 -> ": the edges between two nodes by way of their common ancestor.
    std::string path_text(std::uint32_t from, std::uint32_t to) const
    {
        const auto& nodes = forest_.nodes;
        std::vector<std::uint32_t> up, down;
        while (from != to)
        {
            // In breadth-first order, the later node is never an ancestor of the other.
            const bool climb_from = from > to;
            std::uint32_t& at = climb_from ? from : to;
            (climb_from ? up : down).push_back(nodes[at].edge);
            at = nodes[at].parent;
        }
        up.insert(up.end(), down.rbegin(), down.rend());
        std::string out;
        for (const std::uint32_t e : up) out += directory_.component_id(forest_.edges[e].component) + " -> ";
        return out;
    }

    std::span<const std::uint8_t> prescribed_;
    const ShaftDirectory& directory_;
    RatioForest forest_;
    Errors errors_;
    std::vector<std::uint8_t> in_tree_;    // by edge
    std::vector<std::uint32_t> position_;  // by shaft, in nodes
    std::vector<std::uint32_t> links_of_;  // by shaft, begin in links_
    std::vector<Link> links_;
};

}  // namespace

Result<RatioForest> grow_ratio_forest(std::vector<RatioEdge> edges, std::span<const std::uint8_t> prescribed,
                                      const ShaftDirectory& directory)
{
    return Grower(std::move(edges), prescribed, directory).run();
}

}  // namespace plab::simulation
