#include "simulation/shafts/exact_ratio.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

namespace plab::simulation
{
namespace
{

constexpr Int128 kWordMax = std::numeric_limits<std::int64_t>::max();

Int128 magnitude(Int128 a) { return a < 0 ? -a : a; }

// Euclid's algorithm. 128-bit division is slow, so it switches to 64 bits as soon as both numbers fit.
Int128 gcd(Int128 a, Int128 b)
{
    a = magnitude(a), b = magnitude(b);
    while (b != 0 && (a > kWordMax || b > kWordMax))
    {
        const Int128 rest = a % b;
        a = b, b = rest;
    }
    if (b == 0) return a;
    return std::gcd(static_cast<std::int64_t>(a), static_cast<std::int64_t>(b));
}

// Symmetric range only: the most negative number has no positive counterpart.
std::optional<Int128> product(Int128 a, Int128 b)
{
    Int128 r = 0;
    if (__builtin_mul_overflow(a, b, &r)) return {};
    constexpr Int128 lowest = static_cast<Int128>(static_cast<unsigned __int128>(1) << 127);
    if (r == lowest) return {};
    return r;
}

std::string digits(Int128 a)
{
    if (a == 0) return "0";
    std::string out;
    for (Int128 rest = magnitude(a); rest > 0; rest /= 10) out.push_back(static_cast<char>('0' + static_cast<int>(rest % 10)));
    if (a < 0) out.push_back('-');
    std::reverse(out.begin(), out.end());
    return out;
}

}  // namespace

ExactRatio ExactRatio::rational(Int128 numerator, Int128 denominator)
{
    const Int128 common = gcd(numerator, denominator);
    ExactRatio r;
    r.numerator_ = (denominator < 0 ? -numerator : numerator) / common;
    r.denominator_ = magnitude(denominator) / common;
    return r;
}

ExactRatio ExactRatio::inexact(double mantissa, int exponent)
{
    ExactRatio r;
    int shift = 0;
    r.scaled_.mantissa = std::frexp(mantissa, &shift);
    r.scaled_.exponent = exponent + shift;
    r.exact_ = false;
    return r;
}

std::optional<ExactRatio> ExactRatio::from(const Ratio& ratio)
{
    if (ratio.exact)
    {
        if (ratio.numerator == 0 || ratio.denominator == 0) return {};
        return rational(ratio.numerator, ratio.denominator);
    }
    if (ratio.value == 0 || !std::isfinite(ratio.value)) return {};
    return inexact(ratio.value, 0);
}

ExactRatio::Scaled ExactRatio::scaled() const
{
    if (!exact_) return scaled_;
    Scaled s;
    s.mantissa = std::frexp(static_cast<double>(numerator_) / static_cast<double>(denominator_), &s.exponent);
    return s;
}

double ExactRatio::value() const
{
    const Scaled s = scaled();
    return std::ldexp(s.mantissa, s.exponent);
}

int ExactRatio::exponent() const { return scaled().exponent; }

ExactRatio ExactRatio::inverse() const
{
    if (exact_) return rational(denominator_, numerator_);
    return inexact(1.0 / scaled_.mantissa, -scaled_.exponent);
}

ExactRatio operator*(const ExactRatio& a, const ExactRatio& b)
{
    if (a.is_one() || b.is_one()) return a.is_one() ? b : a;
    if (a.exact_ && b.exact_)
    {
        // Cancel common factors crosswise first: the product is then in lowest terms, and overflows only if the result does not fit.
        const Int128 g = gcd(a.numerator_, b.denominator_);
        const Int128 h = gcd(b.numerator_, a.denominator_);
        const auto numerator = product(a.numerator_ / g, b.numerator_ / h);
        const auto denominator = product(a.denominator_ / h, b.denominator_ / g);
        if (numerator && denominator) return ExactRatio::rational(*numerator, *denominator);
    }
    const ExactRatio::Scaled p = a.scaled();
    const ExactRatio::Scaled q = b.scaled();
    return ExactRatio::inexact(p.mantissa * q.mantissa, p.exponent + q.exponent);
}

bool ExactRatio::same(const ExactRatio& other, double tolerance) const
{
    if (exact_ && other.exact_) return numerator_ == other.numerator_ && denominator_ == other.denominator_;
    const Scaled p = scaled();
    const Scaled q = other.scaled();
    return std::fabs(std::ldexp(q.mantissa, q.exponent - p.exponent) - p.mantissa) <= tolerance * std::fabs(p.mantissa);
}

std::string ExactRatio::text() const
{
    char number[40];
    const Scaled s = scaled();
    if (s.exponent > -1000 && s.exponent < 1000)
        std::snprintf(number, sizeof number, "%.15g", value());
    else
        std::snprintf(number, sizeof number, "%.15g * 2^%d", s.mantissa, s.exponent);
    if (!exact_ || denominator_ == 1) return number;
    return std::string(number) + " (" + digits(numerator_) + "/" + digits(denominator_) + ")";
}

}  // namespace plab::simulation
