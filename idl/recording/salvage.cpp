#include "idl/recording/salvage.h"

#include <algorithm>

#include "idl/recording/metadata.h"
#include "idl/recording/parse.h"

namespace plab::recording
{
namespace
{

/// The result of checking a record.
enum class Worth : std::uint8_t
{
    Good,      ///< protected by a CRC or a seal
    Unproved,  ///< consistent, but not protected
    Useless,   ///< not worth keeping, but valid: indexes, declarations
    End,       ///< of the data
    Bad,
};

struct Inspected
{
    Worth worth = Worth::Bad;
    std::string reason;
};

class Survey
{
public:
    Survey(const Source& source, const Limits& limits) : source_(&source), limits_(limits), window_(source) {}

    Result<Salvage> run()
    {
        auto size = source_->size();
        if (!size) return size.errors();
        data_end_ = *size;
        if (auto done = find_end_of_data(); !done) return done.errors();
        auto begin = begin_of_data();
        if (!begin) return begin.errors();
        std::uint64_t at = *begin;
        while (at < data_end_ && !out_.has_end)
        {
            auto next = step(at);
            if (!next) return next.errors();
            at = *next;
        }
        add_late_declarations();
        place_losses_in_time();
        return std::move(out_);
    }

private:
    /// A file without its first bytes can still contain intact chunks.
    Result<std::uint64_t> begin_of_data()
    {
        auto start = read_start(*source_, limits_);
        if (start)
        {
            out_.header = start->header;
            return start->end;
        }
        auto next = search(0);
        if (!next) return next.errors();
        return lose(0, *next, start.error().reason);
    }

    /// An intact summary gives the end of the data, even if the record that marks it is damaged.
    Result<void> find_end_of_data()
    {
        auto footer = read_footer(*source_);
        if (!footer) return footer.errors();
        if (!*footer || (*footer)->summary_start == 0) return {};
        auto summary = read_summary(*source_, **footer, limits_);
        if (summary)
        {
            data_end_ = (*footer)->summary_start;
            out_.summary = summary.take();
        }
        else
            out_.mended.push_back("the index: " + summary.error().text());
        return {};
    }

    /// Checks the record at `at`; returns the position where to continue.
    Result<std::uint64_t> step(std::uint64_t at)
    {
        auto head = head_at(at);
        if (!head) return head.errors();
        if (!*head) return lose(at, data_end_, "the file ends within a record");
        auto verdict = inspect(at, **head);
        if (!verdict) return verdict.errors();
        const std::uint64_t end = at + kRecordHead + (*head)->length;
        if (verdict->worth != Worth::Bad)
        {
            if (verdict->worth == Worth::Good || verdict->worth == Worth::Unproved) keep(at, **head, verdict->worth);
            return end;
        }
        auto next = next_good(at, **head);
        if (!next) return next.errors();
        return lose(at, *next, verdict->reason);
    }

    /// Empty: the record is incomplete.
    Result<std::optional<RecordHead>> head_at(std::uint64_t at)
    {
        auto bytes = window_.view(at, kRecordHead);
        if (!bytes) return bytes.errors();
        if (bytes->size() < kRecordHead) return std::optional<RecordHead>();
        return std::optional(parse_head(*bytes));
    }

    Result<Inspected> inspect(std::uint64_t at, const RecordHead& head)
    {
        if (head.length > data_end_ - at - std::min<std::uint64_t>(kRecordHead, data_end_ - at))
            return Inspected{Worth::Bad, "a record that extends beyond the end of the data"};
        switch (head.opcode)
        {
            case Opcode::Chunk:
                return inspect_chunk(at);
            case Opcode::MessageIndex:
                return inspect_message_index(at, head);
            case Opcode::Schema:
            case Opcode::Channel:
            case Opcode::Attachment:
            case Opcode::Metadata:
                return inspect_body(at, head);
            case Opcode::DataEnd:
                return inspect_end(at, head);
            case Opcode::Message:
                return Inspected{Worth::Bad, "a message outside of a chunk, which no checksum protects"};
            default:
                return Inspected{Worth::Bad, "a " + name_of(head.opcode) + " record, which is not allowed here"};
        }
    }

