/// Small recordings in memory, and their expected content.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "idl/recording/reader.h"
#include "idl/recording/writer.h"

namespace plab::recording::test
{

inline constexpr Compression kCompressions[] = {Compression::None, Compression::Lz4, Compression::Zstd};

/// A file in memory that can be read while it grows.
class MemorySink final : public Sink
{
public:
    explicit MemorySink(std::shared_ptr<Bytes> bytes) : bytes_(std::move(bytes)) {}
    Result<void> append(ByteView more) override
    {
        bytes_->insert(bytes_->end(), more.begin(), more.end());
        return {};
    }
    Result<void> truncate(std::uint64_t size) override
    {
        bytes_->resize(size);
        return {};
    }
    Result<void> sync() override { return {}; }
    Result<void> close() override { return {}; }

private:
    std::shared_ptr<Bytes> bytes_;
};

inline ByteView view_of(const std::string& text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }
inline std::string text_of(ByteView bytes) { return {bytes.begin(), bytes.end()}; }

/// topic, log_time, publish_time, sequence, data
using Line = std::tuple<std::string, std::uint64_t, std::uint64_t, std::uint32_t, std::string>;
using Lines = std::vector<Line>;

inline Line line_of(const Found& found)
{
    const Message& m = found.message;
    return {found.channel->topic, m.log_time, m.publish_time, m.sequence, text_of(m.data)};
}

struct ReadBack
{
    Lines lines;
    Errors errors;
};

/// All that a query finds; gives up after `most` errors.
inline ReadBack read_all(const McapReader& reader, const Query& query = {}, std::size_t most = 1000)
{
    ReadBack out;
    Cursor messages = reader.messages(query);
    while (out.errors.size() < most)
    {
        auto next = messages.next();
        if (!next) out.errors.push_back(next.error());
        if (next && !*next) break;
        if (next) out.lines.push_back(line_of(**next));
    }
    return out;
}

inline Result<McapReader> open(ByteView bytes) { return McapReader::open(std::make_unique<MemorySource>(bytes)); }

inline const std::string kBlueprint = "<plab version=\"1\"/>";

/// A file of `chunks` chunks, each with two topics, and an attachment and metadata before them.
struct SampleFile
{
    Bytes bytes;
    Lines lines;
    std::vector<std::uint64_t> ends;  ///< of the file after each chunk

    SampleFile(Compression compression, int chunks, bool close = true)
    {
        using namespace std::chrono_literals;
        auto file = std::make_shared<Bytes>();
        WriterOptions options;
        options.compression = compression;
        auto writer = McapWriter::open(std::make_unique<MemorySink>(file), options).take();
        const auto schema = writer.add_schema({0, "plab::v2::Frame", "omgidl", "module plab {};"}).take();
        const auto states = writer.add_channel({0, schema, "plab/states", "cdr", {}}).take();
        const auto events = writer.add_channel({0, schema, "plab/events", "cdr", {{"key", "value"}}}).take();
        (void)writer.attach({0, 7, "blueprint.xml", "text/xml", view_of(kBlueprint)});
        (void)writer.add_metadata({"plab", {{"format", "2"}, {"server", "sample"}}});
        Clock::time_point now{};
        for (int chunk = 0; chunk < chunks; ++chunk)
        {
            for (int i = 0; i < 3; ++i) put(writer, states, "plab/states", chunk * 1000 + i * 100, now);
            put(writer, events, "plab/events", chunk * 1000 + 150, now);
            now += 20ms;
            writer.tick(now);
            ends.push_back(file->size());
        }
        if (close) (void)writer.close();
        bytes = *file;
        if (!close) bytes.resize(ends.empty() ? bytes.size() : ends.back());  // the writer's destructor closes it
    }

private:
    void put(McapWriter& writer, ChannelId channel, const std::string& topic, int time, Clock::time_point now)
    {
        const std::string data = topic + " at " + std::to_string(time) + std::string(20, 'x');
        const auto t = static_cast<std::uint64_t>(time);
        const auto number =
            static_cast<std::uint32_t>(std::count_if(lines.begin(), lines.end(), [&](const Line& l) { return std::get<0>(l) == topic; }));
        (void)writer.write({channel, 0, t, 5 + t, view_of(data)}, now);
        lines.emplace_back(topic, t, 5 + t, number, data);
    }
};

/// As a reader returns them.
inline Lines by_time(Lines lines)
{
    std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return std::get<1>(a) < std::get<1>(b); });
    return lines;
}

}  // namespace plab::recording::test
