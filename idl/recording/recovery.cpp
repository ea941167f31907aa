#include "idl/recording/recovery.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>

#include "idl/recording/container.h"
#include "idl/recording/metadata.h"
#include "idl/recording/parse.h"

namespace plab::recording
{
namespace
{

constexpr std::size_t kMostIndexMemory = 256u << 20;

/// Writes a new file from the intact records of another.
class Rebuild
{
public:
    Rebuild(const Source& source, const Salvage& found, const Limits& limits) : source_(&source), found_(&found), limits_(limits) {}

    Result<void> run(std::unique_ptr<Sink> sink, const RecoveryReport& report)
    {
        auto begun = Container::begin(std::move(sink), {found_->header.profile, "pLab, recovered"}, kMostIndexMemory);
        if (!begun) return begun.errors();
        Container out = begun.take();
        if (auto done = put_declarations(out); !done) return done;
        for (const Salvaged& record : found_->records)
            if (auto done = copy(record, out); !done) return done;
        if (report.verdict != Verdict::Whole)
            if (auto done = out.put(note_of(report)); !done) return done;
        return out.finish();
    }

private:
    /// All chunks first: the declarations of a channel may be among the lost data.
    Result<void> put_declarations(Container& out)
    {
        for (const auto& [id, schema] : found_->declarations.schemas) out.declare(schema), chunk_.add(schema);
        for (const auto& [id, channel] : found_->declarations.channels) out.declare(channel), chunk_.add(channel);
        return chunk_.empty() ? Result<void>() : put_chunk(out, Compression::Zstd);
    }

    Result<void> put_chunk(Container& out, Compression compression)
    {
        bytes_.clear();
        auto index = chunk_.write(bytes_, compressors_[static_cast<std::size_t>(compression)]);
        return index ? put_written(out, index.take()) : Result<void>(index.errors());
    }

    Result<void> put_written(Container& out, ChunkIndex index)
    {
        auto done = out.put_chunk(bytes_, std::move(index), chunk_.contents());
        chunk_.clear();
        return done;
    }

    Result<void> copy(const Salvaged& record, Container& out)
    {
        if (record.opcode == Opcode::Chunk) return copy_chunk(record, out);
        Bytes body(record.length - kRecordHead);
        if (auto got = source_->read(record.offset + kRecordHead, body); !got) return got.errors();
        if (record.opcode == Opcode::Attachment)
        {
            const auto parsed = parse_attachment(body);
            if (!parsed) return damage(record.offset, "the file changes while it is read");
            return out.put(parsed->attachment);
        }
        const auto parsed = parse_metadata(body);
        if (!parsed) return damage(record.offset, "the file changes while it is read");
        return out.put(*parsed);
    }

    Result<void> copy_chunk(const Salvaged& record, Container& out)
    {
        if (auto done = data_.load(*source_, record.offset, limits_); !done) return done;
        const auto compression = compression_of(data_.header().compression).value_or(Compression::None);
        if (is_declared())
        {
            chunk_.copy(data_);
            bytes_.clear();
            return put_written(out, chunk_.write_stored(bytes_, data_.stored(), compression));
        }
        for (const auto& entry : data_.messages())
            if (found_->declarations.channels.contains(entry.channel)) chunk_.add(data_.message(entry));
        return chunk_.empty() ? Result<void>() : put_chunk(out, compression);
    }

    /// Whether the chunk may be copied unchanged: all its messages have known channels.
    bool is_declared() const
    {
        const auto is_known = [&](const ChunkData::Entry& entry) { return found_->declarations.channels.contains(entry.channel); };
        return std::all_of(data_.messages().begin(), data_.messages().end(), is_known);
    }

    static Metadata note_of(const RecoveryReport& report)
    {
        return sealed({kRecovery, {{"messages", std::to_string(report.messages)}, {"report", report.text()}}});
    }

