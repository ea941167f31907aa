// Small blocks that are not Eigen's: what Eigen's would lose is time.
#include "linear/ldlt3.h"
#include "linear/sparse_blocks.h"
#include "mechanism.h"
#include "plab/eigen.h"
#include "support/shortest.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

using namespace plab;
using plab::test::shortest;

namespace
{

constexpr int kBlocks = 200;

double number(int i) { return std::sin(1.0 + 12.9898 * i); }

/// M + J^T J for some J, which is positive definite.
template <int N>
Eigen::Matrix<double, N, N> positive(int seed)
{
    Eigen::Matrix<double, N, N> j;
    for (int i = 0; i < N * N; ++i) j.data()[i] = number(seed * N * N + i);
    Eigen::Matrix<double, N, N> a = j.transpose() * j;
    a.diagonal().array() += 0.1;
    return a;
}

std::array<double, 6> lower(const Eigen::Matrix3d& a) { return {a(0, 0), a(1, 0), a(1, 1), a(2, 0), a(2, 1), a(2, 2)}; }

}  // namespace

TEST_CASE("Ldlt3 solves for 1, 2 and 3 unknowns as Eigen's LDLT does")
{
    for (int seed = 0; seed < kBlocks; ++seed)
        for (int n = 1; n <= 3; ++n)
        {
            const Eigen::Matrix3d a = positive<3>(seed);
            linear::Ldlt3 ours;
            ours.factor(lower(a), static_cast<std::size_t>(n));
            std::array<double, 3> x{1, -2, 3};
            ours.solve(x, static_cast<std::size_t>(n));
            const Eigen::MatrixXd part = a.topLeftCorner(n, n);
            const Eigen::VectorXd theirs = part.ldlt().solve(Eigen::Vector3d(1, -2, 3).head(n));
            for (int i = 0; i < n; ++i) CHECK(x[static_cast<std::size_t>(i)] == doctest::Approx(theirs[i]).epsilon(1e-11));
            for (int i = n; i < 3; ++i) CHECK(x[static_cast<std::size_t>(i)] == std::array<double, 3>{1, -2, 3}[static_cast<std::size_t>(i)]);
        }
}

#ifdef PLAB_TIMES_MEAN_SOMETHING
TEST_CASE("3 x 3: Eigen's LDLT takes more than twice the time of Ldlt3")
{
    std::vector<Eigen::Matrix3d> matrices;
    for (int i = 0; i < kBlocks; ++i) matrices.push_back(positive<3>(i));
    double sum = 0;
    const double theirs = shortest([&] {
        for (const Eigen::Matrix3d& a : matrices) sum += a.ldlt().solve(Eigen::Vector3d(1, 2, 3))[0];
    });
    const double ours = shortest([&] {
        for (const Eigen::Matrix3d& a : matrices)
        {
            linear::Ldlt3 factors;
            factors.factor(lower(a), 3);
            std::array<double, 3> x{1, 2, 3};
            factors.solve(x, 3);
            sum -= x[0];
        }
    });
    CAPTURE(theirs / kBlocks * 1e9);
    CAPTURE(ours / kBlocks * 1e9);
    CHECK(std::isfinite(sum));
    CHECK(theirs > 2 * ours);
}

TEST_CASE("6 x 6: Eigen's inverse takes longer than that of a general block")
{
    const linear::SparseNode node{6, false, false};
    linear::SparseBlocks blocks(linear::SparseBlocks::Kind::General);
    const std::vector<linear::SparseNode> nodes(kBlocks, node);
    blocks.analyse(nodes, {});
    std::vector<Eigen::Matrix<double, 6, 6>> matrices;
    for (int i = 0; i < kBlocks; ++i) matrices.push_back(positive<6>(i));
    const auto fill = [&] {
        for (std::uint32_t i = 0; i < kBlocks; ++i) std::copy_n(matrices[i].data(), 36, blocks.diagonal(i));
    };
    std::vector<Eigen::Matrix<double, 6, 6>> out(matrices.size());
    const double theirs = shortest([&] {
        fill();
        for (std::size_t i = 0; i < matrices.size(); ++i) out[i] = matrices[i].inverse();
    });
    bool regular = true;
    const double ours = shortest([&] { fill(), regular = blocks.factor() && regular; });
    CAPTURE(theirs / kBlocks * 1e9);
    CAPTURE(ours / kBlocks * 1e9);
    REQUIRE(regular);
    // A general block is stored row by row and is symmetric here, so both are the same numbers.
    for (std::uint32_t i = 0; i < kBlocks; ++i) CHECK(blocks.diagonal(i)[7] == doctest::Approx(out[i](1, 1)).epsilon(1e-9));
    CHECK(theirs > 1.2 * ours);
}
#endif
