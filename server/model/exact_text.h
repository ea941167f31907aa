/// Numbers and hashes for files that other programs read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace plab::model
{

/// 17 significant digits, which read back to the same bits; `otherwise` for values that are not finite.
std::string exact_text(double value, std::string_view otherwise);
/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace plab::model
