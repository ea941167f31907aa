/// CRC-32 as zlib computes it: what MCAP asks for.
#pragma once

#include "idl/recording/records.h"

namespace plab::recording
{

std::uint32_t crc_of(ByteView bytes);
/// CRC of what `crc` was computed of, followed by `bytes`. Starts at 0.
std::uint32_t crc_onwards(std::uint32_t crc, ByteView bytes);

}  // namespace plab::recording
