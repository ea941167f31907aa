/// Values as CDR (XCDR1, little-endian, with its 4 bytes of encapsulation): for the types of channels.cpp, which are Foxglove's and for
/// which idlc makes no code. Members follow one another in the order of their declaration.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "plab/vector.h"

namespace plab::foxglove
{

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

class CdrWriter
{
public:
    void put(bool value) { bytes_ += value ? '\1' : '\0'; }
    void put(std::uint32_t value) { put_number(value); }
    void put(double value) { put_number(value); }
    void put(const Vec3& v) { put(v.x), put(v.y), put(v.z); }
    void put(const Quat& q) { put(q.x), put(q.y), put(q.z), put(q.w); }
    void put(const Pose& X) { put(X.p), put(X.q); }
    void put(std::string_view text)
    {
        put(static_cast<std::uint32_t>(text.size() + 1));
        bytes_ += text;
        bytes_ += '\0';
    }
    void put(const std::string& text) { put(std::string_view(text)); }
    void put(const char* text) { put(std::string_view(text)); }
    /// The length of a sequence, whose elements follow.
    void count(std::size_t elements) { put(static_cast<std::uint32_t>(elements)); }
    /// As above, for a number that is not known yet: where it stands, for set_count().
    std::size_t count_later()
    {
        put(std::uint32_t{0});
        return bytes_.size() - sizeof(std::uint32_t);
    }
    void set_count(std::size_t at, std::size_t elements)
    {
        const auto value = static_cast<std::uint32_t>(elements);
        std::memcpy(bytes_.data() + at, &value, sizeof value);
    }

    std::size_t size() const { return bytes_.size(); }
    std::string take() { return std::exchange(bytes_, std::string(kHead)); }

private:
    static constexpr std::string_view kHead{"\0\1\0\0", 4};

    template <class T>
    void put_number(T value)
    {
        while ((bytes_.size() - kHead.size()) % sizeof(T) != 0) bytes_ += '\0';
        const auto* const first = reinterpret_cast<const char*>(&value);
        bytes_.append(first, sizeof value);
    }
    std::string bytes_{kHead};
};

}  // namespace plab::foxglove
