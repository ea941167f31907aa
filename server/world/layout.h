/// What the raw bytes of a row hold, field by field: enough to read them without the type.
#pragma once

#include <string>
#include <vector>

#include "plab/ref.h"
#include "plab/schema.h"

namespace plab::world
{

struct FieldLayout
{
    std::string name;
    FieldKind kind = FieldKind::Param;
    FieldType type = FieldType::None;
    friend bool operator==(const FieldLayout&, const FieldLayout&) = default;
};

/// Params, state and outputs of one type in the order of their declaration; fields that the host keeps are left out.
struct Layout
{
    std::string type;
    Facet facet = Facet::Component;
    std::vector<FieldLayout> fields;
};

/// One value as a column of its type saves it (plab/bytes.h), and back.
void write_value(ByteWriter& out, const Value& value);
Value read_value(ByteReader& in, FieldType type);

}  // namespace plab::world
