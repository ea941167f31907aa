#include "matrix_exponential.h"

#include <algorithm>
#include <cmath>

#include "linear/dense_view.h"

namespace plab::solvers
{
namespace
{

using linear::multiply, linear::view, linear::DenseMatrix, linear::DenseVector;

constexpr double kTaylorReach = 0.7;  // 0.7^17 / 17! is below 1e-17
constexpr int kMostSquarings = 60;

/// Not finite where an element is not.
double norm_of_rows(const SquareMatrix<double>& a)
{
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        double sum = 0;
        for (std::size_t j = 0; j < a.size(); ++j) sum += std::fabs(a(i, j));
        if (!(sum <= most)) most = sum;
    }
    return most;
}

// Gauss-Legendre on [-1, 1], the positive half; Abramowitz and Stegun, table 25.4.
constexpr double kNode8[4] = {0.183434642495649804939476, 0.525532409916328985817739, 0.796666477413626739591554,
                              0.960289856497536231683561};
constexpr double kWeight8[4] = {0.362683783378361982965150, 0.313706645877887287337962, 0.222381034453374470544356,
                                0.101228536290376259152531};
constexpr int kPowers = 17;

using VectorView = Eigen::Map<Eigen::VectorXd>;

VectorView column_of(std::vector<double>& numbers, std::size_t from, std::size_t count)
{
    return VectorView(numbers.data() + from, static_cast<Eigen::Index>(count));
}

}  // namespace

void MatrixExponential::balance()
{
    const std::size_t n = a_.size();
    scale_.assign(n, 1.0);
    bool changed = true;
    for (int sweep = 0; sweep < 30 && changed; ++sweep)
    {
        changed = false;
        for (std::size_t i = 0; i < n; ++i)
        {
            double column = 0, row = 0;
            for (std::size_t j = 0; j < n; ++j)
                if (j != i) column += std::fabs(a_(j, i)), row += std::fabs(a_(i, j));
            if (!(column > 0) || !(row > 0) || !std::isfinite(column + row)) continue;
            const double f = std::exp2(std::round(0.5 * std::log2(row / column)));
            if (column * f + row / f >= 0.95 * (column + row)) continue;
            changed = true;
            scale_[i] *= f;
            for (std::size_t j = 0; j < n; ++j)
                if (j != i) a_(j, i) *= f, a_(i, j) /= f;
        }
    }
}

/// sum_ = sum of a_^k / k!, k = 0 .. 16, in powers of a_^4.
void MatrixExponential::taylor()
{
    multiply(a_, a_, square_);
    multiply(a_, square_, cube_);
    multiply(square_, square_, fourth_);
    double inverse_factorial[17];
    inverse_factorial[0] = 1;
    for (int k = 1; k <= 16; ++k) inverse_factorial[k] = inverse_factorial[k - 1] / k;
    const auto add_block = [&](int first)
    {
        const double* c = inverse_factorial + first;
        view(sum_) += c[1] * view(a_) + c[2] * view(square_) + c[3] * view(cube_);
        view(sum_).diagonal().array() += c[0];
    };
    sum_.resize(a_.size());
    view(sum_) = inverse_factorial[16] * view(fourth_);
    add_block(12);
    for (const int first : {8, 4, 0})
    {
        multiply(fourth_, sum_, spare_);
        std::swap(sum_, spare_);
        add_block(first);
    }
}

/// What has decayed to nothing shall not cost the hundredfold time of denormal numbers.
void MatrixExponential::flush()
{
    for (double& v : sum_.all())
        if (std::fabs(v) < 1e-280) v = 0;
}

bool MatrixExponential::compute()
{
    balance();
    size_ = norm_of_rows(a_);
    if (!std::isfinite(size_)) return false;
    int squarings = kLeastRoots;
    while (squarings < kMostSquarings && std::ldexp(size_, -squarings) > kTaylorReach) ++squarings;
    for (double& v : a_.all()) v = std::ldexp(v, -squarings);
    taylor();
    squarings_ = squarings, base_ = sum_;
    roots_ = std::min(squarings, kMostRoots);
    root_.resize(kMostRoots + 1);
    for (int k = squarings; k >= 0; --k)
    {
        if (k <= roots_) root_[static_cast<std::size_t>(k)] = sum_;
        if (k == 0) break;
        multiply(sum_, sum_, spare_);
        std::swap(sum_, spare_);
        flush();
    }
    return std::isfinite(norm_of_rows(root_[0]));
}

