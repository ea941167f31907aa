#include "idl/recording/crc.h"

#include <zlib.h>

namespace plab::recording
{

std::uint32_t crc_of(ByteView bytes) { return crc_onwards(0, bytes); }

std::uint32_t crc_onwards(std::uint32_t crc, ByteView bytes)
{
    if (bytes.empty()) return crc;  // zlib interprets a null pointer as a request to start again
    return static_cast<std::uint32_t>(crc32_z(crc, bytes.data(), bytes.size()));
}

}  // namespace plab::recording
