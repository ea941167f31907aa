/// Short texts that both the report and plabctl use.
#pragma once

#include <cstdint>
#include <string>

#include "idl/recording/records.h"

namespace plab::recordings
{

/// "" if there is no such key.
std::string text_at(const recording::Pairs& pairs, const std::string& key);
/// "1 run", "2 runs".
std::string counted(std::uint64_t n, const std::string& what);
/// "2026-11-22 14:05:09 UTC", of ns since 1970.
std::string date_text(std::uint64_t nanoseconds);

}  // namespace plab::recordings