    Result<Inspected> inspect_chunk(std::uint64_t at)
    {
        if (auto done = chunk_.load(*source_, at, limits_); !done) return Inspected{Worth::Bad, done.error().reason};
        if (!chunk_.declarations().agrees_with(out_.declarations))
            return Inspected{Worth::Bad, "a chunk whose declaration of an id differs from an earlier one"};
        return Inspected{chunk_.has_crc() ? Worth::Good : Worth::Unproved, ""};
    }

    Result<Inspected> inspect_message_index(std::uint64_t at, const RecordHead& head)
    {
        constexpr std::size_t kHead = 6;
        auto beginning = window_.view(at + kRecordHead, std::min<std::uint64_t>(kHead, head.length));
        if (!beginning) return beginning.errors();
        if (parse_message_index_head(*beginning, head.length)) return Inspected{Worth::Useless, ""};
        return Inspected{Worth::Bad, "a MessageIndex record that does not fit its length"};
    }

    Result<Inspected> inspect_body(std::uint64_t at, const RecordHead& head)
    {
        if (head.length > (head.opcode == Opcode::Attachment ? limits_.attachment_bytes : limits_.record_bytes))
            return Inspected{Worth::Bad, "a " + name_of(head.opcode) + " record larger than the limit"};
        Bytes body(head.length);
        auto got = source_->read(at + kRecordHead, body);
        if (!got) return got.errors();
        return Inspected{worth_of(head.opcode, ByteView(body).first(*got)), "a " + name_of(head.opcode) + " record that is damaged"};
    }

    Worth worth_of(Opcode opcode, ByteView body)
    {
        if (opcode == Opcode::Attachment)
        {
            const auto parsed = parse_attachment(body);
            if (!parsed || !parsed->crc_is_right) return Worth::Bad;
            return parsed->has_crc ? Worth::Good : Worth::Unproved;
        }
        if (opcode == Opcode::Metadata)
        {
            const auto parsed = parse_metadata(body);
            if (!parsed || seal_of(*parsed) == Seal::Broken) return Worth::Bad;
            return seal_of(*parsed) == Seal::Right ? Worth::Good : Worth::Unproved;
        }
        if (opcode == Opcode::Schema)
        {
            const auto schema = parse_schema(body);
            return schema && loose_.add(*schema) ? Worth::Useless : Worth::Bad;
        }
        const auto channel = parse_channel(body);
        return channel && loose_.add(*channel) ? Worth::Useless : Worth::Bad;
    }

    Result<Inspected> inspect_end(std::uint64_t at, const RecordHead& head)
    {
        auto body = window_.view(at + kRecordHead, std::min<std::uint64_t>(head.length, sizeof(DataEnd::data_crc)));
        if (!body) return body.errors();
        const auto end = parse_data_end(*body);
        if (!end) return Inspected{Worth::Bad, "a DataEnd record that is too short"};
        auto crc = crc_of_range(*source_, 0, at);
        if (!crc) return crc.errors();
        out_.has_end = true;
        out_.is_proved = out_.lost.empty() && (end->data_crc == 0 || end->data_crc == *crc);
        if (end->data_crc != 0 && end->data_crc != *crc) out_.mended.push_back("the CRC of all data is wrong: some bytes have changed");
        return Inspected{Worth::End, ""};
    }

    void keep(std::uint64_t at, const RecordHead& head, Worth worth)
    {
        out_.records.push_back({head.opcode, at, kRecordHead + head.length});
        if (worth == Worth::Unproved) ++out_.unproved;
        if (head.opcode != Opcode::Chunk) return;
        for (const auto& [id, schema] : chunk_.declarations().schemas) (void)out_.declarations.add(schema);
        for (const auto& [id, channel] : chunk_.declarations().channels) (void)out_.declarations.add(channel);
        const ChunkHeader& header = chunk_.header();
        if (auto right = chunk_.check_times(at, header.start_time, header.end_time); !right) out_.mended.push_back(right.error().reason);
        if (!chunk_.messages().empty()) note_times(at);
    }

