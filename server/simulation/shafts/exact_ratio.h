/// Factors between shafts, exact while they can be.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "plab/shafts.h"

namespace plab::simulation
{

__extension__ typedef __int128 Int128;

/// A factor other than 0: sign x numerator / denominator in lowest terms while that fits 128 bits, else a mantissa and
/// a power of two, so that no chain of gears leaves the range that can be compared.
class ExactRatio
{
public:
    /// 1.
    ExactRatio() = default;
    /// Nothing for a factor that is zero, infinite or not a number.
    static std::optional<ExactRatio> from(const Ratio& ratio);

    bool exact() const { return exact_; }
    /// Rounded once where numerator and denominator are below 2^53, else within 2 units of the last place. May
    /// overflow; see exponent().
    double value() const;
    /// e with 2^(e-1) <= |value| < 2^e.
    int exponent() const;
    ExactRatio inverse() const;
    friend ExactRatio operator*(const ExactRatio& a, const ExactRatio& b);
    /// Exactly, if both are exact; else to `tolerance`, relative.
    bool same(const ExactRatio& other, double tolerance) const;
    /// "0.999983333611106 (60000/60001)".
    std::string text() const;

private:
    struct Scaled
    {
        double mantissa = 0.5;  // 0.5 <= |mantissa| < 1
        int exponent = 1;
    };
    static ExactRatio rational(Int128 numerator, Int128 denominator);
    static ExactRatio inexact(double mantissa, int exponent);
    Scaled scaled() const;

    Int128 numerator_ = 1;
    Int128 denominator_ = 1;  // > 0
    Scaled scaled_;           // where not exact
    bool exact_ = true;
};

}  // namespace plab::simulation
