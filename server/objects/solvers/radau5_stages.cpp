#include "radau5_stages.h"

#include <algorithm>
#include <cmath>

namespace plab::solvers::radau
{
namespace
{

// Eigenvalues of the inverse of the method's matrix (one real, one pair) and the transformation to them: the program RADAU5.
constexpr double kCbrt9 = 2.080083823051904114530057;
constexpr double kSqrt3 = 1.732050807568877293527446;
constexpr double kGamma = 30 / (6 + kCbrt9 * (kCbrt9 - 1));
constexpr double kAlphaRaw = (12 - kCbrt9 * (kCbrt9 - 1)) / 60, kBetaRaw = kCbrt9 * (kCbrt9 + 1) * kSqrt3 / 60;
constexpr double kModulus = kAlphaRaw * kAlphaRaw + kBetaRaw * kBetaRaw;
constexpr double kAlpha = kAlphaRaw / kModulus, kBeta = kBetaRaw / kModulus;

constexpr double kT[3][3] = {
    {9.1232394870892942792e-2, -0.14125529502095420843, -3.0029194105147424492e-2},
    {0.24171793270710701896, 0.20412935229379993199, 0.38294211275726193779},
    {0.96604818261509293619, 1, 0},
};
constexpr double kInverseT[3][3] = {
    {4.3255798900631553510, 0.33919925181580986954, 0.54177053993587487119},
    {-4.1787185915519047273, -0.32768282076106238708, 0.47662355450055045196},
    {-0.50287263494578687595, 2.5719269498556054292, -0.59603920482822492497},
};
constexpr double kErrorWeight[3] = {-(13 + 7 * kSqrt6) / 3, (-13 + 7 * kSqrt6) / 3, -1.0 / 3};

}  // namespace

bool RadauStages::factorise(double h)
{
    const std::size_t n = flat_.size();
    m_.real.matrix().resize(n), m_.complex.matrix().resize(n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
        {
            const double a = -m_.jacobian(i, j);
            m_.real.matrix()(i, j) = i == j ? a + kGamma / h : a;
            m_.complex.matrix()(i, j) = i == j ? Complex{a + kAlpha / h, kBeta / h} : Complex{a, 0};
        }
    const auto stop = [this] { return flat_.interrupted(); };
    return m_.real.factorise(stop) && m_.complex.factorise(stop);
}

void RadauStages::predict(double h, double previous)
{
    const std::size_t n = flat_.size();
    for (std::size_t i = 0; i < n; ++i)
    {
        for (std::size_t s = 0; s < 3; ++s)
        {
            // The polynomial of the last step in Newton's form, with nodes 1, c2, c1 seen from its end.
            const double c = previous > 0 ? kNode[s] * h / previous : 0;
            m_.z[s][i] =
                c * (m_.polynomial[0][i] + (c - (kNode[1] - 1)) * (m_.polynomial[1][i] + (c - (kNode[0] - 1)) * m_.polynomial[2][i]));
            if (previous == 0) m_.z[s][i] = 0;
        }
        for (std::size_t s = 0; s < 3; ++s)
            m_.w[s][i] = kInverseT[s][0] * m_.z[0][i] + kInverseT[s][1] * m_.z[1][i] + kInverseT[s][2] * m_.z[2][i];
    }
}

/// One Newton step: adds to w, and z follows. Leaves the increments of w in f.
void RadauStages::correct(double h)
{
    const std::size_t n = flat_.size();
    for (std::size_t i = 0; i < n; ++i)
    {
        const double f[3] = {m_.f[0][i], m_.f[1][i], m_.f[2][i]};
        double r[3];
        for (std::size_t s = 0; s < 3; ++s) r[s] = kInverseT[s][0] * f[0] + kInverseT[s][1] * f[1] + kInverseT[s][2] * f[2];
        m_.f[0][i] = r[0] - kGamma / h * m_.w[0][i];
        m_.pair[i] = {r[1] - (kAlpha * m_.w[1][i] - kBeta * m_.w[2][i]) / h, r[2] - (kAlpha * m_.w[2][i] + kBeta * m_.w[1][i]) / h};
    }
    m_.real.solve(m_.f[0]);
    m_.complex.solve(m_.pair);
    for (std::size_t i = 0; i < n; ++i)
    {
        m_.f[1][i] = m_.pair[i].real(), m_.f[2][i] = m_.pair[i].imag();
        for (std::size_t s = 0; s < 3; ++s) m_.w[s][i] += m_.f[s][i];
        for (std::size_t s = 0; s < 3; ++s) m_.z[s][i] = kT[s][0] * m_.w[0][i] + kT[s][1] * m_.w[1][i] + kT[s][2] * m_.w[2][i];
    }
}

NewtonResult RadauStages::solve(double t, double h, double limit)
{
    NewtonResult out;
    double rate = std::pow(std::max(last_contraction_, 1e-16), 0.8), before = 0;
    for (int k = 0; k < kNewtonIterations; ++k)
    {
        ++out.iterations;
        for (std::size_t s = 0; s < 3; ++s)
        {
            for (std::size_t i = 0; i < m_.y.size(); ++i) m_.work[i] = m_.y[i] + m_.z[s][i];
            flat_.evaluate(t + kNode[s] * h, m_.work, m_.f[s]);
        }
        correct(h);
        const double size =
            std::max({FlatSystem::norm(m_.f[0], m_.scale), FlatSystem::norm(m_.f[1], m_.scale), FlatSystem::norm(m_.f[2], m_.scale)});
        if (!std::isfinite(size)) return out.finite = false, out;
        if (k > 0)
        {
            const double quotient = size / before;
            out.contraction = k == 1 ? quotient : std::sqrt(quotient * out.contraction);
            if (out.contraction >= 0.99) return out;
            rate = out.contraction / (1 - out.contraction);
            // What is left after the iterations that remain: too much already?
            const double left = rate * size * std::pow(out.contraction, kNewtonIterations - 2 - k) / limit;
            if (left >= 1 && k < kNewtonIterations - 1)
            {
                const double bounded = std::clamp(left, 1e-4, 20.0);
                out.shrink = 0.8 * std::pow(bounded, -1.0 / (4 + kNewtonIterations - 2 - k));
                return out;
            }
        }
        before = std::max(size, 1e-300);
        if (size == 0 || rate * size <= limit)
        {
            last_contraction_ = rate;
            return out.converged = true, out;
        }
    }
    return out;
}

double RadauStages::error(double t, double h, bool careful)
{
    const std::size_t n = flat_.size();
    for (std::size_t i = 0; i < n; ++i)
    {
        m_.filtered[i] = (kErrorWeight[0] * m_.z[0][i] + kErrorWeight[1] * m_.z[1][i] + kErrorWeight[2] * m_.z[2][i]) / h;
        m_.error[i] = m_.filtered[i] + m_.f0[i];
    }
    m_.real.solve(m_.error);
    const double once = FlatSystem::norm(m_.error, m_.scale);
    if (once < 1 || !careful) return once;
    for (std::size_t i = 0; i < n; ++i) m_.work[i] = m_.y[i] + m_.error[i];
    flat_.evaluate(t, m_.work, m_.other);
    for (std::size_t i = 0; i < n; ++i) m_.error[i] = m_.other[i] + m_.filtered[i];
    m_.real.solve(m_.error);
    return FlatSystem::norm(m_.error, m_.scale);
}

void RadauStages::keep_polynomial()
{
    for (std::size_t i = 0; i < flat_.size(); ++i)
    {
        const double z1 = m_.z[0][i], z2 = m_.z[1][i], z3 = m_.z[2][i];
        m_.polynomial[0][i] = (z2 - z3) / (kNode[1] - 1);
        const double slope = (z1 - z2) / (kNode[0] - kNode[1]);
        m_.polynomial[1][i] = (slope - m_.polynomial[0][i]) / (kNode[0] - 1);
        m_.polynomial[2][i] = m_.polynomial[1][i] - (slope - z1 / kNode[0]) / kNode[1];
    }
}

}  // namespace plab::solvers::radau