    void note_times(std::uint64_t at)
    {
        const auto earlier = [](const auto& a, const auto& b) { return a.log_time < b.log_time; };
        const auto [first, last] = std::minmax_element(chunk_.messages().begin(), chunk_.messages().end(), earlier);
        times_.push_back({at, first->log_time, last->log_time});
        out_.from = std::min(out_.from.value_or(first->log_time), first->log_time);
        out_.to = std::max(out_.to.value_or(last->log_time), last->log_time);
        for (const auto& entry : chunk_.messages()) ++out_.messages[entry.channel];
    }

    std::uint64_t lose(std::uint64_t begin, std::uint64_t end, const std::string& why)
    {
        out_.lost.push_back({begin, end, why, {}, {}});
        return end;
    }

    /// The position of the next intact record after a bad one. If the bad record's length leads to a consistent record, that
    /// one is accepted; otherwise every byte is tried, and only records protected by a CRC or a seal count.
    Result<std::uint64_t> next_good(std::uint64_t bad, const RecordHead& head)
    {
        if (head.length <= data_end_ - bad - std::min<std::uint64_t>(kRecordHead, data_end_ - bad))
        {
            const std::uint64_t end = bad + kRecordHead + head.length;
            auto next = head_at(end);
            if (!next) return next.errors();
            const bool is_known = *next && (*next)->opcode >= Opcode::Schema && (*next)->opcode <= Opcode::DataEnd;
            if (is_known && (*next)->length <= data_end_ - end - kRecordHead && head.opcode == Opcode::Chunk) return end;
        }
        return search(bad + 1);
    }

    /// The position of the next intact record, at `begin` or later; the end of the data if there is none.
    Result<std::uint64_t> search(std::uint64_t begin)
    {
        Bytes piece;
        for (std::uint64_t at = begin; at < data_end_; at += piece.size())
        {
            piece.resize(std::min<std::uint64_t>(kPiece, data_end_ - at));
            auto got = source_->read(at, piece);
            if (!got) return got.errors();
            if (*got < piece.size()) break;
            auto found = find_good(at, piece);
            if (!found) return found.errors();
            if (*found) return **found;
        }
        return data_end_;
    }

    Result<std::optional<std::uint64_t>> find_good(std::uint64_t begin, ByteView piece)
    {
        for (std::size_t i = 0; i < piece.size(); ++i)
        {
            const auto opcode = static_cast<Opcode>(piece[i]);
            if (opcode != Opcode::Chunk && opcode != Opcode::Attachment && opcode != Opcode::Metadata) continue;
            auto good = is_good_at(begin + i);
            if (!good) return good.errors();
            if (*good) return std::optional(begin + i);
        }
        return std::optional<std::uint64_t>();
    }

    Result<bool> is_good_at(std::uint64_t at)
    {
        auto head = head_at(at);
        if (!head) return head.errors();
        if (!*head || (*head)->length > data_end_ - at - kRecordHead) return false;
        auto verdict = inspect(at, **head);
        if (!verdict) return verdict.errors();
        return verdict->worth == Worth::Good;
    }

    /// Channels that no intact chunk declares may be declared elsewhere: in the summary, or in records outside of chunks.
    void add_late_declarations()
    {
        for (const Declarations* more : {out_.summary ? &out_.summary->declarations : nullptr, &loose_})
        {
            if (more == nullptr) continue;
            out_.declarations.schemas.insert(more->schemas.begin(), more->schemas.end());
            out_.declarations.channels.insert(more->channels.begin(), more->channels.end());
        }
    }

    void place_losses_in_time()
    {
        for (LostPart& lost : out_.lost)
            for (const ChunkTimes& chunk : times_)
            {
                if (chunk.offset < lost.begin)
                    lost.after = std::max(lost.after.value_or(0), chunk.last);
                else
                    lost.before = std::min(lost.before.value_or(chunk.first), chunk.first);
            }
    }

    struct ChunkTimes
    {
        std::uint64_t offset = 0, first = 0, last = 0;
    };
    static constexpr std::size_t kPiece = 64u << 10;

    const Source* source_;
    Limits limits_;
    Window window_;
    Salvage out_;
    ChunkData chunk_;
    Declarations loose_;
    std::vector<ChunkTimes> times_;
    std::uint64_t data_end_ = 0;
};

}  // namespace

Result<Salvage> salvage(const Source& source, const Limits& limits) { return Survey(source, limits).run(); }

}  // namespace plab::recording
