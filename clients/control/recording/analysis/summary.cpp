#include "control/recording/analysis/summary.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <ctime>
#include <sstream>

#include "idl/recording/recovery.h"
#include "link/sequence.h"

namespace plab::analysis
{
namespace
{

constexpr std::uint64_t kSingleWriter = 0;

std::uint64_t whole_number(const recording::Pairs& pairs, const std::string& key)
{
    std::uint64_t value = 0;
    if (const auto found = pairs.find(key); found != pairs.end())
        (void)std::from_chars(found->second.data(), found->second.data() + found->second.size(), value);
    return value;
}

/// Numbers that a topic counts without gaps: the first, and how many; nothing for other topics.
std::optional<std::pair<std::uint64_t, std::uint64_t>> numbers_of(const Entry& entry)
{
    using Numbers = std::pair<std::uint64_t, std::uint64_t>;
    if (const auto* f = entry.as<plab_v2_Frame>()) return Numbers{f->sequence_number, 1};
    if (const auto* e = entry.as<plab_v2_Events>()) return Numbers{e->sequence_number, e->entries._length};
    if (const auto* c = entry.as<plab_v2_Collisions>()) return Numbers{c->sequence_number, c->entries._length};
    if (const auto* j = entry.as<plab_v2_Journal>()) return Numbers{j->sequence_number, 1};
    if (const auto* h = entry.as<plab_v2_Hashes>()) return Numbers{h->sequence_number, h->values._length};
    return {};
}

class SummaryCollector
{
public:
    explicit SummaryCollector(const Log& log) : log_(&log) {}

    void note(const Entry& entry)
    {
        note_times(entry);
        note_topic(entry);
        runs_.note(entry);
        swaps_.note(entry);
        if (const auto* frame = entry.as<plab_v2_Frame>()) note_frame(*frame);
        if (const auto* events = entry.as<plab_v2_Events>()) note_events(*events);
        if (const auto* collisions = entry.as<plab_v2_Collisions>()) note_collisions(*collisions);
        if (entry.as<plab_v2_Journal>() != nullptr) ++out_.requests;
        if (const auto* s = entry.as<plab_v2_Snapshot>())
            out_.snapshots.push_back({s->run, s->step, s->time, s->name, s->cause, s->data._length});
        if (const auto* server = entry.as<plab_v2_Server>()) note_server(*server);
    }

