/// Schemas contained in recordings: the structure of a topic's messages, also for other versions of the wire.
#pragma once

#include <string_view>

#include "idl/recording/records.h"
#include "link/dynamic_sample.h"

namespace plab::recordings
{

/// The type `name` ("plab::v2::Frame") that an IDL text declares. Supported: modules, structs, enums, typedefs, sequences,
/// arrays, bounds, annotations. An error names what is not supported.
Result<link::DynamicTypePtr> type_in(std::string_view idl, const std::string& name);

/// The type of a channel's messages; an error if its schema is not omgidl.
Result<link::DynamicTypePtr> type_of(const recording::Schema& schema);

}  // namespace plab::recordings
