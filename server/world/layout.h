/// What the raw bytes of a row contain, field by field, so that they can be read without the type.
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

/// Params, state and outputs of one type in the order of their declaration; hosted fields are left out.
struct Layout
{
    std::string type;
    Facet facet = Facet::Component;
    std::vector<FieldLayout> fields;
};

/// Writes a value as a column of its type saves it (plab/bytes.h), and reads it back.
void write_value(ByteWriter& out, const Value& value);
/// Whether both have the same type and bits: a NaN equals itself, 0 differs from -0.
bool same_bits(const Value& a, const Value& b);
Value read_value(ByteReader& in, FieldType type);

}  // namespace plab::world
