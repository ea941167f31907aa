/// Values of idl/values/values.h as samples of the C types of plab.idl, and back; both derive from the lists of the values' members.
/// A value and its sample have the same members of the same types: anything else does not compile.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "idl/topics.h"
#include "idl/values/values.h"

namespace plab::wire
{
namespace detail
{

/// What field_count() is for a sample whose fields are the listed members: the elements of a C array count one by one.
template <class Sample, Described Value>
constexpr std::size_t listed_fields()
{
    constexpr Sample kEmpty{};
    std::size_t count = 0;
    const auto add = [&](const char*, const auto& field)
    {
        using Field = std::remove_cvref_t<decltype(field)>;
        count += std::is_array_v<Field> ? std::extent_v<Field> : 1;
    };
    visit_members(std::type_identity<Value>{}, add, kEmpty);
    return count;
}

template <class Sample, class Value>
constexpr void check_fields()
{
    static_assert(field_count<Sample>() == listed_fields<Sample, Value>(), "plab.idl has a member that the value lacks");
}

}  // namespace detail

/// The elements of a sequence of the C mapping.
template <class Sequence>
auto items(const Sequence& sequence)
{
    return std::span(sequence._buffer, sequence._buffer == nullptr ? 0 : sequence._length);
}

/// Copies a sample, which may be changed or released afterwards. `value` keeps its memory.
template <class Value, class Sample>
void read_sample(const Sample& sample, Value& value)
{
    if constexpr (Described<Value>)
    {
        detail::check_fields<Sample, Value>();
        for_each_member([](const char*, auto& to, const auto& from) { read_sample(from, to); }, value, sample);
    }
    else if constexpr (std::is_same_v<Value, std::string>)
        value = sample == nullptr ? "" : sample;
    else if constexpr (requires { sample._buffer; })
    {
        const auto from = items(sample);
        value.resize(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) read_sample(from[i], value[i]);
    }
    else if constexpr (std::is_array_v<Sample>)
        std::copy(std::begin(sample), std::end(sample), value.begin());
    else
    {
        static_assert(std::is_same_v<Value, Sample>);
        value = sample;
    }
}

template <class Value, class Sample>
Value value_of(const Sample& sample)
{
    Value value;
    read_sample(sample, value);
    return value;
}

/// A vector of Value has the layout of a sequence of Sample, which then points to it: nothing is copied.
template <class Value, class Sample>
inline constexpr bool kSameLayout = std::is_same_v<Value, Sample>;
template <>
inline constexpr bool kSameLayout<Vec3, plab_v2_Vector> = true;
template <>
inline constexpr bool kSameLayout<BodyState, plab_v2_BodyState> = true;
template <>
inline constexpr bool kSameLayout<ShaftState, plab_v2_ShaftState> = true;

static_assert(sizeof(Vec3) == sizeof(plab_v2_Vector) && alignof(Vec3) == alignof(plab_v2_Vector));
static_assert(offsetof(Vec3, x) == offsetof(plab_v2_Vector, x) && offsetof(Vec3, y) == offsetof(plab_v2_Vector, y) &&
              offsetof(Vec3, z) == offsetof(plab_v2_Vector, z));
static_assert(sizeof(Quat) == sizeof(plab_v2_Rotation) && alignof(Quat) == alignof(plab_v2_Rotation));
static_assert(offsetof(Quat, w) == offsetof(plab_v2_Rotation, w) && offsetof(Quat, x) == offsetof(plab_v2_Rotation, x) &&
              offsetof(Quat, y) == offsetof(plab_v2_Rotation, y) && offsetof(Quat, z) == offsetof(plab_v2_Rotation, z));
static_assert(sizeof(BodyState) == sizeof(plab_v2_BodyState) && alignof(BodyState) == alignof(plab_v2_BodyState));
static_assert(offsetof(BodyState, handle) == offsetof(plab_v2_BodyState, handle) &&
              offsetof(BodyState, position) == offsetof(plab_v2_BodyState, position) &&
              offsetof(BodyState, orientation) == offsetof(plab_v2_BodyState, orientation) &&
              offsetof(BodyState, linear_velocity) == offsetof(plab_v2_BodyState, linear_velocity) &&
              offsetof(BodyState, angular_velocity) == offsetof(plab_v2_BodyState, angular_velocity));
static_assert(sizeof(ShaftState) == sizeof(plab_v2_ShaftState) && alignof(ShaftState) == alignof(plab_v2_ShaftState));
static_assert(offsetof(ShaftState, handle) == offsetof(plab_v2_ShaftState, handle) &&
              offsetof(ShaftState, angle) == offsetof(plab_v2_ShaftState, angle) &&
              offsetof(ShaftState, speed) == offsetof(plab_v2_ShaftState, speed));

/// Memory for the sequences of one sample at a time. Keeps it for the next one: once it has held the largest, it allocates nothing.
class SequenceMemory
{
public:
    /// What make() returned may no longer be used.
    void clear()
    {
        if (blocks_.size() > 1)
        {
            const std::size_t all = total_;
            blocks_.clear(), total_ = 0;
            add_block(all);
        }
        used_ = 0;
    }
    /// `count` elements of a C type, all zero.
    template <class Item>
    Item* make(std::size_t count)
    {
        static_assert(std::is_trivially_copyable_v<Item> && alignof(Item) <= alignof(std::max_align_t));
        const std::size_t bytes =
            (count * sizeof(Item) + alignof(std::max_align_t) - 1) / alignof(std::max_align_t) * alignof(std::max_align_t);
        if (blocks_.empty() || used_ + bytes > blocks_.back().size) add_block(std::max<std::size_t>(2 * bytes, 1024)), used_ = 0;
        std::byte* const place = blocks_.back().bytes.get() + used_;
        used_ += bytes;
        return std::uninitialized_value_construct_n(reinterpret_cast<Item*>(place), count), reinterpret_cast<Item*>(place);
    }

private:
    struct Block
    {
        std::unique_ptr<std::byte[]> bytes;
        std::size_t size = 0;
    };
    void add_block(std::size_t size)
    {
        blocks_.push_back({std::make_unique<std::byte[]>(size), size});
        total_ += size;
    }

