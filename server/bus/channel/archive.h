/// Structs as bytes and back: their listed members in order, numbers with their memory layout, text and sequences with their length in
/// front. Both programs belong to one build and run on one machine, so the bytes carry no type information.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "idl/values/values.h"

namespace plab::bus
{

/// Types whose memory is copied directly.
template <class T>
inline constexpr bool kIsFlat = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <>
inline constexpr bool kIsFlat<bool> = false;  // not every byte is a valid bool
template <>
inline constexpr bool kIsFlat<Vec3> = true;
template <>
inline constexpr bool kIsFlat<Quat> = true;
template <>
inline constexpr bool kIsFlat<wire::BodyState> = true;
template <>
inline constexpr bool kIsFlat<wire::ShaftState> = true;
template <class T, std::size_t N>
inline constexpr bool kIsFlat<std::array<T, N>> = kIsFlat<T>;

/// Writes into a span. Bytes that do not fit are only counted: size() is the size that the whole would need.
class Encoder
{
public:
    explicit Encoder(std::span<std::byte> target) : target_(target) {}

    std::size_t size() const { return size_; }
    bool fits() const { return size_ <= target_.size(); }

    template <class T>
    void put(const T& value)
    {
        if constexpr (kIsFlat<T>)
            raw(&value, sizeof value);
        else if constexpr (std::is_same_v<T, bool>)
            put(static_cast<std::uint8_t>(value ? 1 : 0));
        else
            for_each_member([this](const char*, const auto& member) { this->put(member); }, value);
    }
    void put(const std::string& text)
    {
        put(static_cast<std::uint64_t>(text.size()));
        raw(text.data(), text.size());
    }
    template <class T>
    void put(const std::vector<T>& values)
    {
        put(static_cast<std::uint64_t>(values.size()));
        if constexpr (kIsFlat<T>)
            raw(values.data(), values.size() * sizeof(T));
        else
            for (const T& value : values) put(value);
    }

private:
    void raw(const void* data, std::size_t bytes)
    {
        if (bytes > 0 && bytes <= target_.size() && size_ <= target_.size() - bytes) std::memcpy(target_.data() + size_, data, bytes);
        size_ += bytes;
    }

    std::span<std::byte> target_;
    std::size_t size_ = 0;
};

/// Reads bytes that may come from an untrusted process: it never reads beyond the span, and allocates at most a multiple of its
/// size.
class Decoder
{
public:
    explicit Decoder(std::span<const std::byte> source) : rest_(source) {}

    /// Every field was complete, and no bytes are left over.
    bool whole() const { return fine_ && rest_.empty(); }
    /// Every field so far was complete.
    bool fine() const { return fine_; }

    template <class T>
    void get(T& value)
    {
        if constexpr (kIsFlat<T>)
            raw(&value, sizeof value);
        else if constexpr (std::is_same_v<T, bool>)
        {
            std::uint8_t byte = 0;
            get(byte);
            value = byte != 0;
        }
        else
            for_each_member([this](const char*, auto& member) { this->get(member); }, value);
    }
    void get(std::string& text)
    {
        const std::size_t size = length(1);
        text.assign(reinterpret_cast<const char*>(rest_.data()), size);
        rest_ = rest_.subspan(size);
    }
    template <class T>
    void get(std::vector<T>& values)
    {
        if constexpr (kIsFlat<T>)
        {
            values.resize(length(sizeof(T)));
            raw(values.data(), values.size() * sizeof(T));
        }
        else
        {
            // Not resized at once: each element consumes bytes of the span, so there cannot be more elements than bytes.
            std::size_t count = length(1);
            values.clear();
            while (fine_ && count-- > 0) get(values.emplace_back());
        }
    }

private:
    /// The number of elements that come next, each of `least` bytes or more; 0 if there are fewer bytes.
    std::size_t length(std::size_t least)
    {
        std::uint64_t count = 0;
        get(count);
        fine_ = fine_ && count <= rest_.size() / least;
        return fine_ ? static_cast<std::size_t>(count) : 0;
    }
    void raw(void* data, std::size_t bytes)
    {
        fine_ = fine_ && bytes <= rest_.size();
        if (!fine_ || bytes == 0) return;
        std::memcpy(data, rest_.data(), bytes);
        rest_ = rest_.subspan(bytes);
    }

    std::span<const std::byte> rest_;
    bool fine_ = true;
};

}  // namespace plab::bus
