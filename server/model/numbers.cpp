#include "model/numbers.h"

#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>

#include "model/text.h"
#include "model/units.h"

namespace plab::model
{

namespace
{

std::string_view without_sign(std::string_view word)
{
    if (!word.empty() && (word.front() == '+' || word.front() == '-')) word.remove_prefix(1);
    return word;
}

bool is_infinity(std::string_view word) { return equal_ignoring_case(word, "inf") || equal_ignoring_case(word, "infinity"); }

bool is_nan(std::string_view word) { return word.size() >= 3 && equal_ignoring_case(word.substr(0, 3), "nan"); }

/// Why `word`, of which from_chars left `rest`, is not a number.
Error not_a_number(std::string_view word, std::string_view rest)
{
    if (is_nan(without_sign(word))) return reason(quoted(word) + " is not a finite number");
    if (word.find(',') != std::string_view::npos)
        return reason(quoted(word) + ": use a point, not a comma, in numbers, and spaces between them");
    const std::string_view digits = without_sign(word);
    if (digits.starts_with("0x") || digits.starts_with("0X")) return reason(quoted(word) + ": write the number in decimal notation");
    if (rest.size() < word.size() && is_unit_symbol(rest))
        return reason(quoted(word) + ": put a space between number and unit, '" + std::string(word.substr(0, word.size() - rest.size())) +
                      " " + std::string(rest) + "'");
    return reason(quoted(word) + " is not a number");
}

template <class T>
Result<T> parse_with_from_chars(std::string_view word)
{
    std::string_view digits = word;
    if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
    T value{};
    const char* const end = digits.data() + digits.size();
    const auto [at, ec] = std::from_chars(digits.data(), end, value);
    if (ec == std::errc::result_out_of_range) return reason(quoted(word) + " is out of range");
    if (ec != std::errc() || at != end) return not_a_number(word, {at, static_cast<std::size_t>(end - at)});
    return value;
}

Result<double> parse_plain_real(std::string_view word)
{
    const std::string_view digits = without_sign(word);
    if (is_infinity(digits)) return (word.front() == '-' ? -1 : 1) * std::numeric_limits<double>::infinity();
    // from_chars would accept "nan" and "infinity"; here a number must begin with a digit or a point.
    if (digits.empty() || !(is_digit(digits.front()) || digits.front() == '.')) return not_a_number(word, word);
    return parse_with_from_chars<double>(word);
}

}  // namespace

bool looks_like_number(std::string_view word)
{
    if (word.empty()) return false;
    if (word.size() > 2 && word.starts_with("1/") && is_letter(word[2])) return false;
    const char c = word.front();
    return c == '+' || c == '-' || c == '.' || c == ',' || is_digit(c) || is_infinity(word) || is_nan(word);
}

Result<double> parse_real(std::string_view word)
{
    const std::size_t slash = word.find('/');
    if (slash == std::string_view::npos) return parse_plain_real(word);
    const Result<double> a = parse_plain_real(word.substr(0, slash));
    const Result<double> b = parse_plain_real(word.substr(slash + 1));
    if (!a || !b || std::isinf(*a) || std::isinf(*b)) return reason(quoted(word) + " is not a number");
    if (*b == 0) return reason(quoted(word) + " divides by zero");
    const double value = *a / *b;
    if (std::isinf(value)) return reason(quoted(word) + " is out of range");
    return value;
}

Result<std::int64_t> parse_integer(std::string_view word)
{
    Result<std::int64_t> whole = parse_with_from_chars<std::int64_t>(word);
    if (!whole && parse_real(word) && whole.error().reason.find("range") == std::string::npos)
        return reason(quoted(word) + " is not a whole number");
    return whole;
}

Result<std::uint64_t> parse_unsigned(std::string_view word)
{
    Result<std::uint64_t> whole = parse_with_from_chars<std::uint64_t>(word);
    if (!whole && parse_real(word) && whole.error().reason.find("range") == std::string::npos)
        return reason(quoted(word) + " is not a whole number, 0 or greater");
    return whole;
}

std::string format_real(double value)
{
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
    const double size = std::fabs(value);
    const bool plain = size == 0 || (size >= 1e-5 && size < 1e16);
    char buffer[64];
    const auto [end, ec] =
        std::to_chars(buffer, buffer + sizeof buffer, value, plain ? std::chars_format::fixed : std::chars_format::scientific);
    return ec == std::errc() ? std::string(buffer, end) : std::string();
}

std::string exact_text(double value, std::string_view otherwise)
{
    if (!std::isfinite(value)) return std::string(otherwise);
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

std::string hash_text(std::uint64_t hash)
{
    char text[20];
    std::snprintf(text, sizeof text, "%016" PRIx64, hash);
    return text;
}

}  // namespace plab::model
