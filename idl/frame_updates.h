/// Frames as key frames and deltas (plab/updates), from complete frames. link/frame_reader.h makes complete frames of them again.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "idl/entity.h"

namespace plab::wire
{

inline constexpr std::uint8_t kKeyFrame = 0, kDelta = 1;              ///< FrameUpdate::kind
inline constexpr std::size_t kBodyNumbers = 13, kShaftNumbers = 2;    ///< per row of FrameUpdate::bodies and shafts
inline constexpr std::chrono::milliseconds kLongestBetweenKeys{900};  ///< so that a late joiner is complete within a second

/// Decides what a frame has to contain. A delta contains every object that has moved in any frame since the key frame, so that it
/// does not depend on other deltas, which slow readers lose. Objects that rested again are therefore sent once too often; as soon as
/// they add up to a whole frame, a key frame is sent: never more than twice what is necessary, and a delta is never larger than a
/// key frame.
class FrameUpdates
{
public:
    using Clock = std::chrono::steady_clock;

    /// Valid until the next call.
    const plab_v2_FrameUpdate& next(const plab_v2_Frame& frame, Clock::time_point now);
    /// The next one is a key frame: there is a new reader.
    void restart() { key_is_due_ = true; }

private:
    /// Rows of one kind of object. `numbers`: as last sent or found unchanged, row by row.
    struct Rows
    {
        std::vector<std::uint32_t> handles, sent_handles;
        std::vector<double> numbers, sent_numbers;
        std::vector<bool> moved;    ///< since the key frame
        std::size_t count = 0;      ///< of those that moved since the key frame
        std::size_t moved_now = 0;  ///< of those that moved in the last frame
    };
    template <std::size_t N, class Sequence>
    static bool has_same_objects(const Rows& rows, const Sequence& states);
    template <std::size_t N, class Sequence>
    static void compare(Rows& rows, const Sequence& states);
    template <std::size_t N, class Sequence>
    static void take_all(Rows& rows, const Sequence& states);
    template <std::size_t N>
    static void select_moved(Rows& rows);

    bool must_be_key(const plab_v2_Frame& frame, Clock::time_point now);
    void make_key(const plab_v2_Frame& frame, Clock::time_point now);
    void make_delta();

    Rows bodies_, shafts_;
    Clock::time_point key_time_{};
    std::uint64_t run_ = 0, revision_ = 0, key_number_ = 0;
    std::size_t wasted_ = 0;  ///< rows sent since the key frame that had not moved in that very frame
    bool key_is_due_ = true;
    plab_v2_FrameUpdate out_{};
};

/// Writes frames to plab/states and plab/updates, to each as long as it has readers.
class FrameWriter
{
public:
    static Result<FrameWriter> make(const Entity& participant, const Entity& publisher);

    /// DDS_RETCODE_OK or the first error; never blocks.
    dds_return_t write(const plab_v2_Frame& frame);
    /// Readers of both topics together.
    Matched matched() const;
    std::uint32_t readers() const { return matched().now; }
    const Entity& entity() const { return states_.entity(); }
    const DataWriter<plab_v2_FrameUpdate>& updates() const { return updates_; }

private:
    DataWriter<plab_v2_Frame> states_;
    DataWriter<plab_v2_FrameUpdate> updates_;
    FrameUpdates frames_;
    std::uint32_t seen_ = 0;  ///< readers of plab/updates that have ever been matched
};

}  // namespace plab::wire
