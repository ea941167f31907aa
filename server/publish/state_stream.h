/// Writes states of bodies into a large frame, past the caches of the processor.
///
/// Another thread reads the frame. The memory that it has read last lies in the caches of its processor, and an ordinary store has to fetch
/// it from there first, only to overwrite it; and the frame would push out what the next step reads. Streaming stores (SSE2, MOVNTPD) do
/// neither. They are not ordered with other stores, so the destructor orders them before what follows.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <new>

#include "publish/records.h"
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace plab::publish
{

class StateStream
{
public:
    StateStream() = default;
    StateStream(const StateStream&) = delete;
    StateStream& operator=(const StateStream&) = delete;

#if defined(__SSE2__)
    ~StateStream() { _mm_sfence(); }

    /// `to` is in a vector.
    void put(wire::BodyState& to, std::uint32_t handle, const Vec3& p, const Quat& q, const Vec3& v, const Vec3& w)
    {
        using State = wire::BodyState;
        static_assert(sizeof(State) == 14 * sizeof(double) && offsetof(State, handle) == 0 && offsetof(State, position) == 8);
        static_assert(offsetof(State, orientation) == 32 && offsetof(State, linear_velocity) == 64 &&
                      offsetof(State, angular_velocity) == 88);
        static_assert(sizeof(State) % 16 == 0 && __STDCPP_DEFAULT_NEW_ALIGNMENT__ >= 16);
        auto* const out = reinterpret_cast<double*>(&to);
        // Two at a time, as they lie in memory: the handle counts as a number of 8 bytes.
        _mm_stream_pd(out, _mm_set_pd(p.x, std::bit_cast<double>(std::uint64_t{handle})));
        _mm_stream_pd(out + 2, _mm_set_pd(p.z, p.y));
        _mm_stream_pd(out + 4, _mm_set_pd(q.x, q.w));
        _mm_stream_pd(out + 6, _mm_set_pd(q.z, q.y));
        _mm_stream_pd(out + 8, _mm_set_pd(v.y, v.x));
        _mm_stream_pd(out + 10, _mm_set_pd(w.x, v.z));
        _mm_stream_pd(out + 12, _mm_set_pd(w.z, w.y));
    }
#else
    void put(wire::BodyState& to, std::uint32_t handle, const Vec3& p, const Quat& q, const Vec3& v, const Vec3& w)
    {
        to = {handle, p, q, v, w};
    }
#endif
};

}  // namespace plab::publish
