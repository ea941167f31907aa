/// Schemas that recordings bring with them: what a message of any topic is made of, also of other versions of the wire.
#pragma once

#include <string_view>

#include "idl/recording/records.h"
#include "link/dynamic_sample.h"

namespace plab::recordings
{

/// The type `name` ("plab::v2::Frame") that an IDL text declares. What is understood: modules, structs, enums, typedefs,
/// sequences, arrays, bounds, annotations. An error says what is not.
Result<link::DynamicTypePtr> type_in(std::string_view idl, const std::string& name);

/// The type of a channel's messages; an error if its schema is no omgidl.
Result<link::DynamicTypePtr> type_of(const recording::Schema& schema);

}  // namespace plab::recordings
