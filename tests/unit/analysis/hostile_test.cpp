// Malformed files and messages: they are reported, and nothing crashes.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "control/recording/analysis/curves.h"
#include "control/recording/analysis/diff.h"
#include "control/recording/analysis/export.h"
#include "control/recording/analysis/report.h"
#include "idl/recording/topic_file.h"
#include "made_recording.h"
#include "support/text.h"

using namespace plab;
using namespace plab::analysis;
using namespace plab::test;

namespace
{

void write(const std::string& path, const std::string& bytes)
{
    std::ofstream out(path, std::ios::binary);
    out << bytes;
}

/// Everything that is done with files; true if the file could be opened.
bool use(const std::string& path)
{
    auto log = Log::open(path);
    if (!log) return false;
    auto summary = summary_of(*log);
    REQUIRE(summary.ok());
    CHECK(!report_html(*log, *summary).empty());
    CHECK(export_csv(*log, {.out = path + ".csv"}).ok() == !log->reader().channels_of({"plab/states"}).empty());
    CHECK(export_json(*log, {.out = path + ".jsonl"}).ok());
    (void)difference_of(*log, *log);
    return true;
}

/// A recording with these messages of one type, each in a chunk with a right CRC.
template <class T>
std::string recording_of(const std::string& name, const std::vector<recording::Bytes>& messages)
{
    const std::string path = fresh_path(name);
    auto writer = recording::McapWriter::create(path);
    REQUIRE(writer.ok());
    const auto schema = writer->add_schema(recording::schema_of<T>().take());
    REQUIRE(schema.ok());
    const auto channel = writer->add_channel(recording::channel_of<T>(*schema));
    REQUIRE(channel.ok());
    std::uint64_t time = 0;
    for (const recording::Bytes& bytes : messages) REQUIRE(writer->write({*channel, 0, ++time, time, bytes}, {}));
    REQUIRE(writer->close().ok());
    return path;
}

/// The sample with each of its bytes changed in turn, and truncated at each byte.
template <class T>
std::vector<recording::Bytes> altered(const T& sample)
{
    recording::Encoder encoder;
    const auto encoded = encoder.encode(sample);
    REQUIRE(encoded.ok());
    const recording::Bytes whole(encoded->begin(), encoded->end());
    std::vector<recording::Bytes> out{whole};
    for (std::size_t i = 0; i < whole.size(); ++i)
    {
        out.push_back(whole);
        out.back()[i] ^= 0xff;
        out.emplace_back(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return out;
}

}  // namespace

TEST_CASE("a file with a changed byte is read as far as possible, or refused")
{
    const std::string whole = content_of(make_recording("flip.mcap", {.steps = 12, .compression = recording::Compression::None}));
    const std::string path = fresh_path("flipped.mcap");
    std::size_t opened = 0, tried = 0;
    for (std::size_t i = 0; i < whole.size(); i += 61, ++tried)
    {
        std::string flipped = whole;
        flipped[i] = static_cast<char>(flipped[i] ^ 0x55);
        write(path, flipped);
        opened += use(path) ? 1 : 0;
    }
    CHECK(opened > tried / 2);
}

TEST_CASE("a file that is truncated anywhere is read as far as possible, or refused")
{
    const std::string whole = content_of(make_recording("cuts.mcap", {.steps = 12, .compression = recording::Compression::None}));
    const std::string path = fresh_path("cut.mcap");
    std::uint64_t last = 0;
    for (std::size_t n = 0; n < whole.size(); n += 97)
    {
        write(path, whole.substr(0, n));
        auto log = Log::open(path);
        if (!log) continue;
        const auto summary = summary_of(*log);
        REQUIRE(summary.ok());
        CHECK(!summary->is_whole());
        CHECK(summary->messages >= last);
        last = summary->messages;
    }
    CHECK(last > 10);
}

TEST_CASE("a message that is not a valid sample is counted and left out")
{
    std::vector<plab_v2_BodyState> bodies(2);
    plab_v2_Frame frame{};
    frame.run = 1, frame.bodies._buffer = bodies.data(), frame.bodies._length = frame.bodies._maximum = 2;
    const std::vector<recording::Bytes> frames = altered(frame);
    const std::string path = recording_of<plab_v2_Frame>("bent_frames.mcap", frames);
    auto log = Log::open(path);
    REQUIRE(log.ok());
    auto summary = summary_of(*log);
    REQUIRE(summary.ok());
    CHECK(summary->troubles.count > frames.size() / 2);  // all truncated ones, and some others
    CHECK(summary->troubles.texts.size() == Troubles::kMostTexts);
    CHECK(summary->messages + summary->troubles.count == frames.size());
    CHECK(use(path));
}

TEST_CASE("altered metrics, events and journals do no harm")
{
    char text[] = "<b>bold";
    std::vector<plab_v2_InteractionMetrics> interactions(1);
    interactions[0] = {};
    interactions[0].component_id = interactions[0].requested = text;
    plab_v2_Metrics metrics{};
    metrics.interactions._buffer = interactions.data(), metrics.interactions._length = metrics.interactions._maximum = 1;
    CHECK(use(recording_of<plab_v2_Metrics>("bent_metrics.mcap", altered(metrics))));
    std::vector<plab_v2_Operation> operations(1);
    operations[0] = {};
    operations[0].verb = text, operations[0].target = text;
    plab_v2_Journal journal{};
    journal.operations._buffer = operations.data(), journal.operations._length = journal.operations._maximum = 1;
    CHECK(use(recording_of<plab_v2_Journal>("bent_journal.mcap", altered(journal))));
    std::vector<plab_v2_EventInfo> entries(1);
    entries[0] = {};
    entries[0].kind = entries[0].severity = entries[0].message = text;
    plab_v2_Events events{};
    events.entries._buffer = entries.data(), events.entries._length = events.entries._maximum = 1;
    const std::string file = recording_of<plab_v2_Events>("bent_events.mcap", altered(events));
    CHECK(use(file));
    auto log = Log::open(file);
    REQUIRE(log.ok());
    const std::string page = report_html(*log, *summary_of(*log));
    CHECK(page.find("&lt;b&gt;bold") != std::string::npos);
    CHECK(page.find(text) == std::string::npos);
}

TEST_CASE("foreign topics are counted, and not taken for pLab's")
{
    const std::string path = fresh_path("others.mcap");
    auto writer = recording::McapWriter::create(path);
    REQUIRE(writer.ok());
    // The name of pLab's topic, with another version of its type.
    const auto schema = writer->add_schema({0, "plab::v9::Frame", "omgidl", "module plab { module v9 { struct Frame { long x; }; }; };"});
    REQUIRE(schema.ok());
    const auto ours = writer->add_channel({0, *schema, "plab/states", "cdr", {}});
    const auto text = writer->add_channel({0, 0, "notes", "text", {}});
    REQUIRE(ours.ok());
    REQUIRE(text.ok());
    const recording::Bytes bytes{0, 1, 0, 0, 7, 0, 0, 0};
    REQUIRE(writer->write({*ours, 0, 1, 1, bytes}, {}));
    REQUIRE(writer->write({*text, 0, 2, 2, bytes}, {}));
    REQUIRE(writer->close().ok());
    auto log = Log::open(path);
    REQUIRE(log.ok());
    const auto summary = summary_of(*log);
    REQUIRE(summary.ok());
    CHECK(summary->messages == 2);
    CHECK(summary->troubles.count == 0);
    CHECK(summary->bodies == 0);
    // Its messages are left out, and counted.
    const std::string out = fresh_path("others.jsonl");
    const auto exported = export_json(*log, {.topics = {"states"}, .out = out});
    REQUIRE(exported.ok());
    CHECK(content_of(out).empty());
    REQUIRE(exported->troubles.count == 1);
    CHECK(exported->troubles.texts[0] == "plab/states: its messages are not of a type of this version of the wire (plab::v2)");
    CHECK(export_json(*log, {.topics = {"notes"}, .out = out})->troubles.count == 1);
}
