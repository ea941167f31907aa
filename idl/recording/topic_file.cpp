#include "idl/recording/topic_file.h"

#include "idl/recording/topic_schema.h"

namespace plab::recording
{

void TopicFile::write(const wire::Topic& topic, ByteView sample, const Stamp& stamp)
{
    // A sample that is dropped because the disk fails is counted by the writer.
    if (const ChannelId channel = channel_of(topic); channel > 0)
        (void)writer_.write({channel, 0, stamp.log_time, stamp.publish_time, sample}, stamp.now);
}

ChannelId TopicFile::channel_of(const wire::Topic& topic)
{
    if (const auto known = channels_.find(&topic); known != channels_.end()) return known->second;
    const auto declared = declare(topic);
    if (!declared) refuse(declared.error());
    return channels_[&topic] = declared ? *declared : ChannelId{0};
}

Result<ChannelId> TopicFile::declare(const wire::Topic& topic)
{
    auto schema = schema_of(topic);
    if (!schema) return schema.errors();
    const auto schema_id = writer_.add_schema(schema.take());
    if (!schema_id) return schema_id.errors();
    return writer_.add_channel(recording::channel_of(topic, *schema_id));
}

void TopicFile::refuse(Error why)
{
    if (!refused_) refused_ = std::move(why);
}

void TopicFile::attach(std::uint64_t log_time, std::string name, std::string media_type, std::string text)
{
    pending_.push_back({log_time, std::move(name), std::move(media_type), std::move(text)});
    attach_pending();
}

void TopicFile::attach_pending()
{
    while (!pending_.empty())
    {
        const Enclosure& e = pending_.front();
        const auto* text = reinterpret_cast<const std::uint8_t*>(e.text.data());
        if (!writer_.attach({e.log_time, 0, e.name, e.media_type, {text, e.text.size()}})) return;
        pending_.pop_front();
    }
}

void TopicFile::retry()
{
    if (writer_.retry()) attach_pending();
}

Result<void> TopicFile::close()
{
    retry();
    if (!pending_.empty()) refuse(reason(pending_.front().name + " could not be stored in the recording"));
    auto closed = writer_.close();
    if (!closed || !refused_) return closed;
    return *refused_;
}

}  // namespace plab::recording
