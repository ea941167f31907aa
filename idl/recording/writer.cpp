#include "idl/recording/writer.h"

#include <algorithm>
#include <limits>

#include "idl/recording/metadata.h"

namespace plab::recording
{
namespace
{

constexpr std::size_t kMostIds = std::numeric_limits<std::uint16_t>::max();

Metadata gap_record(const Losses& losses, const std::string& why)
{
    return sealed({"gap",
                   {{"messages", std::to_string(losses.messages)},
                    {"bytes", std::to_string(losses.bytes)},
                    {"from", std::to_string(losses.first_log_time)},
                    {"to", std::to_string(losses.last_log_time)},
                    {"reason", why}}});
}

}  // namespace

void Losses::add(const Losses& more)
{
    if (more.messages == 0) return;
    first_log_time = messages == 0 ? more.first_log_time : std::min(first_log_time, more.first_log_time);
    last_log_time = messages == 0 ? more.last_log_time : std::max(last_log_time, more.last_log_time);
    messages += more.messages;
    bytes += more.bytes;
}

Result<McapWriter> McapWriter::open(std::unique_ptr<Sink> sink, WriterOptions options)
{
    auto container = Container::begin(std::move(sink), {options.profile, options.library}, options.most_index_memory);
    if (!container) return container.errors();
    return McapWriter(container.take(), std::move(options));
}

Result<McapWriter> McapWriter::create(const std::string& path, WriterOptions options, Overwrite overwrite)
{
    auto sink = FileSink::open(path, overwrite);
    if (!sink) return sink.errors();
    return open(std::make_unique<FileSink>(sink.take()), std::move(options));
}

McapWriter::McapWriter(Container container, WriterOptions options)
    : options_(std::move(options)), container_(std::move(container)), compressor_(options_.compression, options_.level)
{
}

McapWriter::~McapWriter()
{
    if (container_.is_open()) (void)close();
}

Result<std::uint16_t> McapWriter::add_schema(Schema schema)
{
    if (schemas_.size() >= kMostIds) return reason("more schemas than a file can hold");
    schema.id = static_cast<std::uint16_t>(schemas_.size() + 1);
    container_.declare(schema);
    schemas_.push_back(std::move(schema));
    return schemas_.back().id;
}

Result<ChannelId> McapWriter::add_channel(Channel channel)
{
    if (channels_.size() >= kMostIds) return reason("more channels than a file can hold");
    if (channel.schema_id > schemas_.size())
        return reason("channel " + channel.topic + " names schema " + std::to_string(channel.schema_id) + ", which does not exist");
    channel.id = static_cast<ChannelId>(channels_.size() + 1);
    container_.declare(channel);
    channels_.push_back({std::move(channel)});
    return channels_.back().channel.id;
}

void McapWriter::forget_declarations()
{
    for (Known& known : channels_) known.is_declared = false;
}

/// Each chunk is preceded by the declarations that its messages refer to. They are repeated after a while: see
/// WriterOptions::declare_time.
void McapWriter::declare(ChannelId id, Clock::time_point now)
{
    if (now - declared_since_ > options_.declare_time)
    {
        forget_declarations();
        declared_since_ = now;
    }
    Known& known = channels_[id - 1u];
    if (known.is_declared) return;
    if (known.channel.schema_id > 0) chunk_.add(schemas_[known.channel.schema_id - 1u]);
    chunk_.add(known.channel);
    known.is_declared = known.was_declared = true;
}

bool McapWriter::write(const Message& message, Clock::time_point now)
{
    now_ = now;
    const bool is_known = message.channel > 0 && message.channel <= channels_.size();
    const std::uint32_t sequence = is_known ? channels_[message.channel - 1u].next_sequence++ : 0;
    if (!is_known || trouble_ || message.data.size() > options_.most_message_bytes)
    {
        drop({1, message.data.size(), message.log_time, message.log_time});
        return false;
    }
    if (!chunk_.empty() && chunk_.size() + message.data.size() > options_.chunk_bytes) flush();
    if (chunk_.empty()) chunk_since_ = now;
    declare(message.channel, now);
    Message numbered = message;
    numbered.sequence = sequence;
    chunk_.add(numbered);
    tick(now);
    return true;
}

void McapWriter::drop(const Losses& losses)
{
    dropped_.add(losses);
    gap_.add(losses);
}

void McapWriter::fail(const Error& error)
{
    trouble_ = error;
    unsynced_since_.reset();
}

Result<void> McapWriter::note(Result<void> done)
{
    if (!done) fail(done.error());
    if (done && !unsynced_since_) unsynced_since_ = now_;
    return done;
}

void McapWriter::flush()
{
    if (chunk_.empty()) return;
    if (!trouble_)
    {
        out_.clear();
        auto index = chunk_.write(out_, compressor_);
        (void)note(index ? container_.put_chunk(out_, index.take(), chunk_.contents()) : Result<void>(index.errors()));
    }
    if (trouble_) drop_chunk();
    chunk_.clear();
    if (!trouble_) (void)note_gap("larger than a message may be, or without a channel");
}

void McapWriter::drop_chunk()
{
    const ChunkContents& contents = chunk_.contents();
    drop({contents.total, chunk_.size(), contents.start_time, contents.end_time});
    for (Known& known : channels_)
        if (known.is_declared) known.is_declared = known.was_declared = false;
}

Result<void> McapWriter::note_gap(const std::string& why)
{
    if (gap_.messages == 0) return {};
    auto done = note(container_.put(gap_record(gap_, why)));
    if (done) gap_ = {};
    return done;
}

Result<void> McapWriter::attach(const Attachment& attachment)
{
    if (trouble_) return *trouble_;
    return note(container_.put(attachment));
}

Result<void> McapWriter::add_metadata(Metadata metadata)
{
    if (trouble_) return *trouble_;
    return note(container_.put(sealed(std::move(metadata))));
}

Result<void> McapWriter::add_gap(const Losses& losses, const std::string& why)
{
    Result<void> done;
    if (!trouble_) done = note(container_.put(gap_record(losses, why)));
    if (trouble_) gap_.add(losses);  // noted when the disk works again
    return done;
}

void McapWriter::tick(Clock::time_point now)
{
    now_ = now;
    if (!chunk_.empty() && now - chunk_since_ >= options_.chunk_time) flush();
    if (unsynced_since_ && options_.sync_time.count() > 0 && now - *unsynced_since_ >= options_.sync_time) sync();
}

void McapWriter::sync()
{
    unsynced_since_.reset();
    if (auto done = container_.sync(); !done) fail(done.error());
}

std::optional<Clock::time_point> McapWriter::due() const
{
    std::optional<Clock::time_point> first;
    if (!chunk_.empty()) first = chunk_since_ + options_.chunk_time;
    if (unsynced_since_ && options_.sync_time.count() > 0)
    {
        const auto next_sync = *unsynced_since_ + options_.sync_time;
        first = first ? std::min(*first, next_sync) : next_sync;
    }
    return first;
}

Result<void> McapWriter::retry()
{
    if (!trouble_) return {};
    if (auto done = container_.repair(); !done) return note(done);
    if (auto done = note_gap(trouble_->text()); !done) return done;
    if (auto done = container_.sync(); !done) return note(done);
    trouble_.reset();
    return {};
}

/// A channel without messages is in no chunk yet, but the summary may only repeat what is in the data.
void McapWriter::declare_rest()
{
    for (Known& known : channels_)
        if (!known.was_declared) declare(known.channel.id, now_);
}

Result<void> McapWriter::close()
{
    if (!container_.is_open()) return reason("the recording is already closed");
    auto tried = retry();
    declare_rest();
    flush();
    if (trouble_ && tried) tried = retry();
    auto finished = container_.finish();
    return trouble_ ? Result<void>(*trouble_) : finished;
}

}  // namespace plab::recording
