/// Samples of types that a program was not built with: the structure of a type, and the values in its bytes.
/// The bytes are not trusted: every length is checked against the available data, and a mismatch is an error that names its
/// location ("bodies[3].position.y: the sample ends here"). Nothing is guessed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "plab/result.h"

namespace plab::link
{

struct DynamicType;
using DynamicTypePtr = std::shared_ptr<const DynamicType>;

struct DynamicMember
{
    std::string name;
    DynamicTypePtr type;
    bool is_key = false;
};

/// A type as described by its XTypes TypeObject. Constructs that are not listed here (unions, maps, wide strings, optional
/// members, bit masks) are refused when the type is read, before any sample.
struct DynamicType
{
    enum class Kind : std::uint8_t
    {
        Boolean,
        Octet,
        Int16,
        Int32,
        Int64,
        Uint16,
        Uint32,
        Uint64,
        Float32,
        Float64,
        Char,
        String,
        Enum,
        Struct,
        Sequence,
        Array,
    };
    Kind kind = Kind::Octet;
    std::string name;                    ///< of structs and enums
    bool is_appendable = false;          ///< struct: XCDR2 writes its length before it
    std::vector<DynamicMember> members;  ///< struct; those of its base come first
    DynamicTypePtr element;              ///< sequence, array
    std::uint32_t bound = 0;             ///< string, sequence: maximum length; 0: unlimited
    std::vector<std::uint32_t> dimensions;
    std::uint8_t enum_bytes = 4;  ///< 1, 2 or 4
    std::vector<std::pair<std::int32_t, std::string>> literals;
};

bool is_scalar(const DynamicType& type);

/// An enum's value; the literal is empty if the type has none for it.
struct EnumValue
{
    std::int32_t number = 0;
    std::string_view literal;
};
using Scalar = std::variant<bool, std::int64_t, std::uint64_t, float, double, std::string_view, EnumValue>;

/// Receives the values of a sample, in order.
class SampleVisitor
{
public:
    virtual ~SampleVisitor() = default;
    virtual void open_struct(const DynamicType& type) = 0;
    virtual void member(std::string_view name) = 0;  ///< its value comes next
    virtual void close_struct() = 0;
    virtual void open_list(const DynamicType& element, std::size_t count) = 0;
    virtual void close_list() = 0;
    virtual void scalar(const Scalar& value) = 0;
};

/// Reads a sample in wire format: 4 bytes that name the encoding (XCDR1, or XCDR2 plain or delimited, of either byte order),
/// then the values. On an error the visitor has received a part of it.
Result<void> decode(const DynamicType& type, std::span<const std::byte> bytes, SampleVisitor& visitor);

/// The members that form its key, with their own members: the contents of a sample that only reports that its instance is gone.
/// Null if it has no key.
DynamicTypePtr key_of(const DynamicType& type);

/// "name: value" lines, members of structs indented below it. Lists longer than `most` elements are shortened, with a note.
Result<std::string> tree_of(const DynamicType& type, std::span<const std::byte> bytes, std::size_t most);

}  // namespace plab::link
