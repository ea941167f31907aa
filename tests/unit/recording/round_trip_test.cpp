// Written messages are read back: all compressions, with and without index, by topic and time.
#include <doctest/doctest.h>

#include <algorithm>

#include "sample_file.h"

using namespace plab::recording;
using namespace plab::recording::test;

namespace
{

}  // namespace

TEST_CASE("a closed file is read by its index, message for message")
{
    for (const Compression compression : kCompressions)
    {
        CAPTURE(static_cast<int>(compression));
        const SampleFile file(compression, 5);
        auto reader = open(file.bytes);
        REQUIRE(reader);
        CHECK(reader->index().has_summary);
        CHECK(reader->index().is_closed);
        CHECK(reader->index().troubles.empty());
        CHECK(reader->index().header.profile == "plab");
        const ReadBack back = read_all(*reader);
        CHECK(back.errors.empty());
        CHECK(back.lines == by_time(file.lines));
    }
}

TEST_CASE("a file that was not closed is read by a scan, with the same content")
{
    for (const Compression compression : kCompressions)
    {
        CAPTURE(static_cast<int>(compression));
        const SampleFile file(compression, 5, false);
        const SampleFile closed(compression, 5);
        auto reader = open(file.bytes);
        REQUIRE(reader);
        CHECK(!reader->index().has_summary);
        CHECK(!reader->index().is_closed);
        CHECK(reader->index().troubles.empty());
        CHECK(reader->index().statistics == open(closed.bytes)->index().statistics);
        CHECK(reader->index().declarations.channels == open(closed.bytes)->index().declarations.channels);
        CHECK(read_all(*reader).lines == by_time(file.lines));
        CHECK(text_of(reader->attachment("blueprint.xml")->attachment.data) == kBlueprint);
        CHECK(reader->metadata("plab")->values.at("server") == "sample");
    }
}

TEST_CASE("statistics, attachments and metadata")
{
    const SampleFile file(Compression::Zstd, 5);
    auto reader = open(file.bytes);
    REQUIRE(reader);
    const Statistics& s = reader->index().statistics;
    CHECK(s.messages == 20);
    CHECK(s.channel_messages == std::map<ChannelId, std::uint64_t>{{1, 15}, {2, 5}});
    CHECK(s.chunks == 5);
    CHECK(s.start_time == 0);
    CHECK(s.end_time == 4200);
    auto attachment = reader->attachment("blueprint.xml");
    REQUIRE(attachment);
    CHECK(text_of(attachment->attachment.data) == kBlueprint);
    CHECK(attachment->attachment.media_type == "text/xml");
    CHECK(attachment->attachment.create_time == 7);
    CHECK(reader->attachment("other.xml").error().text() == "memory: has no attachment \"other.xml\"");
    CHECK(reader->metadata("plab")->values.at("format") == "2");
    CHECK(reader->schema_of(reader->channels().at(1))->data == "module plab {};");
    CHECK(reader->channels().at(2).metadata.at("key") == "value");
}

