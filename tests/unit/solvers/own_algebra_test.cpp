// Linear algebra of the solvers that is not Eigen's: cases in which Eigen's functions lose digits, or time.
#include "linear/dense_view.h"
#include "objects/solvers/matrix_exponential.h"
#include "support/shortest.h"

#include <doctest/doctest.h>
#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

using namespace plab::linear;
using namespace plab::solvers;

TEST_CASE("LU: Eigen's does not scale rows, and loses all digits if their units differ")
{
    // x = (1, 1). The first row is in small units: its pivot of 1 is the smallest of its row by far.
    Eigen::Matrix2d a;
    a << 1, 1e17, 1, 1;
    const Eigen::Vector2d theirs = a.partialPivLu().solve(Eigen::Vector2d(1e17, 2));
    Factors<double> factors;
    factors.matrix().resize(2);
    view(factors.matrix()) = a;
    REQUIRE(factors.factorise());
    std::vector<double> ours{1e17, 2};
    factors.solve(ours);
    CHECK(theirs[0] == 0);  // should be 1
    CHECK(ours[0] == doctest::Approx(1).epsilon(1e-15));
    CHECK(ours[1] == doctest::Approx(1).epsilon(1e-15));
}

TEST_CASE("exp(A): Eigen's does not balance, and loses digits if units differ")
{
    // A rotation by 1 rad between a position and a speed whose units are 1e12 apart: cos(1) on the diagonal.
    Eigen::Matrix2d a;
    a << 0, 1e12, -1e-12, 0;
    const Eigen::Matrix2d theirs = a.exp();
    MatrixExponential ours;
    ours.matrix().resize(2);
    view(ours.matrix()) = a;
    REQUIRE(ours.compute());
    const std::vector<double> v{1, 0};
    std::vector<double> out(2);
    ours.apply(0, v, out);
    CHECK(std::fabs(out[0] - std::cos(1.0)) < 1e-15);
    CHECK(std::fabs(theirs(0, 0) - std::cos(1.0)) > 1e-8);
}

#ifdef PLAB_TIMES_MEAN_SOMETHING
TEST_CASE("Eigen's product computes with zeros, and takes longer for the Jacobian of a chain")
{
    // The links of a chain are coupled to their neighbours only: a band of blocks of 12.
    constexpr int kSize = 240, kBand = 18;
    SquareMatrix<double> a, out;
    a.resize(kSize), out.resize(kSize);
    for (int i = 0; i < kSize; ++i)
        for (int j = 0; j < kSize; ++j) view(a)(i, j) = std::abs(i - j) < kBand ? 1.0 / (1 + i + 2 * j) : 0;
    Eigen::MatrixXd product(kSize, kSize);
    const double theirs = plab::test::shortest([&] { product.noalias() = view(a) * view(a); });
    const double ours = plab::test::shortest([&] { multiply(a, a, out); });
    CAPTURE(theirs);
    CAPTURE(ours);
    CHECK((product - view(out)).cwiseAbs().maxCoeff() < 1e-14);
    CHECK(theirs > 1.3 * ours);
}
#endif
