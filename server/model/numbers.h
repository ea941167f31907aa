/// Single numbers as authors write them, and back, independent of the process's locale.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "plab/result.h"

namespace plab::model
{

/// Whether a word is meant as a number (otherwise a unit begins there): a sign, a digit, a point, nan, inf.
bool looks_like_number(std::string_view word);

/// "0.5", "-1e3", "1/240", "inf". The caller has to refuse infinity if necessary. Refused here: NaN, hexadecimal, commas,
/// trailing text.
Result<double> parse_real(std::string_view word);

/// A whole number of 64 bits.
Result<std::int64_t> parse_integer(std::string_view word);
Result<std::uint64_t> parse_unsigned(std::string_view word);

/// The shortest decimal text that reads back as the same double.
std::string format_real(double value);

// For files that other programs read:

/// 17 significant digits, which read back to the same bits; `otherwise` for values that are not finite.
std::string exact_text(double value, std::string_view otherwise);
/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace plab::model
