#include "link/numbers.h"

#include <charconv>
#include <cstdint>

#include "link/session.h"

namespace plab::link
{
namespace
{

template <class T>
std::errc read(const std::string& text, T& value)
{
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    return error == std::errc() && end != last ? std::errc::invalid_argument : error;
}

std::string check_real(const std::string& text, bool may_be_zero, const char* wanted)
{
    double value = 0;
    // A comparison with NaN is false.
    const bool is_right = read(text, value) == std::errc() && (may_be_zero ? value >= 0 : value > 0) && value <= kLongestWait.count();
    return is_right ? "" : "must be " + std::string(wanted) + ", not '" + text + "'";
}

std::string check_integer(const std::string& text, std::int64_t least)
{
    std::int64_t value = 0;
    const std::errc error = read(text, value);
    if (error == std::errc() && value >= least) return {};
    const bool is_too_large = error == std::errc::result_out_of_range && text.front() != '-';
    const std::string wanted = is_too_large ? "at most 9223372036854775807" : "a whole number, " + std::to_string(least) + " or more";
    return "must be " + wanted + ", not '" + text + "'";
}

}  // namespace

std::string check_positive(const std::string& text) { return check_real(text, false, "a number above 0, at most 1e8"); }
std::string check_not_negative(const std::string& text) { return check_real(text, true, "a number from 0 to 1e8"); }
std::string check_count(const std::string& text) { return check_integer(text, 1); }
std::string check_whole(const std::string& text) { return check_integer(text, 0); }

}  // namespace plab::link
