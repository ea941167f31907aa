/// Step lengths as exact fractions, so that t = n dt is rounded once and 1/240 s never drifts.

#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "model/numbers.h"
#include "model/text.h"
#include "model/units.h"
#include "model/values.h"

namespace plab::model
{

namespace
{

/// Shorter steps are dominated by rounding, longer ones are typing errors.
constexpr double kShortestStep = 1e-9;  // s
constexpr double kLongestStep = 3600;   // s
/// n * numerator must fit 64 bits for any n that a run can reach (9e10 steps).
constexpr std::int64_t kMostNumerator = 100'000'000;
/// Whole numbers up to here are exact as doubles.
constexpr std::int64_t kMostDenominator = std::int64_t{1} << 53;

/// A fraction of whole numbers, reduced; no value once it exceeds 64 bits.
class Fraction
{
public:
    Fraction(std::int64_t numerator, std::int64_t denominator) : numerator_(numerator), denominator_(denominator) { reduce(); }

    void multiply(std::int64_t n, std::int64_t d)
    {
        const Fraction other(n, d);
        // Reduces crosswise, so that the products are as small as possible.
        const std::int64_t g = std::gcd(numerator_, other.denominator_), h = std::gcd(other.numerator_, denominator_);
        lost_ = lost_ || other.lost_ || __builtin_mul_overflow(numerator_ / g, other.numerator_ / h, &numerator_) ||
                __builtin_mul_overflow(denominator_ / h, other.denominator_ / g, &denominator_);
    }
    bool exact() const { return !lost_; }
    std::int64_t numerator() const { return numerator_; }
    std::int64_t denominator() const { return denominator_; }

private:
    void reduce()
    {
        const std::int64_t g = std::gcd(numerator_, denominator_);
        numerator_ /= g;
        denominator_ /= g;
    }
    std::int64_t numerator_, denominator_;
    bool lost_ = false;
};

/// The exact value of a positive decimal such as "0.001" or "1e-3"; empty if it does not fit.
std::optional<Fraction> exact_decimal(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    std::int64_t digits = 0;
    int exponent = 0;
    bool after_point = false;
    std::size_t i = 0;
    for (; i < word.size() && word[i] != 'e' && word[i] != 'E'; ++i)
    {
        if (word[i] == '.')
        {
            after_point = true;
            continue;
        }
        if (!is_digit(word[i]) || __builtin_mul_overflow(digits, std::int64_t{10}, &digits) ||
            __builtin_add_overflow(digits, std::int64_t{word[i] - '0'}, &digits))
            return std::nullopt;
        if (after_point) --exponent;
    }
    int written = 0;
    if (i < word.size())
    {
        std::string_view tail = word.substr(i + 1);
        if (tail.starts_with('+')) tail.remove_prefix(1);
        if (std::from_chars(tail.data(), tail.data() + tail.size(), written).ec != std::errc()) return std::nullopt;
    }
    exponent += written;
    if (digits == 0 || std::abs(exponent) > 18) return std::nullopt;
    std::int64_t power = 1;
    for (int k = 0; k < std::abs(exponent); ++k) power *= 10;
    Fraction out(digits, exponent < 0 ? power : 1);
    if (exponent > 0) out.multiply(power, 1);
    return out;
}

/// The exact fraction of a number and its unit.
std::optional<Fraction> exact_seconds(std::string_view word, const UnitFactor& unit)
{
    const std::size_t slash = word.find('/');
    std::optional<Fraction> out = exact_decimal(word.substr(0, slash));
    if (!out) return std::nullopt;
    if (slash != std::string_view::npos)
    {
        const std::optional<Fraction> divisor = exact_decimal(word.substr(slash + 1));
        if (!divisor || !divisor->exact()) return std::nullopt;
        out->multiply(divisor->denominator(), divisor->numerator());
    }
    if (unit.pi_power != 0) return std::nullopt;
    out->multiply(static_cast<std::int64_t>(unit.numerator), static_cast<std::int64_t>(unit.denominator));
    const bool fits = out->exact() && out->numerator() <= kMostNumerator && out->denominator() <= kMostDenominator;
    return fits ? out : std::nullopt;
}

}  // namespace

Result<StepLength> parse_step_length(std::string_view text)
{
    text = trimmed(text);
    if (text.empty()) return reason("dt is empty: give a time such as 1/240 or 2 ms");
    const std::string_view word = text.substr(0, text.find_first_of(" \t\n\r"));
    Result<double> number = parse_real(word);
    if (!number) return reason("dt: " + number.error().reason);
    UnitFactor factor;
    factor.dimension = unit::second.dimension;
    if (word.size() < text.size())
    {
        Result<UnitFactor> written = parse_unit(text.substr(word.size()));
        if (!written) return reason("dt: " + written.error().reason);
        if (!unit_fits(written->dimension, unit::second.dimension))
            return reason("dt must be in " + describe_unit(unit::second) + ", not in " + quoted(trimmed(text.substr(word.size()))));
        factor = *written;
    }
    StepLength step;
    step.seconds = factor.to_si(*number);
    if (!(step.seconds > 0)) return reason("dt must be positive, not " + std::string(text));
    if (!(step.seconds >= kShortestStep && step.seconds <= kLongestStep))
        return reason("dt must be between 1e-9 s and 3600 s, not " + std::string(text));
    const std::optional<Fraction> exact = exact_seconds(word, factor);
    step.numerator = exact ? exact->numerator() : 1;
    step.denominator = exact ? exact->denominator() : 0;
    if (exact) step.seconds = static_cast<double>(step.numerator) / static_cast<double>(step.denominator);
    return step;
}

}  // namespace plab::model
