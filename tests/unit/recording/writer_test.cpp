// When chunks reach the file, and what happens when the disk fails.
#include <doctest/doctest.h>

#include <chrono>
#include <map>

#include "idl/recording/metadata.h"
#include "idl/recording/recovery.h"
#include "sample_file.h"

using namespace plab::recording;
using namespace plab::recording::test;
using namespace std::chrono_literals;
using plab::Result;

namespace
{

/// Fails at the n-th call and at the `more` calls after it; an append that fails has written a part.
class FailingSink final : public Sink
{
public:
    FailingSink(std::shared_ptr<Bytes> bytes, int first, int more) : bytes_(std::move(bytes)), first_(first), last_(first + more) {}
    Result<void> append(ByteView more) override
    {
        const bool fails = is_failing();
        const ByteView part = fails ? more.first(more.size() / 2) : more;
        bytes_->insert(bytes_->end(), part.begin(), part.end());
        return outcome(fails);
    }
    Result<void> truncate(std::uint64_t size) override
    {
        const bool fails = is_failing();
        if (!fails) bytes_->resize(size);
        return outcome(fails);
    }
    Result<void> sync() override { return outcome(is_failing()); }
    Result<void> close() override { return outcome(is_failing()); }

private:
    bool is_failing()
    {
        const int call = calls_++;
        return call >= first_ && call <= last_;
    }
    static Result<void> outcome(bool fails) { return fails ? plab::reason("no space left") : Result<void>(); }

    std::shared_ptr<Bytes> bytes_;
    int first_, last_, calls_ = 0;
};

struct Run
{
    std::shared_ptr<Bytes> bytes = std::make_shared<Bytes>();
    bool was_opened = false;
    std::uint64_t offered = 0;
    Losses dropped;
    std::uint64_t taken = 0;  ///< messages that write() accepted; later some of them may have been dropped with their chunk
    bool was_closed = false;
    std::uint64_t size = 0;  ///< which the writer guarantees
};

/// 40 messages in 10 chunks and two syncs; after a failure the writer is asked to try again every third chunk.
Run run(int first, int more)
{
    Run out;
    WriterOptions options;
    options.sync_time = 90ms;
    auto opened = McapWriter::open(std::make_unique<FailingSink>(out.bytes, first, more), options);
    out.was_opened = opened.ok();
    if (!opened) return out;
    McapWriter writer = opened.take();
    const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
    Clock::time_point now{};
    for (std::uint64_t i = 0; i < 40; ++i)
    {
        const std::string data = "message " + std::to_string(i);
        out.taken += writer.write({channel, 0, i, i, view_of(data)}, now) ? 1 : 0;
        ++out.offered;
        now += 5ms;
        writer.tick(now);
        if (i % 12 == 11) (void)writer.retry();
    }
    out.was_closed = writer.close().ok();
    out.size = writer.file_size();
    out.dropped = writer.dropped();
    return out;
}

}  // namespace

TEST_CASE("a chunk is written when it is old enough, with one write, and not before")
{
    auto bytes = std::make_shared<Bytes>();
    auto writer = McapWriter::open(std::make_unique<MemorySink>(bytes), {}).take();
    const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
    const std::size_t start = bytes->size();
    const Clock::time_point t0{};
    CHECK(!writer.due());
    CHECK(writer.write({channel, 0, 1, 1, view_of("a")}, t0 + 3ms));
    CHECK(writer.due() == t0 + 23ms);
    writer.tick(t0 + 22ms);
    CHECK(bytes->size() == start);
    CHECK(writer.write({channel, 0, 2, 2, view_of("b")}, t0 + 23ms));
    CHECK(bytes->size() > start);
    CHECK(writer.statistics().messages == 2);
    // What is written is synced a second later.
    CHECK(writer.due() == t0 + 1023ms);
    writer.tick(t0 + 1023ms);
    CHECK(!writer.due());
    auto reader = open(*bytes);
    REQUIRE(reader);
    CHECK(read_all(*reader).lines.size() == 2);
}

TEST_CASE("a chunk is written when it is large enough; a larger message has one of its own")
{
    auto bytes = std::make_shared<Bytes>();
    WriterOptions options;
    options.chunk_bytes = 1000;
    auto writer = McapWriter::open(std::make_unique<MemorySink>(bytes), options).take();
    const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
    for (const std::size_t size : {400u, 400u, 400u, 5000u, 400u})
        CHECK(writer.write({channel, 0, 0, 0, view_of(std::string(size, 'x'))}, {}));
    CHECK(writer.close());
    auto reader = open(*bytes);
    REQUIRE(reader);
    CHECK(reader->index().chunks.size() == 4);
    CHECK(read_all(*reader).lines.size() == 5);
}

