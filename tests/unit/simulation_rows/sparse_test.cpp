// The block factorisation alone, and the cost of the equations.
#include <algorithm>

#include "mechanism.h"
#include "plab/eigen.h"

#include <Eigen/SparseCholesky>

using namespace plab;
using namespace plab::test;
using linear::SparseBlocks;
using linear::SparseEdge;
using linear::SparseNode;

namespace
{

/// K x - b for a matrix given by blocks, with x from the factorisation.
double residual(const std::vector<SparseNode>& nodes, const std::vector<SparseEdge>& edges)
{
    SparseBlocks ldlt;
    ldlt.analyse(nodes, edges);
    ldlt.clear();
    const std::size_t n = ldlt.unknowns();
    std::vector<std::vector<double>> k(n, std::vector<double>(n, 0));
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
        for (std::uint32_t r = 0; r < nodes[i].size && !nodes[i].negative; ++r)
            k[ldlt.offset(i) + r][ldlt.offset(i) + r] = ldlt.diagonal(i)[r * (nodes[i].size + 1)] = 1 + r + i;
    for (std::uint32_t e = 0; e < edges.size(); ++e)
        for (std::uint32_t r = 0; r < nodes[edges[e].a].size; ++r)
            for (std::uint32_t c = 0; c < nodes[edges[e].b].size; ++c)
            {
                const double value = std::sin(1.0 + 7 * e + 3 * r + c * r + c);
                ldlt.add(e, r, c, value);
                const std::size_t row = ldlt.offset(edges[e].a) + r, column = ldlt.offset(edges[e].b) + c;
                k[row][column] = k[column][row] = value;
            }
    REQUIRE(ldlt.factor());
    std::vector<double> x(n), b(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = b[i] = std::cos(static_cast<double>(i));
    ldlt.solve(x);
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
        double sum = -b[i];
        for (std::size_t j = 0; j < n; ++j) sum += k[i][j] * x[j];
        worst = std::fmax(worst, std::fabs(sum));
    }
    return worst;
}

}  // namespace

TEST_CASE("blocks of all sizes, in trees and in loops")
{
    // Joints of 5, 3, 1, 2 and 4 rows over bodies and a shaft.
    std::vector<SparseNode> nodes{{6, false, false}, {6, false, false}, {6, false, false}, {1, false, false},
                                  {5, true, true},   {3, true, true},   {1, true, true}};
    std::vector<SparseEdge> edges{{4, 0}, {4, 1}, {5, 1}, {5, 2}, {6, 2}, {6, 3}};
    CHECK(residual(nodes, edges) < 1e-13);
    nodes.push_back({2, true, false}), nodes.push_back({4, true, false});
    for (std::uint32_t j : {4u, 5u, 6u}) nodes[j].early = false;
    edges.insert(edges.end(), {{7, 0}, {7, 2}, {8, 0}, {8, 1}, {8, 2}});
    CHECK(residual(nodes, edges) < 1e-11);
}

TEST_CASE("a chain has no fill-in, whatever the numbers of its nodes")
{
    constexpr std::uint32_t n = 50;
    std::vector<SparseNode> nodes(2 * n);
    std::vector<SparseEdge> edges;
    for (std::uint32_t i = 0; i < n; ++i)
    {
        nodes[i] = {6, false, false}, nodes[n + i] = {3, true, true};
        const auto link = [](std::uint32_t k) { return (k * 17) % n; };
        edges.push_back({n + i, link(i)});
        if (i > 0) edges.push_back({n + i, link(i - 1)});
    }
    SparseBlocks ldlt;
    ldlt.analyse(nodes, edges);
    CHECK(ldlt.blocks() == edges.size());
    CHECK(residual(nodes, edges) < 1e-11);
}

TEST_CASE("a joint's block that other joints imply is raised and flagged")
{
    SparseBlocks ldlt;
    const std::vector<SparseNode> nodes{{6, false, false}, {1, true, false}, {1, true, false}};
    ldlt.analyse(nodes, std::vector<SparseEdge>{{1, 0}, {2, 0}});
    ldlt.clear();
    for (std::uint32_t r = 0; r < 6; ++r) ldlt.diagonal(0)[7 * r] = 2;
    ldlt.add(0, 0, 1, 1.0), ldlt.add(1, 0, 1, 1.0);
    for (const std::uint32_t j : {1u, 2u}) ldlt.set_floor(ldlt.offset(j), 1e-12, 1e-9);
    REQUIRE(ldlt.factor());
    CHECK(ldlt.small()[ldlt.offset(1)] + ldlt.small()[ldlt.offset(2)] == 1);
}

TEST_CASE("Eigen's sparse factorisation fails where a joint's row is implied by another; a raised pivot does not")
{
    // A body of 2 kg, which two equal rows along x hold against 3 N. Unknowns: its acceleration and one multiplier for each row.
    Eigen::SparseMatrix<double> k(3, 3);
    k.insert(0, 0) = 2, k.insert(1, 0) = k.insert(2, 0) = 1, k.insert(1, 1) = k.insert(2, 2) = 0;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> theirs(k);
    CHECK(theirs.info() == Eigen::NumericalIssue);

    SparseBlocks ours;
    ours.analyse(std::vector<SparseNode>{{1, false, false}, {2, true, false}}, std::vector<SparseEdge>{{1, 0}});
    ours.clear();
    ours.diagonal(0)[0] = 2;
    ours.add(0, 0, 0, 1.0), ours.add(0, 1, 0, 1.0);
    for (const std::uint32_t u : {1u, 2u}) ours.set_floor(u, 1e-12, 1e-9);
    REQUIRE(ours.factor());
    CHECK(ours.small()[1] == 0);
    CHECK(ours.small()[2] == 1);
    std::vector<double> x{3, 0, 0};
    ours.solve(x);
    CHECK(std::fabs(x[0]) < 1e-9);
    CHECK(x[1] + x[2] == doctest::Approx(3));
}