    const Source* source_;
    const Salvage* found_;
    Limits limits_;
    ChunkData data_;
    ChunkBuilder chunk_;
    Bytes bytes_;
    std::array<Compressor, 3> compressors_{Compressor(Compression::None, 0), Compressor(Compression::Lz4, 0),
                                           Compressor(Compression::Zstd, 1)};
};

void count_messages(const Salvage& found, RecoveryReport& report)
{
    for (const auto& [channel, messages] : found.messages)
    {
        const auto declared = found.declarations.channels.find(channel);
        if (declared == found.declarations.channels.end())
        {
            report.undeclared += messages;
            continue;
        }
        report.kept[declared->second.topic] += messages;
        report.messages += messages;
    }
    if (!found.summary) return;
    report.knows_missing = true;
    for (const auto& [channel, messages] : found.summary->statistics.channel_messages)
    {
        const auto kept = found.messages.find(channel);
        const std::uint64_t there = kept == found.messages.end() ? 0 : kept->second;
        const auto declared = found.declarations.channels.find(channel);
        const std::string topic = declared == found.declarations.channels.end() ? std::to_string(channel) : declared->second.topic;
        if (there < messages) report.missing[topic] += messages - there;
    }
}

/// The statistics of the summary count all messages: if they are all here, damage elsewhere has cost nothing.
bool is_complete(const Salvage& found, const RecoveryReport& report)
{
    if (!found.summary || !report.missing.empty() || report.undeclared > 0) return false;
    const Statistics& there = found.summary->statistics;
    return report.messages == there.messages && report.attachments == there.attachments && report.metadata == there.metadata;
}

RecoveryReport judge(const Salvage& found)
{
    RecoveryReport report;
    const auto count = [&](Opcode opcode)
    { return static_cast<std::uint64_t>(std::ranges::count(found.records, opcode, &Salvaged::opcode)); };
    report.chunks = count(Opcode::Chunk);
    report.attachments = count(Opcode::Attachment);
    report.metadata = count(Opcode::Metadata);
    report.from = found.from;
    report.to = found.to;
    report.unproved = found.unproved;
    report.lost = found.lost;
    report.mended = found.mended;
    report.was_closed = found.has_end || found.summary.has_value();
    count_messages(found, report);

    const bool is_whole = (found.is_proved && report.undeclared == 0) || is_complete(found, report);
    const bool is_empty = report.messages == 0 && report.attachments == 0 && report.metadata == 0;
    report.verdict = is_whole ? Verdict::Whole : is_empty ? Verdict::NothingUsable : Verdict::SomethingLost;
    if (!is_whole) return report;
    if (!found.summary && found.mended.empty()) report.mended.push_back("the file had no index");
    for (const LostPart& lost : report.lost) report.mended.push_back(damage(lost.begin, lost.reason).reason);
    report.lost.clear();
    return report;
}

std::string seconds(std::uint64_t ns)
{
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), static_cast<double>(ns) * 1e-9, std::chars_format::fixed, 3).ptr;
    return std::string(text.data(), end) + " s";
}

std::string range_text(const LostPart& lost)
{
    std::string out = "bytes " + std::to_string(lost.begin) + " to " + std::to_string(lost.end);
    if (lost.after) out += ", after " + seconds(*lost.after);
    if (lost.before) out += ", before " + seconds(*lost.before);
    return out;
}

}  // namespace

int exit_code(Verdict verdict)
{
    constexpr int kLost = 5, kNothing = 1;
    return verdict == Verdict::Whole ? 0 : verdict == Verdict::SomethingLost ? kLost : kNothing;
}

bool RecoveryReport::knows_no_end() const { return !was_closed && verdict == Verdict::SomethingLost; }

std::string RecoveryReport::text() const
{
    constexpr std::array kWords{"whole", "something is lost", "nothing is usable"};
    std::string out = std::string(kWords[static_cast<std::size_t>(verdict)]) + (was_closed ? "\n" : "; the file was not closed\n");
    out += "kept: " + std::to_string(messages) + " messages in " + std::to_string(chunks) + " chunks";
    if (from && to) out += ", from " + seconds(*from) + " to " + seconds(*to);
    out += "; " + std::to_string(attachments) + " attachments, " + std::to_string(metadata) + " metadata records\n";
    for (const auto& [topic, count] : kept)
    {
        out += "  " + topic + ": " + std::to_string(count);
        const auto lacks = missing.find(topic);
        out += lacks == missing.end() ? "\n" : ", " + std::to_string(lacks->second) + " missing\n";
    }
    for (const auto& [topic, count] : missing)
        if (!kept.contains(topic)) out += "  " + topic + ": none, " + std::to_string(count) + " missing\n";
    for (const LostPart& part : lost) out += "lost: " + range_text(part) + ": " + part.reason + "\n";
    if (knows_no_end() && to)
        out += "lost: what was recorded after " + seconds(*to) + ", until the recorder ended; the file does not record when\n";
    if (undeclared > 0) out += "lost: " + std::to_string(undeclared) + " messages whose channels are not declared\n";
    for (const std::string& what : mended) out += "mended: " + what + "\n";
    if (unproved > 0) out += "unproved: " + std::to_string(unproved) + " records without CRC or seal\n";
    return out;
}

Result<RecoveryReport> recover(const Source& in, const SinkMaker& make_out, const Limits& limits)
{
    auto found = salvage(in, limits);
    if (!found) return found.errors();
    const RecoveryReport report = judge(*found);
    if (report.verdict == Verdict::NothingUsable) return report;
    auto sink = make_out();
    if (!sink) return sink.errors();
    if (auto done = Rebuild(in, *found, limits).run(sink.take(), report); !done) return done.errors();
    return report;
}

Result<RecoveryReport> recover(const std::string& in, const std::string& out, Overwrite overwrite, const Limits& limits, const Watch& watch)
{
    std::error_code ignored;  // a file that does not exist is not the same file
    if (std::filesystem::equivalent(in, out, ignored)) return reason(out + ": is the recording itself; give another file");
    auto file = FileSource::open(in);
    if (!file) return file.errors();
    const WatchedSource source(std::make_unique<FileSource>(file.take()), watch);
    bool is_made = false;
    const auto make = [&]() -> Result<std::unique_ptr<Sink>>
    {
        auto sink = FileSink::open(out, overwrite);
        if (!sink) return sink.errors();
        is_made = true;
        return std::unique_ptr<Sink>(std::make_unique<FileSink>(sink.take()));
    };
    auto report = recover(source, make, limits);
    if (report) return report;
    if (is_made) std::filesystem::remove(out, ignored);
    Error error = report.error();
    if (error.where.file.empty()) error.where.file = in;
    return error;
}

}  // namespace plab::recording