void MatrixExponential::apply(int root, std::span<const double> v, std::span<double> out) const
{
    const SquareMatrix<double>& e = root_[static_cast<std::size_t>(root)];
    const std::size_t n = e.size();
    VectorView sum(out.data(), static_cast<Eigen::Index>(n));
    sum.setZero();
    // By columns: one division for each, and sums that do not wait for one another.
    for (std::size_t j = 0; j < n; ++j) sum += v[j] / scale_[j] * view(e).col(static_cast<Eigen::Index>(j));
    for (std::size_t i = 0; i < n; ++i) out[i] *= scale_[i];
}

/// gram_ = the integral of y y^T over the first 2^-squarings of the time, y by its Taylor series at Gauss' nodes: of degree 15 in
/// A, so right to rounding for |A| below 0.7.
void MatrixExponential::start_gram(std::size_t constant)
{
    const std::size_t n = a_.size();
    powers_.assign(kPowers * n, 0.0);
    powers_[constant] = 1 / scale_[constant];
    for (std::size_t k = 1; k < kPowers; ++k)
    {
        VectorView power = column_of(powers_, k * n, n);
        power.noalias() = view(a_) * column_of(powers_, (k - 1) * n, n);
        power /= static_cast<double>(k);
    }
    gram_.resize(n);
    view(gram_).setZero();
    left_.resize(n);
    for (int node = 0; node < 8; ++node)
    {
        const double theta = 0.5 * (1 + (node < 4 ? kNode8[node] : -kNode8[node - 4])), weight = 0.5 * kWeight8[node % 4];
        for (std::size_t i = 0; i < n; ++i)
        {
            double y = 0;
            for (std::size_t k = kPowers; k-- > 0;) y = y * theta + powers_[k * n + i];
            left_[i] = y;
        }
        const VectorView y = column_of(left_, 0, n);
        view(gram_).noalias() += std::ldexp(weight, -squarings_) * y * y.transpose();
    }
}

/// To twice the time: gram_ += E gram_ E^T, E = E E; E in sum_.
void MatrixExponential::double_gram()
{
    wide_.resize(a_.size());
    view(wide_).noalias() = view(gram_) * view(sum_).transpose();
    view(gram_).noalias() += view(sum_) * view(wide_);
    multiply(sum_, sum_, spare_);
    std::swap(sum_, spare_);
    flush();
}

std::size_t MatrixExponential::moments(std::size_t constant, std::size_t count, std::vector<double>& mean, std::vector<double>& spread)
{
    const std::size_t n = a_.size();
    start_gram(constant);
    sum_ = base_;
    for (int k = 0; k < squarings_; ++k) double_gram();
    mean.resize(n);
    for (std::size_t i = 0; i < n; ++i) mean[i] = gram_(i, constant) * scale_[constant];
    // Of components that hardly vary the variance is rounding.
    left_.resize(n);
    for (std::size_t i = 0; i < n; ++i) left_[i] = 1e-15 * gram_(i, i);
    const VectorView of_mean = column_of(mean, 0, n);
    view(gram_).noalias() -= of_mean * of_mean.transpose();
    const std::size_t rank = factorise_covariance(constant, count, spread);
    for (std::size_t i = 0; i < n; ++i) mean[i] *= scale_[i];
    return rank;
}

/// Cholesky's factors with pivots, in spread, as long as something is left of a variance.
std::size_t MatrixExponential::factorise_covariance(std::size_t constant, std::size_t count, std::vector<double>& spread)
{
    const std::size_t n = a_.size();
    std::size_t rank = 0;
    spread.clear();
    for (std::size_t i = 0; i < n; ++i) left_[i] = std::fmax(left_[i], 1e-13 * gram_(i, i));
    for (; rank < count; ++rank)
    {
        std::size_t best = n;
        double most = 1;
        for (std::size_t i = 0; i < count; ++i)
            if (i != constant && gram_(i, i) > most * left_[i]) best = i, most = gram_(i, i) / left_[i];
        if (best == n) break;
        const double root = std::sqrt(gram_(best, best));
        spread.resize((rank + 1) * n, 0.0);
        VectorView column = column_of(spread, rank * n, count);
        for (std::size_t i = 0; i < count; ++i) column[static_cast<Eigen::Index>(i)] = i == constant ? 0.0 : gram_(i, best) / root;
        view(gram_).topLeftCorner(column.size(), column.size()).noalias() -= column * column.transpose();
        gram_(best, best) = 0;
    }
    for (std::size_t k = 0; k < rank; ++k)
        for (std::size_t i = 0; i < n; ++i) spread[k * n + i] *= scale_[i];
    return rank;
}

}  // namespace plab::solvers