TEST_CASE("messages that cannot be accepted are counted, and noted in the file")
{
    auto bytes = std::make_shared<Bytes>();
    WriterOptions options;
    options.most_message_bytes = 100;
    auto writer = McapWriter::open(std::make_unique<MemorySink>(bytes), options).take();
    CHECK(writer.add_channel({0, 3, "t", "text", {}}).error().text() == "channel t names schema 3, which does not exist");
    const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
    CHECK(!writer.write({channel, 0, 7, 0, view_of(std::string(101, 'x'))}, {}));
    CHECK(!writer.write({9, 0, 8, 0, view_of("x")}, {}));
    CHECK(writer.write({channel, 0, 9, 0, view_of("x")}, {}));
    CHECK(writer.add_gap({5, 50, 1, 2}, "the ring was full"));
    CHECK(writer.dropped().messages == 2);
    CHECK(writer.close());
    CHECK(writer.close().error().text() == "the recording is already closed");
    auto reader = open(*bytes);
    REQUIRE(reader);
    REQUIRE(reader->index().metadata.size() == 2);
    const auto ring = reader->metadata(reader->index().metadata[0]);
    REQUIRE(ring);
    CHECK(ring->name == "gap");
    CHECK(ring->values.at("messages") == "5");
    CHECK(ring->values.at("reason") == "the ring was full");
    const auto large = reader->metadata(reader->index().metadata[1]);
    REQUIRE(large);
    CHECK(large->values.at("messages") == "2");
    CHECK(large->values.at("from") == "7");
    CHECK(large->values.at("to") == "8");
    // The number of the message that was dropped is missing.
    CHECK(std::get<3>(read_all(*reader).lines.at(0)) == 1);
}

TEST_CASE("channels are declared again after a while, so that the rest of a file is self-contained")
{
    auto bytes = std::make_shared<Bytes>();
    auto writer = McapWriter::open(std::make_unique<MemorySink>(bytes), {}).take();
    const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
    Clock::time_point now{};
    for (std::uint64_t i = 0; i < 20; ++i, now += 1s) CHECK(writer.write({channel, 0, i, 0, view_of("x")}, now));
    CHECK(writer.close());
    std::size_t declarations = 0;
    ChunkData chunk;
    const auto reader = open(*bytes);
    REQUIRE(reader);
    for (const ChunkPlace& place : reader->index().chunks)
    {
        REQUIRE(chunk.load(MemorySource(*bytes), place.offset, {}));
        declarations += chunk.declarations().channels.size();
    }
    CHECK(declarations == 4);
}

TEST_CASE("an index that would take too much memory is dropped: the file is read by a scan, and is complete")
{
    auto bytes = std::make_shared<Bytes>();
    WriterOptions options;
    options.most_index_memory = 2000;
    auto writer = McapWriter::open(std::make_unique<MemorySink>(bytes), options).take();
    const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
    for (std::uint64_t i = 0; i < 100; ++i)
    {
        CHECK(writer.write({channel, 0, i, 0, view_of("x")}, {}));
        writer.flush();
    }
    CHECK(writer.close());
    auto reader = open(*bytes);
    REQUIRE(reader);
    CHECK(!reader->index().has_summary);
    CHECK(reader->index().is_closed);
    CHECK(reader->index().troubles.empty());
    CHECK(read_all(*reader).lines.size() == 100);
    auto report = recover(MemorySource(*bytes),
                          [] { return Result<std::unique_ptr<Sink>>(std::make_unique<MemorySink>(std::make_shared<Bytes>())); });
    REQUIRE(report);
    CHECK(report->verdict == Verdict::Whole);
    CHECK(report->mended == std::vector<std::string>{"the file had no index"});

    // One bit of the header's text: only the CRC of all data detects it.
    (*bytes)[kMagic.size() + kRecordHead + 4] ^= 1;
    report = recover(MemorySource(*bytes),
                     [] { return Result<std::unique_ptr<Sink>>(std::make_unique<MemorySink>(std::make_shared<Bytes>())); });
    REQUIRE(report);
    CHECK(report->messages == 100);
    CHECK(report->verdict == Verdict::SomethingLost);
    CHECK(report->mended == std::vector<std::string>{"the CRC of all data is wrong: some bytes have changed"});
}

