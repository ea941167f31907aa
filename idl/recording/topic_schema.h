/// Schemas and channels of our topics, so that any tool can decode them.
#pragma once

#include <string>
#include <string_view>

#include "idl/recording/records.h"
#include "idl/topics.h"
#include "plab/result.h"

namespace plab::recording
{

/// `type_name` ("plab::v2::Frame") and all types that it uses, extracted from idl/plab.idl: self-contained OMG IDL without
/// comments.
Result<std::string> idl_of(std::string_view type_name);
/// As above, from any IDL whose declarations are in one scope of modules ("module a { module b { ... }; };").
Result<std::string> select_idl(std::string_view idl, std::string_view type_name);

/// Encoding "omgidl"; without id.
Result<Schema> schema_of(const wire::Topic& topic);
/// Message encoding "cdr"; without id.
Channel channel_of(const wire::Topic& topic, std::uint16_t schema_id);

template <class T>
Result<Schema> schema_of()
{
    return schema_of(wire::topic_of<T>());
}
template <class T>
Channel channel_of(std::uint16_t schema_id)
{
    return channel_of(wire::topic_of<T>(), schema_id);
}

}  // namespace plab::recording
