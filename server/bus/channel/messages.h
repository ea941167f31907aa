/// What plabd and plab-bus say to each other, and messages as they go through a pipe.
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

inline constexpr std::size_t kStreams = static_cast<std::size_t>(publish::Stream::Snapshots) + 1;

/// From plabd to plab-bus.
enum class Down : std::uint32_t
{
    Start,      ///< StartMessage; the first one
    Catalogue,  ///< publish::CatalogueChange
    Status,     ///< StatusMessage
    Answer,     ///< AnswerMessage
    End,        ///< nothing; plab-bus says goodbye and ends
    Stream,     ///< Stream + s: a record of the stream s
};

/// From plab-bus to plabd, which believes none of it.
enum class Up : std::uint32_t
{
    Joined,   ///< nothing
    Failed,   ///< std::string: why it could not join; then it ends
    Wants,    ///< WantsMessage, on change
    Request,  ///< RequestMessage
    Lost,     ///< std::string: why this server must end
    Log,      ///< std::string
    Alive,    ///< nothing; once a second
};

struct StartMessage
{
    std::string name, version, network_interface;
    std::uint32_t domain = 0;
    std::int32_t process = 0;     ///< plabd's
    std::int64_t started_ns = 0;  ///< plabd was, since 1970
};

struct StatusMessage
{
    publish::Status status;
    std::array<std::uint64_t, kStreams> dropped{};  ///< records that rings gave up, by stream
};

struct AnswerMessage
{
    publish::Answer answer;
    bool repeated = false;
};

struct WantsMessage
{
    std::array<std::uint8_t, kStreams> wanted{};  ///< by stream; 0: nobody reads it
    std::array<std::uint64_t, kStreams> joins{};  ///< readers that came, ever
};

struct RequestMessage
{
    publish::RequestText request;
    std::string wrong;  ///< "", or why it was not copied in full
};

/// Before each message.
struct MessageHead
{
    std::uint32_t kind = 0;
    std::uint32_t unused = 0;
    std::uint64_t bytes = 0;
};

/// Messages into a pipe. One that finds too little room goes in pieces.
class MessageWriter
{
public:
    explicit MessageWriter(PipeWriter pipe) : pipe_(pipe) {}

    /// All that was sent is in the pipe: the next one may be sent.
    bool ready() const { return rest_.empty(); }
    /// Only when ready(). False if the other end's counter cannot be true.
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
    /// Goes on with what did not fit. False as above.
    bool flush();
    /// Something was put into the pipe: the other end must be woken. Asked once.
    bool committed() { return std::exchange(committed_, false); }

private:
    PipeWriter pipe_;
    bool committed_ = false;
    std::vector<std::byte> buffer_;
    std::span<const std::byte> rest_;  ///< of buffer_
};

/// Messages out of a pipe.
class MessageReader
{
public:
    /// `most`: bytes of a message; more is no message. `copies`: each is copied before it is looked at, so that nobody
    /// changes it meanwhile.
    MessageReader(PipeReader pipe, std::uint64_t most, bool copies) : pipe_(pipe), most_(most), copies_(copies) {}

    struct Message
    {
        std::uint32_t kind = 0;
        std::span<const std::byte> bytes;  ///< until the next call
    };
    enum class State : std::uint8_t
    {
        Nothing,
        Whole,
        Broken,  ///< what is there can be no message
    };
    State next(Message& message);
    /// The producer waited for room, and now there is some: it must be woken. Asked once.
    bool made_room() { return std::exchange(made_room_, false); }

private:
    void release(std::size_t bytes) { made_room_ = pipe_.release(bytes) || made_room_; }

    PipeReader pipe_;
    std::uint64_t most_;
    bool copies_;
    bool made_room_ = false;
    std::size_t held_ = 0;             ///< bytes of the pipe that the last message lies in
    std::optional<MessageHead> head_;  ///< of the message that comes in pieces
    std::vector<std::byte> buffer_;
};

}  // namespace plab::bus
