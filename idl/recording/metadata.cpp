#include "idl/recording/metadata.h"

#include <array>
#include <charconv>

#include "idl/recording/crc.h"
#include "idl/recording/encode.h"

namespace plab::recording
{
namespace
{

std::string seal_text(const Metadata& metadata)
{
    Bytes bytes;
    put_text(bytes, metadata.name);
    for (const auto& [key, value] : metadata.values)
        if (key != kSeal) put_text(bytes, key), put_text(bytes, value);
    std::array<char, 8> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), crc_of(bytes), 16).ptr;
    const std::string text(digits.data(), end);
    return std::string(digits.size() - text.size(), '0') + text;
}

}  // namespace

Metadata sealed(Metadata metadata)
{
    metadata.values[kSeal] = seal_text(metadata);
    return metadata;
}

Seal seal_of(const Metadata& metadata)
{
    const auto found = metadata.values.find(kSeal);
    if (found == metadata.values.end()) return Seal::None;
    return found->second == seal_text(metadata) ? Seal::Right : Seal::Broken;
}

}  // namespace plab::recording
