#include "edited_recording.h"

#include <map>

#include "idl/recording/reader.h"
#include "idl/recording/writer.h"

namespace plab::test
{
namespace
{

using recording::ChannelId;

Result<std::map<ChannelId, ChannelId>> copy_channels(const recording::McapReader& reader, recording::McapWriter& writer)
{
    std::map<ChannelId, ChannelId> out;
    for (const auto& [id, channel] : reader.channels())
    {
        const recording::Schema* const schema = reader.schema_of(channel);
        if (schema == nullptr) return reason(channel.topic + " has no schema");
        const auto schema_id = writer.add_schema(*schema);
        if (!schema_id) return schema_id.errors();
        recording::Channel copy = channel;
        copy.schema_id = *schema_id;
        const auto channel_id = writer.add_channel(copy);
        if (!channel_id) return channel_id.errors();
        out[id] = *channel_id;
    }
    return out;
}

Result<void> copy_head(const recording::McapReader& reader, recording::McapWriter& writer, const Edits& edits)
{
    auto about = reader.metadata("plab");
    if (!about) return about.errors();
    if (edits.about) edits.about(about->values);
    if (auto added = writer.add_metadata(about.take()); !added) return added;
    const auto blueprint = reader.attachment("blueprint.xml");
    return blueprint ? writer.attach(blueprint->attachment) : Result<void>(blueprint.errors());
}

}  // namespace

Result<void> copy_recording(const std::string& from, const std::string& to, const Edits& edits)
{
    auto reader = recording::McapReader::open(from);
    if (!reader) return reader.errors();
    auto writer = recording::McapWriter::create(to, {}, recording::Overwrite::Yes);
    if (!writer) return writer.errors();
    if (auto done = copy_head(*reader, *writer, edits); !done) return done;
    const auto channels = copy_channels(*reader, *writer);
    if (!channels) return channels.errors();
    recording::Cursor messages = reader->messages();
    for (;;)
    {
        const auto next = messages.next();
        if (!next) return next.errors();
        if (!*next) return writer->close();
        const auto& [channel, message] = **next;
        recording::Bytes data(message.data.begin(), message.data.end());
        if (edits.message && !edits.message(channel->topic, data)) continue;
        // No time passes: chunks are closed by their size alone.
        (void)writer->write({channels->at(channel->id), 0, message.log_time, message.publish_time, data}, {});
    }
}

}  // namespace plab::test
