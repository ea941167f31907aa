/// What waits for one page. It is bounded: of poses only the newest wait, and a page that does not take its messages loses all of them
/// and gets the whole scene again when it takes some.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string_view>
#include <vector>

#include "websocket/message.h"

namespace plab::web
{

using websocket::Message, websocket::MessagePtr;

/// The poses of one moment: a delta, and the key frame that it needs; or a key frame alone.
struct Poses
{
    std::uint64_t key_number = 0;
    MessagePtr key, delta;  ///< delta may be null
};

class Outbox
{
public:
    static constexpr std::size_t kMostMessages = 1024;
    static constexpr std::size_t kMostBytes = 4u << 20;  ///< a larger message is taken if nothing else waits
    static constexpr std::size_t kMostPoses = 3;         ///< sent and not yet acknowledged as drawn

    /// The page has the whole scene once this is sent: what was left out is made good.
    void begin(MessagePtr whole);
    /// The page looks at another server: what waits is dropped, and the page gets `first` and then the whole scene of that one.
    void begin_anew(MessagePtr first);
    /// Ignored while the page has not got the whole scene.
    void push(MessagePtr message);
    /// The newest replaces the one that waits.
    void put(const Poses& poses);
    /// The page has drawn one message of poses.
    void acknowledge();
    /// The next message to send; null: none, or the page must acknowledge first.
    MessagePtr take();

    /// It must get the whole scene, and has taken everything that came before.
    bool wants_all() const { return !is_current_ && messages_.empty(); }
    bool has_any() const { return !messages_.empty() || can_send_poses(); }
    std::uint64_t times_behind() const { return times_behind_; }
    std::uint64_t poses_replaced() const { return poses_replaced_; }

private:
    bool can_send_poses() const { return is_current_ && poses_.key != nullptr && unacknowledged_ < kMostPoses; }
    void add(MessagePtr message);

    std::deque<MessagePtr> messages_;
    std::size_t bytes_ = 0;
    Poses poses_;                 ///< key null: none waits
    std::uint64_t key_sent_ = 0;  ///< number of the key frame that the page has; 0: none
    std::size_t unacknowledged_ = 0;
    bool is_current_ = false;
    std::uint64_t times_behind_ = 0, poses_replaced_ = 0;
};

}  // namespace plab::web
