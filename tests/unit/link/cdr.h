/// Samples made by hand: types and their bytes.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "link/json.h"

namespace plab::test
{

using link::DynamicMember;
using link::DynamicType;
using link::DynamicTypePtr;
using Kind = DynamicType::Kind;

inline DynamicTypePtr simple(Kind kind)
{
    auto type = std::make_shared<DynamicType>();
    type->kind = kind;
    return type;
}
inline DynamicTypePtr structure(std::vector<DynamicMember> members, bool is_appendable = false)
{
    auto type = std::make_shared<DynamicType>();
    type->kind = Kind::Struct, type->members = std::move(members), type->is_appendable = is_appendable;
    return type;
}
inline DynamicTypePtr sequence(DynamicTypePtr element, std::uint32_t bound = 0)
{
    auto type = std::make_shared<DynamicType>();
    type->kind = Kind::Sequence, type->element = std::move(element), type->bound = bound;
    return type;
}
inline DynamicTypePtr array(DynamicTypePtr element, std::vector<std::uint32_t> dimensions)
{
    auto type = std::make_shared<DynamicType>();
    type->kind = Kind::Array, type->element = std::move(element), type->dimensions = std::move(dimensions);
    return type;
}
inline DynamicTypePtr colors()
{
    auto type = std::make_shared<DynamicType>();
    type->kind = Kind::Enum, type->literals = {{0, "RED"}, {5, "BLUE"}};
    return type;
}

/// Puts values where their alignment requires.
class Cdr
{
public:
    /// 1: XCDR1, 7: XCDR2, 9: XCDR2 with lengths; all little-endian.
    explicit Cdr(int encoding = 1) : most_aligned_(encoding >= 6 ? 4 : 8)
    {
        bytes_ = {std::byte{0}, static_cast<std::byte>(encoding), std::byte{0}, std::byte{0}};
    }
    template <class T>
    Cdr& put(T value)
    {
        const std::size_t to = std::min(sizeof(T), most_aligned_);
        while ((bytes_.size() - 4) % to != 0) bytes_.push_back(std::byte{0xEE});  // padding has no meaning
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof(T));
        std::memcpy(bytes_.data() + at, &value, sizeof(T));
        return *this;
    }
    Cdr& text(const std::string& s)
    {
        put(static_cast<std::uint32_t>(s.size() + 1));
        for (const char c : s) put(c);
        return put('\0');
    }
    const std::vector<std::byte>& bytes() const { return bytes_; }

private:
    std::size_t most_aligned_;
    std::vector<std::byte> bytes_;
};

inline std::string json(const DynamicTypePtr& type, const std::vector<std::byte>& bytes)
{
    const auto text = link::json_of(*type, bytes);
    return text ? link::line_of(*text) : "error: " + text.error().text();
}

/// Some of every kind of member: the hostile tests cut and alter it.
inline DynamicTypePtr rich_type()
{
    const auto point = structure({{"x", simple(Kind::Float64)}, {"y", simple(Kind::Float32)}});
    return structure({{"name", simple(Kind::String), true},
                      {"flag", simple(Kind::Boolean)},
                      {"color", colors()},
                      {"points", sequence(point)},
                      {"words", sequence(simple(Kind::String))},
                      {"grid", array(simple(Kind::Int16), {2, 3})},
                      {"count", simple(Kind::Uint64)}});
}
inline Cdr rich_sample()
{
    Cdr cdr;
    cdr.text("ball").put(std::uint8_t{1}).put(std::int32_t{5});
    cdr.put(std::uint32_t{2}).put(0.5).put(1.5f).put(-2.0).put(0.25f);
    cdr.put(std::uint32_t{2}).text("a").text("");
    for (std::int16_t i = 1; i <= 6; ++i) cdr.put(i);
    return cdr.put(~std::uint64_t{0});
}

}  // namespace plab::test
