/// Tables of named, typed columns as bytes, which make up a snapshot file. Little-endian, with checks at every read; the meaning of the
/// columns is defined in format.h.
///
///   file      "pLabSnap"  u32 version  u64 length of the file  section...  u64 hash of all before
///   section   text name  u32 rows  u32 columns  column...
///   column    text name  text type  u64 length  data
///   text      u32 length  bytes
///
///   type      one element
///   boolean   u8, 0 or 1                     text       as above
///   index     u32                            reals      u32 count, f64...
///   integer   i64                            integers   u32 count, i64...
///   real      f64                            entries    u32 count, then each: text name, value (boolean, real or text)
///   vector    3 f64    rotation  4 f64       value      text type, element of that type ("none": nothing)
///   matrix    9 f64
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "plab/result.h"
#include "plab/value.h"

namespace plab::simulation
{

/// One element per row. The alternatives are in the order of kColumnTypes.
using ColumnData = std::variant<std::vector<bool>, std::vector<std::uint32_t>, std::vector<std::int64_t>, std::vector<double>,
                                std::vector<Vec3>, std::vector<Quat>, std::vector<Mat3>, std::vector<std::string>, std::vector<Reals>,
                                std::vector<Integers>, std::vector<Entries>, std::vector<Value>>;
inline constexpr std::string_view kColumnTypes[] = {"boolean", "index", "integer", "real",     "vector",  "rotation",
                                                    "matrix",  "text",  "reals",   "integers", "entries", "value"};
static_assert(std::size(kColumnTypes) == std::variant_size_v<ColumnData>);

struct NamedColumn
{
    std::string name;
    ColumnData data;

    std::size_t size() const
    {
        return std::visit([](const auto& v) { return v.size(); }, data);
    }
};

struct Section
{
    std::string name;
    std::size_t rows = 0;
    std::vector<NamedColumn> columns;  ///< each of `rows` elements

    const NamedColumn* find(std::string_view column) const;
};

inline constexpr std::string_view kSnapshotMagic = "pLabSnap";

std::vector<std::uint8_t> write_sections(std::uint32_t version, std::span<const Section> sections);

struct SectionFile
{
    std::uint32_t version = 0;
    std::vector<Section> sections;
};
/// Accepts any bytes: data that is truncated, modified or of a version above `newest` is refused with the reason. No memory is allocated
/// beyond what the length of `bytes` justifies.
Result<SectionFile> read_sections(std::span<const std::uint8_t> bytes, std::uint32_t newest);

}  // namespace plab::simulation
