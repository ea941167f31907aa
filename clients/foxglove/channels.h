/// What can be subscribed to: every topic of the bus as it is, and the scene in Foxglove's own types, which its 3D panel draws.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "idl/topics.h"

namespace plab::foxglove
{

using ChannelId = std::uint32_t;
using SubscriptionId = std::uint32_t;  ///< chosen by a client

/// What waits for a client that does not keep up.
enum class Keep : std::uint8_t
{
    Newest,  ///< of each instance: states, the catalogue
    Log,     ///< all; the oldest are dropped, and the client is told
    Whole,   ///< changes of one thing; if some were dropped, the whole thing is sent anew
};

struct Channel
{
    ChannelId id = 0;
    std::string topic, schema_name, schema;  ///< messages are CDR, schemas OMG IDL
    Keep keep = Keep::Newest;
    const wire::Topic* source = nullptr;  ///< null: made here
};

inline constexpr const char* kSceneTopic = "/scene";        ///< foxglove::SceneUpdate
inline constexpr const char* kFramesTopic = "/tf";          ///< foxglove::FrameTransforms
inline constexpr const char* kContactsTopic = "/contacts";  ///< foxglove::SceneUpdate
inline constexpr const char* kWorldFrame = "world";

/// In the order of their ids, which count from 1.
std::span<const Channel> channels();
/// Null: there is none.
const Channel* find_channel(ChannelId id);
const Channel& channel_of(const std::string& topic);

}  // namespace plab::foxglove
