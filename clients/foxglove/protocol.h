/// The messages of Foxglove's web-socket protocol, whose subprotocols are foxglove.websocket.v1 and foxglove.sdk.v1: JSON texts with a
/// member `op`, and binary messages that begin with a byte for the same. Numbers in binary messages are little-endian.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "foxglove/channels.h"
#include "idl/json/json.h"
#include "idl/values/values.h"
#include "plab/result.h"
#include "websocket/message.h"

namespace plab::foxglove
{

using websocket::Message, websocket::MessagePtr, websocket::Outgoing;
using wire::Json;

// ---- To clients -----------------------------------------------------------------------------------------------------

MessagePtr text_message(const Json& json);

/// Times of a recording, ns.
struct TimeRange
{
    std::uint64_t from = 0, to = 0;
};
struct Offer
{
    std::string name, session;
    bool writes = true;                 ///< services, and setting parameters
    std::optional<TimeRange> playback;  ///< a recording is played, and can be controlled
};
Json server_info(const Offer& offer);
Json advertise_channels();

enum class Level : std::uint8_t
{
    Info = 0,
    Warning = 1,
    Error = 2,
};
/// `id`: replaces the message of the same id, and can be removed.
Json status(Level level, const std::string& sentence, const std::string& id = {});
Json remove_status(const std::string& id);
Json parameter_values(Json parameters, const std::string& id = {});
Json service_failure(std::uint32_t service, std::uint32_t call, const std::string& sentence);
MessagePtr service_response(std::uint32_t service, std::uint32_t call, const Json& reply);
MessagePtr time_message(std::uint64_t time);

/// What precedes the content of a channel's message.
void write_message_head(SubscriptionId subscription, std::uint64_t time, Outgoing& out);

enum class PlaybackStatus : std::uint8_t
{
    Playing = 0,
    Paused = 1,
    Buffering = 2,
    Ended = 3,
};
struct PlaybackState
{
    PlaybackStatus status = PlaybackStatus::Paused;
    std::uint64_t time = 0;  ///< ns, on the recording's time line
    float speed = 1;
    bool did_seek = false;
    std::string request;  ///< id of the request that it answers
};
MessagePtr playback_state(const PlaybackState& state);

// ---- From clients ---------------------------------------------------------------------------------------------------

struct Subscribe
{
    std::vector<std::pair<SubscriptionId, ChannelId>> subscriptions;
};
struct Unsubscribe
{
    std::vector<SubscriptionId> subscriptions;
};
struct GetParameters
{
    std::vector<std::string> names;  ///< none: all
    std::string id;
};
struct SetParameters
{
    std::vector<wire::NamedText> values;  ///< "gears.velocity_factor"; as requests write values
    std::string id;
};
struct WatchParameters
{
    std::vector<std::string> names;  ///< none: all
    bool watches = true;             ///< false: no longer
};
struct ServiceCall
{
    std::uint32_t service = 0, call = 0;
    std::string encoding, data;
};
struct PlaybackControl
{
    bool plays = false;
    float speed = 1;
    std::optional<std::uint64_t> seek;  ///< ns
    std::string request;
};
using Said = std::variant<Subscribe, Unsubscribe, GetParameters, SetParameters, WatchParameters, ServiceCall, PlaybackControl>;

inline constexpr std::size_t kMostReceived = 1u << 20;  ///< bytes of a message
inline constexpr std::size_t kMostNames = 1024;         ///< in a list of a message

/// An error says which member is wrong, or what is not offered.
Result<Said> parse_said(const std::string& bytes, bool is_binary);

}  // namespace plab::foxglove
