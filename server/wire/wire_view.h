/// Views of host values as wire values: same layout, no copy.
#pragma once

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include "idl/topics.h"
#include "publish/records.h"

namespace plab::wire
{

// A frame's arrays are sent without conversion. These assertions fail if either layout changes.
static_assert(sizeof(Vec3) == sizeof(plab_v2_Vector) && alignof(Vec3) == alignof(plab_v2_Vector));
static_assert(offsetof(Vec3, x) == offsetof(plab_v2_Vector, x) && offsetof(Vec3, y) == offsetof(plab_v2_Vector, y) &&
              offsetof(Vec3, z) == offsetof(plab_v2_Vector, z));
static_assert(sizeof(Quat) == sizeof(plab_v2_Rotation) && alignof(Quat) == alignof(plab_v2_Rotation));
static_assert(offsetof(Quat, w) == offsetof(plab_v2_Rotation, w) && offsetof(Quat, x) == offsetof(plab_v2_Rotation, x) &&
              offsetof(Quat, y) == offsetof(plab_v2_Rotation, y) && offsetof(Quat, z) == offsetof(plab_v2_Rotation, z));
static_assert(sizeof(publish::BodyState) == sizeof(plab_v2_BodyState) && alignof(publish::BodyState) == alignof(plab_v2_BodyState));
static_assert(offsetof(publish::BodyState, handle) == offsetof(plab_v2_BodyState, handle) &&
              offsetof(publish::BodyState, position) == offsetof(plab_v2_BodyState, position) &&
              offsetof(publish::BodyState, orientation) == offsetof(plab_v2_BodyState, orientation) &&
              offsetof(publish::BodyState, linear_velocity) == offsetof(plab_v2_BodyState, linear_velocity) &&
              offsetof(publish::BodyState, angular_velocity) == offsetof(plab_v2_BodyState, angular_velocity));
static_assert(sizeof(publish::ShaftState) == sizeof(plab_v2_ShaftState) && alignof(publish::ShaftState) == alignof(plab_v2_ShaftState));
static_assert(offsetof(publish::ShaftState, handle) == offsetof(plab_v2_ShaftState, handle) &&
              offsetof(publish::ShaftState, angle) == offsetof(plab_v2_ShaftState, angle) &&
              offsetof(publish::ShaftState, speed) == offsetof(plab_v2_ShaftState, speed));

template <class Host, class Wire>
inline constexpr bool kSameLayout = std::is_same_v<Host, Wire>;
template <>
inline constexpr bool kSameLayout<Vec3, plab_v2_Vector> = true;
template <>
inline constexpr bool kSameLayout<publish::BodyState, plab_v2_BodyState> = true;
template <>
inline constexpr bool kSameLayout<publish::ShaftState, plab_v2_ShaftState> = true;

inline plab_v2_Vector vector(const Vec3& v) { return {v.x, v.y, v.z}; }
inline plab_v2_Rotation rotation(const Quat& q) { return {q.w, q.x, q.y, q.z}; }

/// Makes a wire sequence point to a vector's elements, which the vector still owns.
template <class Sequence, class T>
void view(Sequence& sequence, const std::vector<T>& elements)
{
    using Wire = std::remove_pointer_t<decltype(sequence._buffer)>;
    static_assert(kSameLayout<T, Wire>);
    sequence._length = sequence._maximum = static_cast<std::uint32_t>(elements.size());
    sequence._buffer = reinterpret_cast<Wire*>(const_cast<T*>(elements.data()));
    sequence._release = false;
}

}  // namespace plab::wire
