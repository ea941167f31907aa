/// Ratios between shafts, exact while numerator and denominator fit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "plab/shafts.h"

namespace plab::simulation
{

__extension__ typedef __int128 Int128;

/// A factor other than 0: a fraction in lowest terms while it fits 128 bits, otherwise a mantissa and a power of two, so that the product
/// along any chain of gears stays comparable.
class ExactRatio
{
public:
    /// The ratio 1.
    ExactRatio() = default;
    /// Nothing if the factor is zero, infinite or not a number.
    static std::optional<ExactRatio> from(const Ratio& ratio);

    bool exact() const { return exact_; }
    /// Correctly rounded if numerator and denominator are below 2^53, else within 2 units of the last place. May overflow; see
    /// exponent().
    double value() const;
    /// e with 2^(e-1) <= |value| < 2^e.
    int exponent() const;
    ExactRatio inverse() const;
    friend ExactRatio operator*(const ExactRatio& a, const ExactRatio& b);
    /// Exact comparison if both are exact; otherwise to the relative `tolerance`.
    bool same(const ExactRatio& other, double tolerance) const;
    /// "0.999983333611106 (60000/60001)".
    std::string text() const;

private:
    struct Scaled
    {
        double mantissa = 0.5;  // 0.5 <= |mantissa| < 1
        int exponent = 1;
    };
    bool is_one() const { return exact_ && numerator_ == 1 && denominator_ == 1; }
    static ExactRatio rational(Int128 numerator, Int128 denominator);
    static ExactRatio inexact(double mantissa, int exponent);
    Scaled scaled() const;

    Int128 numerator_ = 1;
    Int128 denominator_ = 1;  // > 0
    Scaled scaled_;           // where not exact
    bool exact_ = true;
};

}  // namespace plab::simulation
