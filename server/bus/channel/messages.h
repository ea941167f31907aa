/// The messages between plabd and plab-bus, and how they pass through a pipe.
#pragma once

#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "bus/channel/archive.h"
#include "bus/channel/pipe.h"
#include "publish/observer.h"

namespace plab::bus
{

inline constexpr std::size_t kStreams = static_cast<std::size_t>(publish::Stream::Contacts) + 1;

/// From plabd to plab-bus.
enum class Down : std::uint32_t
{
    Start,      ///< StartMessage; the first one
    Catalogue,  ///< publish::CatalogueChange
    Status,     ///< StatusMessage
    Answer,     ///< wire::Reply
    End,        ///< no content; plab-bus announces the end of the server and ends
    Stream,     ///< Stream + s: one record of stream s
};

/// From plab-bus to plabd, which validates all of it.
enum class Up : std::uint32_t
{
    Joined,   ///< no content
    Failed,   ///< std::string: why it could not join; then it ends
    Wants,    ///< WantsMessage, on change
    Request,  ///< RequestMessage
    Lost,     ///< std::string: why this server must end
    Log,      ///< std::string
    Alive,    ///< no content; sent once per second
    User,     ///< PersonMessage of a wire::UserSample
    Viewer,   ///< PersonMessage of a wire::ViewerSample
};

struct StartMessage
{
    std::string name, version, network_interface;
    std::uint32_t domain = 0;
    std::int32_t process = 0;     ///< process id of plabd
    std::int64_t started_ns = 0;  ///< start time of plabd, ns since 1970
    std::string ros_space;        ///< of plab-bus-ros: RosOptions
    double ros_rate = 0;
};
PLAB_MEMBERS(StartMessage, name, version, network_interface, domain, process, started_ns, ros_space, ros_rate)

struct StatusMessage
{
    wire::Server status;
    std::array<std::uint64_t, kStreams> dropped{};  ///< records that the rings dropped, by stream
};
PLAB_MEMBERS(StatusMessage, status, dropped)

struct WantsMessage
{
    std::array<std::uint8_t, kStreams> wanted{};  ///< by stream; 0: it has no reader
    std::array<std::uint64_t, kStreams> joins{};  ///< number of readers that have joined since the start
};
PLAB_MEMBERS(WantsMessage, wanted, joins)

struct RequestMessage
{
    wire::Request request;
    std::string wrong;  ///< "", or why the request was not copied completely
};
PLAB_MEMBERS(RequestMessage, request, wrong)

/// The newest sample of a client for one component.
template <class Sample>
struct PersonMessage
{
    Sample sample;
    bool gone = false;          ///< its instance was disposed of, or it has no writer any more
    std::uint64_t skipped = 0;  ///< samples that a newer one replaced since the last message
};
using UserMessage = PersonMessage<wire::UserSample>;
using ViewerMessage = PersonMessage<wire::ViewerSample>;
PLAB_MEMBERS(UserMessage, sample, gone, skipped)
PLAB_MEMBERS(ViewerMessage, sample, gone, skipped)

/// Precedes each message.
struct MessageHead
{
    std::uint32_t kind = 0;
    std::uint32_t unused = 0;
    std::uint64_t bytes = 0;
};

/// Writes messages into a pipe. A message that finds too little room is sent in pieces.
class MessageWriter
{
public:
    explicit MessageWriter(PipeWriter pipe) : pipe_(pipe) {}

    /// Whether everything sent so far is in the pipe, so that the next message may be sent.
    bool ready() const { return rest_.empty(); }
    /// Call only when ready(). False if the other end's counter is invalid.
    template <class Kind, class... Record>
    bool send(Kind kind, const Record&... record)
    {
        const auto room = pipe_.room();
        if (!room) return false;
        MessageHead head{static_cast<std::uint32_t>(kind), 0, 0};
        Encoder encoder(room->size() > sizeof head ? room->subspan(sizeof head) : std::span<std::byte>{});
        (encoder.put(record), ...);
        head.bytes = encoder.size();
        if (sizeof head + encoder.size() <= room->size())
        {
            std::memcpy(room->data(), &head, sizeof head);
            pipe_.commit(sizeof head + encoder.size());
            return committed_ = true;
        }
        buffer_.resize(sizeof head + encoder.size());
        std::memcpy(buffer_.data(), &head, sizeof head);
        Encoder again(std::span<std::byte>(buffer_).subspan(sizeof head));
        (again.put(record), ...);
        rest_ = buffer_;
        return flush();
    }
    /// Continues with the data that did not fit. The result is as above.
    bool flush();
    /// Whether something was put into the pipe since the last call, so that the other end must be woken.
    bool committed() { return std::exchange(committed_, false); }

private:
    PipeWriter pipe_;
    bool committed_ = false;
    std::vector<std::byte> buffer_;
    std::span<const std::byte> rest_;  ///< of buffer_
};

/// Reads messages from a pipe.
class MessageReader
{
public:
    /// `most`: largest valid size of a message, in bytes. `copies`: copy each message before decoding it, so that the other
    /// process cannot change it meanwhile.
    MessageReader(PipeReader pipe, std::uint64_t most, bool copies) : pipe_(pipe), most_(most), copies_(copies) {}

    struct Message
    {
        std::uint32_t kind = 0;
        std::span<const std::byte> bytes;  ///< valid until the next call
    };
    enum class State : std::uint8_t
    {
        Nothing,
        Whole,
        Broken,  ///< the bytes cannot be a message
    };
    State next(Message& message);
    /// Whether the producer waited for room and there is some now since the last call, so that it must be woken.
    bool made_room() { return std::exchange(made_room_, false); }

private:
    void release(std::size_t bytes) { made_room_ = pipe_.release(bytes) || made_room_; }

    PipeReader pipe_;
    std::uint64_t most_;
    bool copies_;
    bool made_room_ = false;
    std::size_t held_ = 0;             ///< bytes of the pipe that the last message occupies
    std::optional<MessageHead> head_;  ///< header of a message that arrives in pieces
    std::vector<std::byte> buffer_;
};

}  // namespace plab::bus
