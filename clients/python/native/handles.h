/// What the handles of library.h stand for.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "link/caller.h"
#include "link/session.h"
#include "python/native/library.h"

/// Opened things keep a pointer to `session`: it does not move.
struct PlabSession
{
    plab::link::SessionOptions options;
    plab::link::Session session;
    std::optional<plab::link::Caller> caller;
    std::string text;  ///< what was returned last
};

namespace plab::python
{

/// A frame that stays when its sample is gone.
struct KeptFrame
{
    plab_v2_Frame head{};  ///< without its sequences
    std::vector<plab_v2_BodyState> bodies;
    std::vector<plab_v2_ShaftState> shafts;

    void keep(const plab_v2_Frame& frame)
    {
        head = frame;
        bodies.assign(frame.bodies._buffer, frame.bodies._buffer + frame.bodies._length);
        shafts.assign(frame.shafts._buffer, frame.shafts._buffer + frame.shafts._length);
    }
};

/// Rows are passed on as they lie in memory.
inline PlabFrame view_of(const plab_v2_Frame& head, const plab_v2_BodyState* bodies, std::size_t body_count,
                         const plab_v2_ShaftState* shafts, std::size_t shaft_count)
{
    static_assert(sizeof(plab_v2_BodyState) == 14 * sizeof(double) && offsetof(plab_v2_BodyState, position) == sizeof(double));
    static_assert(sizeof(plab_v2_ShaftState) == 3 * sizeof(double) && offsetof(plab_v2_ShaftState, angle) == sizeof(double));
    return {head.run,
            head.revision,
            head.sequence_number,
            head.step,
            head.time,
            head.stamp_ns,
            reinterpret_cast<const double*>(bodies),
            body_count,
            reinterpret_cast<const double*>(shafts),
            shaft_count};
}

}  // namespace plab::python
