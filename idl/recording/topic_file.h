/// Our topics in a recording: their schemas and channels, so that any tool can decode them, and their samples.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "idl/recording/records.h"
#include "idl/recording/writer.h"
#include "idl/topics.h"
#include "plab/result.h"

namespace plab::recording
{

/// `type_name` ("plab::v2::Frame") and all types that it uses, extracted from idl/plab.idl: self-contained OMG IDL without
/// comments.
Result<std::string> idl_of(std::string_view type_name);
/// As above, from any IDL whose declarations are in one scope of modules ("module a { module b { ... }; };").
Result<std::string> select_idl(std::string_view idl, std::string_view type_name);

/// Encoding "omgidl"; without id.
Result<Schema> schema_of(const wire::Topic& topic);
/// Message encoding "cdr"; without id.
Channel channel_of(const wire::Topic& topic, std::uint16_t schema_id);

template <class T>
Result<Schema> schema_of()
{
    return schema_of(wire::topic_of<T>());
}
template <class T>
Channel channel_of(std::uint16_t schema_id)
{
    return channel_of(wire::topic_of<T>(), schema_id);
}

/// Position of a sample on the recording's time line.
struct Stamp
{
    std::uint64_t log_time = 0;      ///< ns
    std::uint64_t publish_time = 0;  ///< ns since 1970
    Clock::time_point now{};
};

/// Samples into a recording by their topic. The schema and the channel of a topic are declared with its first sample.
/// Used by one thread. Trouble with the disk is McapWriter's; what the file itself cannot take is refused().
class TopicFile
{
public:
    explicit TopicFile(McapWriter writer) : writer_(std::move(writer)) {}

    void write(const wire::Topic& topic, ByteView sample, const Stamp& stamp);
    /// Stored as soon as the disk accepts it.
    void attach(std::uint64_t log_time, std::string name, std::string media_type, std::string text);
    void add_gap(const Losses& losses, const std::string& why) { (void)writer_.add_gap(losses, why); }
    /// A sample that cannot be written, whatever the disk does. The first reason is kept.
    void refuse(Error why);
    const std::optional<Error>& refused() const { return refused_; }

    void tick(Clock::time_point now) { writer_.tick(now); }
    /// Retries a disk that failed, and stores what has waited for it.
    void retry();
    /// Completes the file. An error: not everything is in it.
    Result<void> close();
    const McapWriter& writer() const { return writer_; }

private:
    struct Enclosure
    {
        std::uint64_t log_time = 0;
        std::string name, media_type, text;
    };
    ChannelId channel_of(const wire::Topic& topic);
    Result<ChannelId> declare(const wire::Topic& topic);
    void attach_pending();

    McapWriter writer_;
    std::map<const wire::Topic*, ChannelId> channels_;  ///< 0: refused
    std::deque<Enclosure> pending_;
    std::optional<Error> refused_;
};

}  // namespace plab::recording
