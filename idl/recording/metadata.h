/// Metadata records with a seal. MCAP gives them no CRC of their own: in a file that was cut or bent nobody could tell
/// whether they are as they were.
#pragma once

#include "idl/recording/records.h"

namespace plab::recording
{

/// The key under which the seal stands: CRC-32 of all else, as 8 hexadecimal digits.
inline constexpr const char* kSeal = "crc32";

enum class Seal : std::uint8_t
{
    None,
    Right,
    Broken,
};

/// With a seal; one that it had is replaced.
Metadata sealed(Metadata metadata);
Seal seal_of(const Metadata& metadata);

}  // namespace plab::recording
