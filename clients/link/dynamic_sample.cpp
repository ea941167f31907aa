#include "link/dynamic_sample.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace plab::link
{
namespace
{

using Kind = DynamicType::Kind;

// Types may be foreign too: neither their depth nor lists of elements without bytes may cost more than this.
constexpr int kMostSampleDepth = 64;
constexpr std::size_t kMostValues = std::size_t{1} << 25;

/// Reads one sample. After a failure every further step fails; the path to it is assembled on the way out.
class Decoder
{
public:
    Decoder(std::span<const std::byte> bytes, SampleVisitor& visitor) : bytes_(bytes), visitor_(visitor) {}

    Result<void> run(const DynamicType& type)
    {
        if (!start() || !value(type, 0)) return reason((path_.empty() ? "" : path_ + ": ") + why_);
        // Up to three bytes fill the last word.
        if (end_ - at_ > 3) return reason(std::to_string(end_ - at_) + " bytes are left over: the type does not match the sample");
        return {};
    }

private:
    bool fail(std::string why)
    {
        if (why_.empty()) why_ = std::move(why);
        return false;
    }
    bool fail_in(const std::string& part)
    {
        path_ = path_.empty() || path_.front() == '[' ? part + path_ : part + "." + path_;
        return false;
    }

    bool start()
    {
        if (bytes_.size() < 4) return fail("a sample begins with 4 header bytes, this one has " + std::to_string(bytes_.size()));
        const auto encoding = std::to_integer<unsigned>(bytes_[0]) << 8 | std::to_integer<unsigned>(bytes_[1]);
        constexpr std::array<unsigned, 6> kKnown{0x0000, 0x0001, 0x0006, 0x0007, 0x0008, 0x0009};
        if (std::find(kKnown.begin(), kKnown.end(), encoding) == kKnown.end())
            return fail("its encoding has the number " + std::to_string(encoding) +
                        "; XCDR1 (0, 1) and XCDR2 (6 to 9) are understood, parameter lists are not");
        const bool is_little = (encoding & 1) != 0;
        is_swapped_ = is_little != (std::endian::native == std::endian::little);
        is_xcdr2_ = encoding >= 6;
        is_delimited_ = encoding >= 8;
        bytes_ = bytes_.subspan(4);
        end_ = bytes_.size();
        return true;
    }

    bool align(std::size_t size)
    {
        const std::size_t to = std::min<std::size_t>(size, is_xcdr2_ ? 4 : 8);
        at_ = (at_ + to - 1) / to * to;
        return at_ <= end_ || fail("the sample ends here");
    }

    template <class T>
    bool read(T& out)
    {
        if (!align(sizeof(T))) return false;
        if (end_ - at_ < sizeof(T)) return fail("the sample ends here");
        std::array<std::byte, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
        if (is_swapped_) std::reverse(raw.begin(), raw.end());
        out = std::bit_cast<T>(raw);
        at_ += sizeof(T);
        return true;
    }

    /// T as it is on the wire, Shown as the visitor hears it.
    template <class T, class Shown>
    bool number()
    {
        T n{};
        if (!read(n)) return false;
        visitor_.scalar(static_cast<Shown>(n));
        return true;
    }

    bool value(const DynamicType& type, int depth)
    {
        if (++values_ > kMostValues) return fail("the sample has more than " + std::to_string(kMostValues) + " values");
        if (depth > kMostSampleDepth) return fail("the type is deeper than " + std::to_string(kMostSampleDepth) + " levels");
        switch (type.kind)
        {
            case Kind::Boolean:
                return boolean();
            case Kind::Octet:
                return number<std::uint8_t, std::uint64_t>();
            case Kind::Int16:
                return number<std::int16_t, std::int64_t>();
            case Kind::Int32:
                return number<std::int32_t, std::int64_t>();
            case Kind::Int64:
                return number<std::int64_t, std::int64_t>();
            case Kind::Uint16:
                return number<std::uint16_t, std::uint64_t>();
            case Kind::Uint32:
                return number<std::uint32_t, std::uint64_t>();
            case Kind::Uint64:
                return number<std::uint64_t, std::uint64_t>();
            case Kind::Float32:
                return number<float, float>();
            case Kind::Float64:
                return number<double, double>();
            case Kind::Char:
                return character();
            case Kind::String:
                return string(type);
            case Kind::Enum:
                return enumerated(type);
            case Kind::Struct:
                return structure(type, depth);
            case Kind::Sequence:
                return sequence(type, depth);
            case Kind::Array:
                return array(type, depth);
        }
        return fail("a value of unknown kind");
    }

    bool boolean()
    {
        std::uint8_t n = 0;
        if (!read(n)) return false;
        if (n > 1) return fail("a boolean is 0 or 1, not " + std::to_string(n));
        visitor_.scalar(n == 1);
        return true;
    }

    bool character()
    {
        char c = 0;
        if (!read(c)) return false;
        visitor_.scalar(std::string_view(&c, 1));
        return true;
    }

    bool string(const DynamicType& type)
    {
        std::uint32_t n = 0;
        if (!read(n)) return false;
        if (n == 0) return fail("a string needs at least its terminating zero");
        if (n > end_ - at_) return fail("a string of " + std::to_string(n) + " bytes, but " + std::to_string(end_ - at_) + " are left");
        if (type.bound > 0 && n - 1 > type.bound)
            return fail("a string of " + std::to_string(n - 1) + " bytes, at most " + std::to_string(type.bound));
        const auto* const text = reinterpret_cast<const char*>(bytes_.data() + at_);
        if (text[n - 1] != 0) return fail("a string without its terminating zero");
        at_ += n;
        visitor_.scalar(std::string_view(text, n - 1));
        return true;
    }

    template <class T>
    bool read_as_int(std::int32_t& out)
    {
        T n{};
        if (!read(n)) return false;
        out = n;
        return true;
    }
    bool enumerated(const DynamicType& type)
    {
        EnumValue value;
        const bool is_read = type.enum_bytes == 1   ? read_as_int<std::int8_t>(value.number)
                             : type.enum_bytes == 2 ? read_as_int<std::int16_t>(value.number)
                                                    : read_as_int<std::int32_t>(value.number);
        if (!is_read) return false;
        for (const auto& [number, literal] : type.literals)
            if (number == value.number) value.literal = literal;
        visitor_.scalar(value);
        return true;
    }

    /// XCDR2 writes the length in bytes before some values: the following data must stay inside. Returns the outer end.
    bool enter(std::size_t& outer_end)
    {
        std::uint32_t n = 0;
        if (!read(n)) return false;
        if (n > end_ - at_) return fail("a part of " + std::to_string(n) + " bytes, but " + std::to_string(end_ - at_) + " are left");
        outer_end = std::exchange(end_, at_ + n);
        return true;
    }
    void leave(std::size_t outer_end)
    {
        at_ = end_;
        end_ = outer_end;
    }

    bool structure(const DynamicType& type, int depth)
    {
        const bool is_limited = is_delimited_ && type.is_appendable;
        std::size_t outer = end_;
        if (is_limited && !enter(outer)) return false;
        visitor_.open_struct(type);
        for (const DynamicMember& member : type.members)
        {
            // A writer with an older version of an appendable type sends fewer members.
            if (is_limited && at_ == end_) break;
            visitor_.member(member.name);
            if (!value(*member.type, depth + 1)) return fail_in(member.name);
        }
        visitor_.close_struct();
        if (is_limited) leave(outer);
        return true;
    }

    bool has_length(const DynamicType& element) const
    {
        return is_xcdr2_ && (element.kind == Kind::Enum || !is_scalar(element) || element.kind == Kind::String);
    }

    bool sequence(const DynamicType& type, int depth)
    {
        std::size_t outer = end_;
        const bool is_limited = has_length(*type.element);
        if (is_limited && !enter(outer)) return false;
        std::uint32_t n = 0;
        if (!read(n)) return false;
        if (type.bound > 0 && n > type.bound)
            return fail("a sequence of " + std::to_string(n) + " elements, at most " + std::to_string(type.bound));
        // No element but an empty struct is smaller than a byte.
        const bool may_be_empty = type.element->kind == Kind::Struct && type.element->members.empty();
        if (n > end_ - at_ && !may_be_empty)
            return fail("a sequence of " + std::to_string(n) + " elements, but " + std::to_string(end_ - at_) + " bytes are left");
        if (!elements(*type.element, n, depth)) return false;
        if (is_limited) leave(outer);
        return true;
    }

    bool elements(const DynamicType& element, std::size_t n, int depth)
    {
        visitor_.open_list(element, n);
        for (std::size_t i = 0; i < n; ++i)
            if (!value(element, depth + 1)) return fail_in("[" + std::to_string(i) + "]");
        visitor_.close_list();
        return true;
    }

    bool array(const DynamicType& type, int depth)
    {
        std::size_t outer = end_;
        const bool is_limited = has_length(*type.element);
        if (is_limited && !enter(outer)) return false;
        if (!dimension(type, 0, depth)) return false;
        if (is_limited) leave(outer);
        return true;
    }
    bool dimension(const DynamicType& type, std::size_t which, int depth)
    {
        const std::size_t n = which < type.dimensions.size() ? type.dimensions[which] : 0;
        if (which + 1 >= type.dimensions.size()) return elements(*type.element, n, depth);
        if (static_cast<int>(which) + depth > kMostSampleDepth) return fail("an array of too many dimensions");
        visitor_.open_list(type, n);
        for (std::size_t i = 0; i < n; ++i)
        {
            if (++values_ > kMostValues) return fail("the sample has more than " + std::to_string(kMostValues) + " values");
            if (!dimension(type, which + 1, depth)) return fail_in("[" + std::to_string(i) + "]");
        }
        visitor_.close_list();
        return true;
    }

    std::span<const std::byte> bytes_;
    SampleVisitor& visitor_;
    std::size_t at_ = 0, end_ = 0;
    std::size_t values_ = 0;
    bool is_swapped_ = false, is_xcdr2_ = false, is_delimited_ = false;
    std::string why_, path_;
};

DynamicTypePtr reduce_to_key(const DynamicTypePtr& type, int depth)
{
    if (type->kind != Kind::Struct || depth > kMostSampleDepth) return type;
    auto key = std::make_shared<DynamicType>(*type);
    std::erase_if(key->members, [](const DynamicMember& m) { return !m.is_key; });
    // A struct that is a key and marks none of its members is a key as a whole.
    if (key->members.empty()) key->members = type->members;
    for (DynamicMember& member : key->members) member.type = reduce_to_key(member.type, depth + 1);
    return key;
}

}  // namespace

bool is_scalar(const DynamicType& type) { return type.kind != Kind::Struct && type.kind != Kind::Sequence && type.kind != Kind::Array; }

Result<void> decode(const DynamicType& type, std::span<const std::byte> bytes, SampleVisitor& visitor)
{
    return Decoder(bytes, visitor).run(type);
}

DynamicTypePtr key_of(const DynamicType& type)
{
    const bool has_key = std::any_of(type.members.begin(), type.members.end(), [](const DynamicMember& m) { return m.is_key; });
    return has_key ? reduce_to_key(std::make_shared<DynamicType>(type), 0) : nullptr;
}

}  // namespace plab::link
