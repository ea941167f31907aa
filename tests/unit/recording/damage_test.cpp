// Truncated or altered files: nothing crashes, no altered message is returned as good, and what can be recovered is recovered.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "idl/recording/recovery.h"
#include "sample_file.h"

using namespace plab::recording;
using namespace plab::recording::test;
using plab::Result;

namespace
{

struct Recovered
{
    Result<RecoveryReport> report;
    Bytes bytes;
};

Recovered recover_bytes(ByteView bytes)
{
    auto out = std::make_shared<Bytes>();
    auto report = recover(MemorySource(bytes), [&] { return Result<std::unique_ptr<Sink>>(std::make_unique<MemorySink>(out)); });
    return {std::move(report), *out};
}

bool is_part_of(const Lines& part, const Lines& all)
{
    return std::all_of(part.begin(), part.end(),
                       [&](const Line& line) { return std::ranges::count(all, line) == std::ranges::count(part, line); });
}

/// Whatever a reader returns must be as it was written.
void check_reader(ByteView bytes, const SampleFile& file)
{
    auto reader = open(bytes);
    if (!reader) return;
    const ReadBack back = read_all(*reader);
    if (!is_part_of(back.lines, file.lines)) FAIL_CHECK("a reader returns a message that was never written");
    if (back.errors.empty() && reader->index().has_summary && back.lines.size() != file.lines.size())
        FAIL_CHECK("a reader leaves out messages without reporting it");
    for (const std::string topic : {"plab/states", "plab/events"})
        if (auto found = reader->last_at(topic, 2'150); found && *found)
            if (std::ranges::count(file.lines, line_of({(*found)->channel, (*found)->message})) != 1)
                FAIL_CHECK("the last message at a time was never written");
    if (auto attachment = reader->attachment("blueprint.xml")) CHECK(text_of(attachment->attachment.data) == kBlueprint);
    if (auto metadata = reader->metadata("plab")) CHECK(metadata->values.at("server") == "sample");
}

/// A recovery writes an undamaged file of messages as they were written. Returns their number.
std::size_t check_recovery(ByteView bytes, const SampleFile& file)
{
    const Recovered out = recover_bytes(bytes);
    REQUIRE(out.report);
    if (out.report->verdict == Verdict::NothingUsable)
    {
        CHECK(out.bytes.empty());
        return 0;
    }
    auto reader = open(out.bytes);
    REQUIRE(reader);
    CHECK(reader->index().has_summary);
    CHECK(reader->index().troubles.empty());
    const ReadBack back = read_all(*reader);
    CHECK(back.errors.empty());
    if (!is_part_of(back.lines, file.lines)) FAIL_CHECK("a recovery writes a message that was never written");
    CHECK(out.report->messages == back.lines.size());
    if (auto attachment = reader->attachment("blueprint.xml")) CHECK(text_of(attachment->attachment.data) == kBlueprint);
    if (auto metadata = reader->metadata("plab")) CHECK(metadata->values.at("server") == "sample");
    const bool has_all = back.lines.size() == file.lines.size() && reader->attachment("blueprint.xml") && reader->metadata("plab");
    if (out.report->verdict == Verdict::Whole && !has_all) FAIL_CHECK("a recovery reports a whole file, but messages are missing");
    return back.lines.size();
}

}  // namespace

TEST_CASE("a whole file is whole")
{
    for (const Compression compression : kCompressions)
    {
        const SampleFile file(compression, 5);
        const Recovered out = recover_bytes(file.bytes);
        REQUIRE(out.report);
        CHECK(out.report->verdict == Verdict::Whole);
        CHECK(exit_code(out.report->verdict) == 0);
        CHECK(out.report->lost.empty());
        CHECK(out.report->mended.empty());
        CHECK(out.report->unproved == 0);
        CHECK(out.report->kept == std::map<std::string, std::uint64_t>{{"plab/events", 5}, {"plab/states", 15}});
        CHECK(read_all(*open(out.bytes)).lines == by_time(file.lines));
    }
}

TEST_CASE("cut at every byte of the last chunk: all chunks before it are recovered and read")
{
    for (const Compression compression : kCompressions)
    {
        CAPTURE(static_cast<int>(compression));
        const SampleFile file(compression, 4, false);
        const std::size_t before = file.ends[2], end = file.ends[3];
        const Lines kept(file.lines.begin(), file.lines.begin() + 12);
        int whole_chunks = 0;
        for (std::size_t size = before; size <= end; ++size)
        {
            const ByteView cut = ByteView(file.bytes).first(size);
            auto reader = open(cut);
            REQUIRE(reader);
            const Lines lines = read_all(*reader).lines;
            const Recovered out = recover_bytes(cut);
            REQUIRE(out.report);
            REQUIRE(out.report->verdict == Verdict::SomethingLost);
            REQUIRE(read_all(*open(out.bytes)).lines == lines);
            // The last chunk counts as soon as it is complete: the indexes after it may be cut.
            const bool has_last = lines.size() == 16;
            whole_chunks += has_last ? 1 : 0;
            REQUIRE(lines == by_time(has_last ? file.lines : kept));
        }
        CHECK(whole_chunks > 1);
        CHECK(whole_chunks < static_cast<int>(end - before) / 2);
    }
}

TEST_CASE("cut at every byte of a closed file")
{
    const SampleFile file(Compression::Zstd, 3);
    std::size_t last = 0;
    for (std::size_t size = 0; size < file.bytes.size(); ++size)
    {
        CAPTURE(size);
        check_reader(ByteView(file.bytes).first(size), file);
        const std::size_t saved = check_recovery(ByteView(file.bytes).first(size), file);
        CHECK(saved >= last);
        last = saved;
    }
    CHECK(last == file.lines.size());
}

TEST_CASE("every byte of a closed file changed, one at a time")
{
    for (const Compression compression : kCompressions)
    {
        const SampleFile file(compression, 3);
        Bytes altered = file.bytes;
        std::size_t least = file.lines.size();
        for (std::size_t i = 0; i < altered.size(); ++i)
            for (const int change : {0x01, 0x80, 0xff})
            {
                CAPTURE(static_cast<int>(compression));
                CAPTURE(i);
                CAPTURE(change);
                altered[i] = static_cast<std::uint8_t>(altered[i] ^ change);
                check_reader(altered, file);
                least = std::min(least, check_recovery(altered, file));
                altered[i] = file.bytes[i];
            }
        // One change can cost at most one of three chunks.
        CHECK(least == 8);
    }
}

TEST_CASE("every byte of a file that was not closed changed, one at a time")
{
    const SampleFile file(Compression::Lz4, 3, false);
    Bytes altered = file.bytes;
    for (std::size_t i = 0; i < altered.size(); ++i)
    {
        CAPTURE(i);
        altered[i] = static_cast<std::uint8_t>(altered[i] ^ 0x55);
        check_reader(altered, file);
        (void)check_recovery(altered, file);
        altered[i] = file.bytes[i];
    }
}

TEST_CASE("changed times in a chunk's header: with an index nothing is lost, without one it is an error")
{
    const SampleFile closed(Compression::Zstd, 5);
    Bytes altered = closed.bytes;
    const std::size_t place = closed.ends[1] + kRecordHead;
    altered[place] = static_cast<std::uint8_t>(altered[place] ^ 0x01);  // start_time
    CHECK(read_all(*open(altered)).lines == by_time(closed.lines));
    const Recovered whole = recover_bytes(altered);
    REQUIRE(whole.report);
    CHECK(whole.report->verdict == Verdict::Whole);
    CHECK(whole.report->mended.size() == 2);  // the chunk, and the CRC of all data

    Bytes cut(altered.begin(), altered.begin() + static_cast<std::ptrdiff_t>(closed.ends[4]));
    const ReadBack back = read_all(*open(cut));
    CHECK(back.lines.size() == 16);
    REQUIRE(back.errors.size() == 1);
    CHECK(back.errors[0].text().ends_with("its header, or the index, gives other times than its messages"));
    CHECK(read_all(*open(recover_bytes(cut).bytes)).lines == by_time(closed.lines));
}

TEST_CASE("a chunk in the middle is damaged: the loss is reported by topic and time")
{
    const SampleFile file(Compression::Zstd, 5);
    Bytes altered = file.bytes;
    altered[file.ends[1] + 90] = static_cast<std::uint8_t>(altered[file.ends[1] + 90] ^ 0xff);
    const Recovered out = recover_bytes(altered);
    REQUIRE(out.report);
    const RecoveryReport& report = *out.report;
    CHECK(report.verdict == Verdict::SomethingLost);
    CHECK(exit_code(report.verdict) == 5);
    CHECK(report.chunks == 4);
    CHECK(report.messages == 16);
    CHECK(report.knows_missing);
    CHECK(report.missing == std::map<std::string, std::uint64_t>{{"plab/events", 1}, {"plab/states", 3}});
    REQUIRE(report.lost.size() == 1);
    CHECK(report.lost[0].begin == file.ends[1]);
    CHECK(report.lost[0].after == 1200);
    CHECK(report.lost[0].before == 3000);
    CHECK(report.from == 0);
    CHECK(report.to == 4200);
    CHECK(report.text().find("plab/states: 12, 3 missing\n") != std::string::npos);
    CHECK(open(out.bytes)->metadata("recovery")->values.at("report") == report.text());
}

TEST_CASE("the first chunk, which declares the channels, is damaged: the others are still read")
{
    SampleFile file(Compression::None, 5, false);
    // Without a summary, only a later chunk could declare them: there is none here.
    Bytes altered = file.bytes;
    const std::size_t first = static_cast<std::size_t>(open(altered)->index().chunks[0].offset);
    altered[first + 60] = static_cast<std::uint8_t>(altered[first + 60] ^ 0xff);
    const Recovered lost = recover_bytes(altered);
    REQUIRE(lost.report);
    CHECK(lost.report->messages == 0);
    CHECK(lost.report->undeclared == 16);
    CHECK(lost.report->text().find("lost: 16 messages whose channels are not declared\n") != std::string::npos);
    // With a summary, the summary declares them.
    const SampleFile closed(Compression::None, 5);
    altered = closed.bytes;
    altered[first + 60] = static_cast<std::uint8_t>(altered[first + 60] ^ 0xff);
    const Recovered saved = recover_bytes(altered);
    REQUIRE(saved.report);
    CHECK(saved.report->messages == 16);
}

TEST_CASE("two chunks that use one id for different channels: the second is an error, and is not taken for the first")
{
    auto bytes = std::make_shared<Bytes>();
    auto file = Container::begin(std::make_unique<MemorySink>(bytes), {"plab", "test"}, 1000).take();
    Compressor none(Compression::None, 0);
    for (const std::string topic : {"a", "b"})
    {
        ChunkBuilder chunk;
        chunk.add(Channel{1, 0, topic, "text", {}});
        chunk.add(Message{1, 0, 7, 7, view_of("of " + topic)});
        Bytes out;
        auto index = chunk.write(out, none);
        REQUIRE(index);
        REQUIRE(file.put_chunk(out, *index, chunk.contents()));
    }
    auto reader = open(*bytes);
    REQUIRE(reader);
    const ReadBack back = read_all(*reader);
    CHECK(back.lines == Lines{{"a", 7, 7, 0, "of a"}});
    REQUIRE(back.errors.size() == 1);
    CHECK(back.errors[0].text().ends_with("a chunk whose declaration of an id differs from the rest of the file"));
    const Recovered out = recover_bytes(*bytes);
    REQUIRE(out.report);
    CHECK(out.report->messages == 1);
    REQUIRE(out.report->lost.size() == 1);
    CHECK(out.report->lost[0].reason == "a chunk whose declaration of an id differs from an earlier one");
    CHECK(read_all(*open(out.bytes)).lines == back.lines);
}

TEST_CASE("a chunk that is contradictory is an error")
{
    ChunkBuilder chunk;
    chunk.add(Channel{1, 0, "a", "text", {}});
    chunk.add(Channel{1, 0, "b", "text", {}});
    Bytes bytes;
    Compressor none(Compression::None, 0);
    REQUIRE(chunk.write(bytes, none));
    ChunkData data;
    const auto loaded = data.load(MemorySource(bytes), 0, {});
    REQUIRE(!loaded);
    CHECK(loaded.error().text() == "byte 0: Chunk: Channel record 30 contradicts another one of its id");
    CHECK(data.messages().empty());
}

TEST_CASE("the start of a file is missing: the rest is found, and the loss is reported")
{
    const SampleFile file(Compression::Lz4, 5, false);
    const std::size_t gone = file.ends[1] + 10;
    // Without the summary too, nothing declares the channels again in a file as short as this.
    const Recovered orphans = recover_bytes(ByteView(file.bytes).subspan(gone));
    REQUIRE(orphans.report);
    CHECK(orphans.report->undeclared == 8);
    // If the declarations survive, everything after the damage is kept: for example with the first 64 KB overwritten.
    const SampleFile closed(Compression::Lz4, 5);
    Bytes altered = closed.bytes;
    std::fill_n(altered.begin(), gone, std::uint8_t{0});
    const Recovered out = recover_bytes(altered);
    REQUIRE(out.report);
    CHECK(out.report->verdict == Verdict::SomethingLost);
    CHECK(out.report->messages == 8);
    REQUIRE(out.report->lost.size() == 1);
    CHECK(out.report->lost[0].begin == 0);
    CHECK(out.report->lost[0].end == file.ends[2]);
    CHECK(out.report->lost[0].reason == "is not an MCAP file: it does not begin with the magic bytes");
    CHECK(out.report->lost[0].before == 3000);
    const Recovered nothing = recover_bytes(view_of("a letter to a friend, and no recording"));
    REQUIRE(nothing.report);
    CHECK(nothing.report->verdict == Verdict::NothingUsable);
    CHECK(nothing.bytes.empty());
}

TEST_CASE("noise, and noise after a good start, ends in errors and not in a crash")
{
    std::mt19937 random(7);
    const SampleFile file(Compression::Zstd, 2);
    for (int round = 0; round < 2000; ++round)
    {
        CAPTURE(round);
        Bytes noise(file.bytes.begin(), file.bytes.begin() + static_cast<std::ptrdiff_t>(random() % file.bytes.size()));
        const std::size_t good = noise.size();
        noise.resize(good + random() % 400);
        // Small numbers make plausible opcodes and lengths.
        for (std::size_t i = good; i < noise.size(); ++i) noise[i] = static_cast<std::uint8_t>(random() % (round % 2 == 0 ? 256 : 16));
        check_reader(noise, file);
        (void)check_recovery(noise, file);
    }
}

TEST_CASE("impossible sizes in a file are refused before memory is allocated")
{
    const SampleFile file(Compression::Zstd, 1);
    auto reader = open(file.bytes);
    const std::size_t chunk = static_cast<std::size_t>(reader->index().chunks[0].offset);
    Bytes altered = file.bytes;
    altered[chunk + kRecordHead + 8 + 8 + 3] = 0x10;  // uncompressed_size becomes 256 MB
    const ReadBack back = read_all(*open(altered));
    REQUIRE(back.errors.size() == 1);
    CHECK(back.errors[0].text().find("bytes cannot hold 268") != std::string::npos);
    altered[chunk + kRecordHead + 8 + 8 + 7] = 0x10;
    CHECK(read_all(*open(altered)).errors.at(0).text().find("larger than 536870912 bytes, which is the limit") != std::string::npos);
}