    Summary take()
    {
        for (auto& [id, topic] : topics_) out_.topics.push_back(std::move(topic.summary));
        std::sort(out_.topics.begin(), out_.topics.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
        for (const auto& [kind, count] : events_) out_.events.push_back({kind.first, kind.second, count});
        for (const auto& [kind, count] : collisions_) out_.collisions.push_back({kind, "", count});
        out_.runs = runs_.all();
        out_.swaps = swaps_.all(log_->things());
        return std::move(out_);
    }

    Summary& out() { return out_; }

private:
    struct Topic
    {
        TopicSummary summary;
        link::Sequence numbers;
    };

    void note_times(const Entry& entry)
    {
        const bool is_first = out_.messages++ == 0;
        out_.begin = is_first ? entry.log_time : std::min(out_.begin, entry.log_time);
        out_.end = is_first ? entry.log_time : std::max(out_.end, entry.log_time);
        out_.first_written = is_first ? entry.publish_time : std::min(out_.first_written, entry.publish_time);
        out_.last_written = is_first ? entry.publish_time : std::max(out_.last_written, entry.publish_time);
    }
    void note_topic(const Entry& entry)
    {
        Topic& topic = topics_[entry.channel->id];
        TopicSummary& s = topic.summary;
        if (s.messages++ == 0)
        {
            s.name = entry.channel->topic, s.first = entry.log_time;
            if (const auto* schema = log_->reader().schema_of(*entry.channel)) s.schema = schema->name;
        }
        s.bytes += entry.data.size(), s.last = std::max(s.last, entry.log_time);
        const auto numbers = numbers_of(entry);
        if (!numbers) return;
        const auto missing = topic.numbers.note(kSingleWriter, numbers->first, numbers->second);
        s.missing += missing.count, s.gaps += missing.count > 0 ? 1 : 0;
    }
    void note_frame(const plab_v2_Frame& frame)
    {
        out_.bodies = std::max<std::uint64_t>(out_.bodies, frame.bodies._length);
        out_.shafts = std::max<std::uint64_t>(out_.shafts, frame.shafts._length);
    }
    void note_events(const plab_v2_Events& events)
    {
        for (std::uint32_t i = 0; i < events.entries._length; ++i)
            ++events_[{events.entries._buffer[i].kind, events.entries._buffer[i].severity}];
    }
    void note_collisions(const plab_v2_Collisions& collisions)
    {
        for (std::uint32_t i = 0; i < collisions.entries._length; ++i) ++collisions_[collisions.entries._buffer[i].kind];
    }
    void note_server(const plab_v2_Server& server)
    {
        for (std::uint32_t i = 0; i < server.dropped._length; ++i)
            out_.dropped[server.dropped._buffer[i].topic] = server.dropped._buffer[i].samples;
    }

    const Log* log_;
    Summary out_;
    Runs runs_;
    Swaps swaps_;
    std::map<recording::ChannelId, Topic> topics_;
    std::map<std::pair<std::string, std::string>, std::uint64_t> events_;
    std::map<std::string, std::uint64_t> collisions_;
};

void add_container(const Log& log, Summary& out)
{
    const recording::FileIndex& index = log.reader().index();
    out.path = log.path(), out.head = log.head(), out.library = index.header.library;
    out.is_closed = index.is_closed;
    for (const Error& error : index.troubles) out.troubles.add(error.text());
    for (const recording::ChunkPlace& chunk : index.chunks)
        ++out.chunks, out.chunk_bytes += chunk.compressed_size, out.raw_bytes += chunk.uncompressed_size;
    for (const recording::AttachmentIndex& a : index.attachments) out.attachments.push_back({a.name, a.media_type, a.data_size});
    for (const recording::MetadataIndex& place : index.metadata)
    {
        if (place.name == recording::kRecovery)
            if (auto note = log.reader().metadata(place); note) out.recovered += text_at(note->values, "report");
        if (place.name != "gap") continue;
        auto gap = log.reader().metadata(place);
        if (gap)
            out.gaps.push_back({text_at(gap->values, "reason"), whole_number(gap->values, "messages"), whole_number(gap->values, "bytes"),
                                whole_number(gap->values, "from"), whole_number(gap->values, "to")});
        else
            out.troubles.add(gap.error().text());
    }
}

double per_object_second(const Summary& s, std::uint64_t bytes)
{
    const auto objects = static_cast<double>(s.bodies + s.shafts);
    return objects > 0 && s.duration() > 0 ? static_cast<double>(bytes) / objects / s.duration() : 0;
}

}  // namespace

double TopicSummary::rate() const { return last > first ? static_cast<double>(messages - 1) / seconds(last - first) : 0; }

std::vector<std::string> Summary::losses() const
{
    constexpr std::string_view kLost = "lost: ";
    std::vector<std::string> out;
    std::istringstream lines(recovered);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(kLost)) out.push_back(line.substr(kLost.size()));
    return out;
}

double Summary::state_bytes_per_object_second() const
{
    for (const TopicSummary& topic : topics)
        if (topic.name == wire::topic_of<plab_v2_Frame>().name) return per_object_second(*this, topic.bytes);
    return 0;
}

double Summary::file_bytes_per_object_second() const { return per_object_second(*this, file_bytes); }

Result<Summary> summary_of(const Log& log)
{
    SummaryCollector collector(log);
    add_container(log, collector.out());
    auto source = recording::FileSource::open(log.path());
    if (!source) return source.errors();
    auto size = source->size();
    if (!size) return size.errors();
    collector.out().file_bytes = *size;
    Stream stream = log.stream();
    while (const Entry* entry = stream.next()) collector.note(*entry);
    Summary out = collector.take();
    out.troubles.merge(log.troubles());
    out.troubles.merge(stream.troubles());
    return out;
}

std::string text_at(const recording::Pairs& pairs, const std::string& key)
{
    const auto found = pairs.find(key);
    return found == pairs.end() ? std::string() : found->second;
}

std::string counted(std::uint64_t n, const std::string& what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); }

std::string date_text(std::uint64_t nanoseconds)
{
    const auto when = static_cast<std::time_t>(nanoseconds / 1'000'000'000);
    std::tm utc{};
    (void)gmtime_r(&when, &utc);
    std::array<char, 40> text{};
    (void)std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &utc);
    return text.data();
}

}  // namespace plab::analysis
