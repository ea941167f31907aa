/// Parts of ROS messages: sequences, times, vectors. A message is a C struct whose texts and sequences belong to somebody else.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <type_traits>

#include "idl/ros_topics.h"
#include "idl/samples.h"

namespace plab::ros
{

namespace msg = wire::ros;

/// Gives a sequence `count` elements, all zero, in this memory.
template <class Sequence>
auto make_sequence(Sequence& sequence, std::size_t count, wire::SequenceMemory& memory)
{
    using Item = std::remove_pointer_t<decltype(sequence._buffer)>;
    sequence._buffer = memory.make<Item>(count);
    sequence._length = sequence._maximum = static_cast<std::uint32_t>(count);
    sequence._release = false;
    return std::span<Item>(sequence._buffer, count);
}

/// Makes a sequence a view of these values.
template <class Sequence, class Value>
void show(Sequence& sequence, std::vector<Value>& values)
{
    static_assert(std::is_same_v<Value*, decltype(sequence._buffer)>);
    sequence._buffer = values.data(), sequence._release = false;
    sequence._length = sequence._maximum = static_cast<std::uint32_t>(values.size());
}

/// A text that lives as long as the memory.
inline char* copy_text(const std::string& text, wire::SequenceMemory& memory)
{
    char* const out = memory.make<char>(text.size() + 1);
    std::memcpy(out, text.c_str(), text.size() + 1);
    return out;
}

/// "" for none.
inline std::string text_of(const char* text) { return text == nullptr ? std::string() : std::string(text); }

/// Simulated seconds; ROS has whole seconds of 32 bits.
inline msg::Time time_of(double seconds)
{
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    constexpr std::int64_t kNanoseconds = 1'000'000'000;
    const double bounded = std::clamp(std::isnan(seconds) ? 0.0 : seconds, -kMost, kMost);
    double whole = std::floor(bounded);
    std::int64_t rest = std::llround((bounded - whole) * static_cast<double>(kNanoseconds));
    if (rest >= kNanoseconds) whole += 1, rest -= kNanoseconds;
    return {static_cast<std::int32_t>(std::min(whole, kMost)), static_cast<std::uint32_t>(rest)};
}

inline geometry_msgs_msg_dds__Vector3_ vector_of(const Vec3& v) { return {v.x, v.y, v.z}; }
inline geometry_msgs_msg_dds__Point_ point_of(const Vec3& v) { return {v.x, v.y, v.z}; }
inline geometry_msgs_msg_dds__Quaternion_ quaternion_of(const Quat& q) { return {q.x, q.y, q.z, q.w}; }
inline msg::RosPose pose_message(const Pose& X) { return {point_of(X.p), quaternion_of(X.q)}; }

inline Vec3 vector_from(const geometry_msgs_msg_dds__Vector3_& v) { return {v.x, v.y, v.z}; }
inline Pose pose_from(const msg::RosPose& X)
{
    return {{X.position.x, X.position.y, X.position.z}, {X.orientation.w, X.orientation.x, X.orientation.y, X.orientation.z}};
}

inline Vec3 vec(const plab_v2_Vector& v) { return {v.x, v.y, v.z}; }
inline Pose pose_of(const plab_v2_BodyState& b)
{
    return {vec(b.position), {b.orientation.w, b.orientation.x, b.orientation.y, b.orientation.z}};
}

}  // namespace plab::ros
