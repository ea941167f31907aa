/// Metadata records with a seal. MCAP gives them no CRC of their own, so without a seal damage in a truncated or corrupted file
/// would go unnoticed.
#pragma once

#include "idl/recording/records.h"

namespace plab::recording
{

/// The key of the seal: CRC-32 of everything else, as 8 hexadecimal digits.
inline constexpr const char* kSeal = "crc32";

enum class Seal : std::uint8_t
{
    None,
    Right,
    Broken,
};

/// Adds a seal; replaces an existing one.
Metadata sealed(Metadata metadata);
Seal seal_of(const Metadata& metadata);

}  // namespace plab::recording
