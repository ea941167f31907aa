/// The values of fields in blueprints, requests and listings.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "plab/vector.h"

namespace plab
{

/// One entry of an open record (a script's declared state): a name with a number, a truth value or a text.
struct Entry
{
    std::string name;
    std::variant<bool, double, std::string> value;
    friend bool operator==(const Entry&, const Entry&) = default;
};
/// Entries in the order of their declaration; names are unique.
using Entries = std::vector<Entry>;

/// Numbers of a mesh or a sampled curve, flat.
using Reals = std::vector<double>;
/// Index triples of a mesh, or identifiers as numbers.
using Integers = std::vector<std::int64_t>;

enum class FieldType : std::uint8_t
{
    None,
    Boolean,
    Integer,
    Real,
    Vector,    ///< three numbers
    Rotation,  ///< unit quaternion w x y z; text may also give "axis x y z angle"
    Matrix,    ///< symmetric 3x3; text gives xx yy zz, or xx yy zz xy xz yz
    Text,
    RealList,
    IntegerList,
    EntryList,
    Opaque,  ///< a plugin's own object: no text form, never copied
};

/// The alternatives are in the order of FieldType.
using Value = std::variant<std::monostate, bool, std::int64_t, double, Vec3, Quat, Mat3, std::string, Reals, Integers, Entries>;

inline FieldType type_of(const Value& v) { return static_cast<FieldType>(v.index()); }

template <class T>
inline constexpr FieldType kFieldTypeOf = FieldType::Opaque;
template <>
inline constexpr FieldType kFieldTypeOf<bool> = FieldType::Boolean;
template <>
inline constexpr FieldType kFieldTypeOf<std::int64_t> = FieldType::Integer;
template <>
inline constexpr FieldType kFieldTypeOf<double> = FieldType::Real;
template <>
inline constexpr FieldType kFieldTypeOf<Vec3> = FieldType::Vector;
template <>
inline constexpr FieldType kFieldTypeOf<Quat> = FieldType::Rotation;
template <>
inline constexpr FieldType kFieldTypeOf<Mat3> = FieldType::Matrix;
template <>
inline constexpr FieldType kFieldTypeOf<std::string> = FieldType::Text;
template <>
inline constexpr FieldType kFieldTypeOf<Reals> = FieldType::RealList;
template <>
inline constexpr FieldType kFieldTypeOf<Integers> = FieldType::IntegerList;
template <>
inline constexpr FieldType kFieldTypeOf<Entries> = FieldType::EntryList;

}  // namespace plab