    std::vector<Block> blocks_;  ///< the last one is being filled
    std::size_t used_ = 0;       ///< bytes of the last one
    std::size_t total_ = 0;
};

/// Makes `sample` a view of `value`: its texts point into the value, and its sequences into the value or `memory`.
template <class Sample, class Value>
void view_value(const Value& value, Sample& sample, SequenceMemory& memory)
{
    if constexpr (Described<Value>)
    {
        detail::check_fields<Sample, Value>();
        for_each_member([&](const char*, const auto& from, auto& to) { view_value(from, to, memory); }, value, sample);
    }
    else if constexpr (std::is_same_v<Value, std::string>)
        sample = text(value);
    else if constexpr (requires { sample._buffer; })
    {
        using Item = std::remove_pointer_t<decltype(sample._buffer)>;
        sample._length = sample._maximum = static_cast<std::uint32_t>(value.size());
        sample._release = false;
        if constexpr (kSameLayout<typename Value::value_type, Item>)
            sample._buffer = reinterpret_cast<Item*>(const_cast<typename Value::value_type*>(value.data()));
        else
        {
            sample._buffer = memory.make<Item>(value.size());
            for (std::size_t i = 0; i < value.size(); ++i) view_value(value[i], sample._buffer[i], memory);
        }
    }
    else if constexpr (std::is_array_v<Sample>)
        std::copy(value.begin(), value.end(), std::begin(sample));
    else
    {
        static_assert(std::is_same_v<Value, Sample>);
        sample = value;
    }
}

/// Presents values as samples of one type, one at a time: a sample is valid until its value is changed or the next one is made.
template <class Sample>
class SampleView
{
public:
    template <class Value>
    const Sample& of(const Value& value)
    {
        memory_.clear();
        view_value(value, sample_, memory_);
        return sample_;
    }

private:
    Sample sample_{};
    SequenceMemory memory_;
};

}  // namespace plab::wire