TEST_CASE("by topic and time window")
{
    const SampleFile file(Compression::Zstd, 50);
    auto reader = open(file.bytes);
    REQUIRE(reader);
    const Query query{{"plab/events"}, 10'150, 20'150};
    Lines wanted;
    for (const Line& line : by_time(file.lines))
        if (std::get<0>(line) == "plab/events" && std::get<1>(line) >= query.from && std::get<1>(line) <= query.to) wanted.push_back(line);
    CHECK(wanted.size() == 11);
    CHECK(read_all(*reader, query).lines == wanted);
    CHECK(read_all(*reader, {{"plab/none"}}).lines.empty());
    CHECK(read_all(*reader, {{}, 50'000}).lines.empty());
}

TEST_CASE("the last message at a time")
{
    const SampleFile file(Compression::Lz4, 50);
    auto reader = open(file.bytes);
    REQUIRE(reader);
    for (const std::uint64_t time : {0ull, 99ull, 100ull, 149ull, 150ull, 999ull, 7'150ull, 49'201ull, 99'999ull})
        for (const std::string topic : {"plab/states", "plab/events"})
        {
            CAPTURE(time);
            CAPTURE(topic);
            const Line* wanted = nullptr;
            for (const Line& line : file.lines)
                if (std::get<0>(line) == topic && std::get<1>(line) <= time) wanted = &line;
            auto found = reader->last_at(topic, time);
            REQUIRE(found);
            REQUIRE(found->has_value() == (wanted != nullptr));
            if (wanted != nullptr) CHECK(line_of({(*found)->channel, (*found)->message}) == *wanted);
        }
    CHECK(!reader->last_at("plab/none", 100)->has_value());
}

TEST_CASE("messages whose times decrease within and across chunks are read in order")
{
    auto bytes = std::make_shared<Bytes>();
    Lines wanted;
    {
        auto writer = McapWriter::open(std::make_unique<MemorySink>(bytes), {}).take();
        const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
        std::uint32_t number = 0;
        for (const std::uint64_t time : {50, 10, 40, 30, 10, 60, 20, 5})
        {
            const std::string data = std::to_string(time) + " " + std::to_string(number);
            CHECK(writer.write({channel, 0, time, 0, view_of(data)}, {}));
            if (number % 3 == 2) writer.flush();
            wanted.emplace_back("t", time, 0, number++, data);
        }
        CHECK(writer.close());
    }
    auto reader = open(*bytes);
    REQUIRE(reader);
    CHECK(reader->index().chunks.size() == 3);
    CHECK(read_all(*reader).lines == by_time(wanted));
    CHECK((*reader->last_at("t", 45))->message.log_time == 40);
    CHECK((*reader->last_at("t", 10))->message.sequence == 4);
}

TEST_CASE("of two messages at one time in overlapping chunks, the last is the later one in the file")
{
    auto bytes = std::make_shared<Bytes>();
    auto writer = McapWriter::open(std::make_unique<MemorySink>(bytes), {}).take();
    const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
    for (const std::uint64_t start : {10u, 5u})
    {
        for (const std::uint64_t time : {start, std::uint64_t{20}})
            CHECK(writer.write({channel, 0, time, 0, view_of("of the chunk from " + std::to_string(start))}, {}));
        writer.flush();
    }
    CHECK(writer.close());
    auto reader = open(*bytes);
    REQUIRE(reader);
    CHECK(text_of((*reader->last_at("t", 25))->data) == "of the chunk from 5");
    CHECK(text_of((*reader->last_at("t", 12))->data) == "of the chunk from 10");
    CHECK(text_of((*reader->last_at("t", 7))->data) == "of the chunk from 5");
}

TEST_CASE("a file without messages, and channels without messages, are whole files")
{
    auto bytes = std::make_shared<Bytes>();
    CHECK(McapWriter::open(std::make_unique<MemorySink>(bytes), {}).take().close());
    auto empty = open(*bytes);
    REQUIRE(empty);
    CHECK(empty->index().is_closed);
    CHECK(read_all(*empty).lines.empty());

    bytes = std::make_shared<Bytes>();
    auto writer = McapWriter::open(std::make_unique<MemorySink>(bytes), {}).take();
    REQUIRE(writer.add_channel({0, 0, "silent", "text", {}}));
    CHECK(writer.close());
    auto silent = open(*bytes);
    REQUIRE(silent);
    CHECK(silent->channels().at(1).topic == "silent");
    CHECK(silent->index().statistics.messages == 0);
    CHECK(read_all(*silent).lines.empty());
}

TEST_CASE("a file that is not a recording is refused with a reason")
{
    const auto why = [](const std::string& text)
    {
        const Bytes bytes(text.begin(), text.end());
        return open(bytes).error().text();
    };
    CHECK(why("") == "memory: is empty");
    CHECK(why("SQLite format 3 and more bytes") == "memory: is not an MCAP file: it does not begin with the magic bytes");
    CHECK(why("\x89MCAP0\r\n") == "memory: is not an MCAP file: it does not begin with the magic bytes");
    CHECK(why(std::string("\x89MCAP0\r\n\x06\0\0\0\0\0\0\0\0", 17)) == "memory: byte 8: a Header record is missing here");
    CHECK(McapReader::open("/none/such.mcap").error().text() == "/none/such.mcap: cannot open the recording: No such file or directory");
    CHECK(McapReader::open("/tmp").error().text() == "/tmp: is not a file; recordings are read from files");
}
