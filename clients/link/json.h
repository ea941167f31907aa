/// Data of a server as JSON, for all clients that print it. The shapes of values are those of idl/json/json.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "idl/json/json.h"
#include "idl/plab.h"
#include "link/dynamic_sample.h"

namespace plab::link
{

using wire::Json;
using wire::json_of;
using wire::line_of;

/// One of the sample's entries.
Json json_of(const plab_v2_Events& sample, std::uint32_t entry);
Json json_of(const plab_v2_Collisions& sample, std::uint32_t entry);

enum class Numbers : std::uint8_t
{
    Plain,
    Quoted,  ///< exact texts, since JSON's own numbers lose 64-bit integers, infinities and the sign of zero in most readers
};
/// A sample of any type. Enums are the names of their literals, or numbers if they have none or if numbers are quoted.
Result<Json> json_of(const DynamicType& type, std::span<const std::byte> bytes, Numbers numbers = Numbers::Plain);

}  // namespace plab::link