TEST_CASE("a sink that fails at the n-th call, once, three times or for ever: all losses are counted, and the file stays readable")
{
    int failures = 0;
    for (const int more : {0, 2, 1000})
        for (int first = 0; first < 40; ++first)
        {
            CAPTURE(first);
            CAPTURE(more);
            const Run r = run(first, more);
            if (!r.was_opened)
            {
                CHECK(first == 0);
                continue;
            }
            auto reader = open(*r.bytes);
            REQUIRE(reader);
            const ReadBack back = read_all(*reader);
            CHECK(back.errors.empty());
            // No message is lost without being counted, duplicated or altered.
            CHECK(back.lines.size() + r.dropped.messages == r.offered);
            for (const Line& line : back.lines) CHECK(std::get<4>(line) == "message " + std::to_string(std::get<1>(line)));
            if (r.was_closed) CHECK(reader->index().has_summary);
            // Whichever call failed last, if it failed once: no part of a record or of a summary is left.
            if (more == 0 && !reader->index().has_summary) CHECK(r.bytes->size() == r.size);
            failures += r.dropped.messages > 0 ? 1 : 0;
            // If the disk recovered, the loss is noted in the file.
            std::uint64_t reported = 0;
            for (const MetadataIndex& place : reader->index().metadata)
                reported += std::stoull(reader->metadata(place)->values.at("messages"));
            if (r.was_closed) CHECK(reported == r.dropped.messages);
            auto found = recover(MemorySource(*r.bytes),
                                 [] { return Result<std::unique_ptr<Sink>>(std::make_unique<MemorySink>(std::make_shared<Bytes>())); });
            REQUIRE(found);
            CHECK(found->messages == back.lines.size());
        }
    CHECK(failures > 30);
}

TEST_CASE("a disk that recovers: the file continues after its last good record, and notes what is missing")
{
    // The third chunk (messages 8 to 11) fails, then truncating its part at the first and second attempt to continue.
    const Run r = run(3, 2);
    CHECK(r.was_closed);
    CHECK(r.dropped.messages == 28);
    CHECK(r.dropped.first_log_time == 8);
    CHECK(r.dropped.last_log_time == 35);
    auto reader = open(*r.bytes);
    REQUIRE(reader);
    CHECK(reader->index().troubles.empty());
    const auto gap = reader->metadata("gap");
    REQUIRE(gap);
    CHECK(gap->values.at("messages") == "28");
    CHECK(gap->values.at("reason") == "no space left");
    CHECK(seal_of(*gap) == Seal::Right);
}

TEST_CASE("the declarations of a lost chunk are written again")
{
    auto bytes = std::make_shared<Bytes>();
    auto writer = McapWriter::open(std::make_unique<FailingSink>(bytes, 1, 0), {}).take();
    const auto channel = writer.add_channel({0, 0, "t", "text", {}}).take();
    CHECK(writer.write({channel, 0, 1, 0, view_of("lost")}, {}));
    writer.flush();
    REQUIRE(writer.trouble());
    CHECK(!writer.write({channel, 0, 2, 0, view_of("lost")}, {}));
    CHECK(writer.retry());
    CHECK(writer.write({channel, 0, 3, 0, view_of("kept")}, {}));
    writer.flush();
    // As after a crash: without a summary that declares the channels.
    auto reader = open(*bytes);
    REQUIRE(reader);
    CHECK(reader->index().troubles.empty());
    const ReadBack back = read_all(*reader);
    CHECK(back.errors.empty());
    CHECK(back.lines == Lines{{"t", 3, 0, 2, "kept"}});
}

TEST_CASE("a seal detects every change")
{
    const Metadata good = sealed({"plab", {{"a", "1"}, {"b", "2"}}});
    CHECK(seal_of(good) == Seal::Right);
    CHECK(seal_of({"plab", {{"a", "1"}}}) == Seal::None);
    for (const auto& change : {Metadata{"plag", good.values}, Metadata{"plab", {{"a", "1"}, {"crc32", good.values.at("crc32")}}},
                               Metadata{"plab", {{"a", "2"}, {"b", "1"}, {"crc32", good.values.at("crc32")}}}})
        CHECK(seal_of(change) == Seal::Broken);
}
