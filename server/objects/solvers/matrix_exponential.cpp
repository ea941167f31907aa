#include "matrix_exponential.h"

#include <algorithm>
#include <cmath>

namespace plab::solvers
{
namespace
{

constexpr double kTaylorReach = 0.7;  // 0.7^17 / 17! is below 1e-17
constexpr int kMostSquarings = 60;

double norm_of_rows(const SquareMatrix<double>& a)
{
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        double sum = 0;
        for (const double v : a.row(i)) sum += std::fabs(v);
        if (!(sum <= most)) most = sum;
    }
    return most;
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
    const std::size_t n = a_.size();
    multiply(a_, a_, square_);
    multiply(a_, square_, cube_);
    multiply(square_, square_, fourth_);
    double inverse_factorial[17];
    inverse_factorial[0] = 1;
    for (int k = 1; k <= 16; ++k) inverse_factorial[k] = inverse_factorial[k - 1] / k;
    const auto add_block = [&](int first)
    {
        const double* c = inverse_factorial + first;
        for (std::size_t i = 0; i < n * n; ++i) sum_.all()[i] += c[1] * a_.all()[i] + c[2] * square_.all()[i] + c[3] * cube_.all()[i];
        for (std::size_t i = 0; i < n; ++i) sum_(i, i) += c[0];
    };
    sum_.resize(n);
    for (std::size_t i = 0; i < n * n; ++i) sum_.all()[i] = inverse_factorial[16] * fourth_.all()[i];
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
    for (std::size_t i = 0; i < n; ++i)
    {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += e(i, j) * (v[j] / scale_[j]);
        out[i] = scale_[i] * sum;
    }
}

}  // namespace plab::solvers
