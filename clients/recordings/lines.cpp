#include "recordings/lines.h"

#include "link/sequence.h"
#include "logger/lines.h"

namespace plab::recordings
{
namespace
{

constexpr std::uint64_t kOneWriter = 0;

class LineWriter
{
public:
    LineWriter(const LineOptions& options, TextOut& out)
        : options_(&options), out_(&out), lines_(options.json ? logger::make_json_lines() : logger::make_human_lines())
    {
    }

    void note(const Entry& entry)
    {
        if (const auto place = place_of(entry)) note_run(place->run);
        if (const auto* events = entry.as<plab_v1_Events>())
        {
            note_gap(*events, event_numbers_, entry.channel->topic);
            for (std::uint32_t i = 0; i < events->entries._length; ++i)
                if (options_->filter.wants(events->entries._buffer[i])) add(lines_->event(*events, i));
        }
        if (const auto* collisions = entry.as<plab_v1_Collisions>())
        {
            note_gap(*collisions, collision_numbers_, entry.channel->topic);
            for (std::uint32_t i = 0; i < collisions->entries._length; ++i)
                if (options_->filter.wants(collisions->entries._buffer[i])) add(lines_->collision(*collisions, i));
        }
    }
    bool is_full() const { return out_->is_over() || (options_->count && written_ >= *options_->count); }

private:
    void note_run(std::uint64_t run)
    {
        if (run_ && run > *run_) out_->write(lines_->run(run) + "\n");
        run_ = std::max(run_.value_or(0), run);
    }
    template <class Sample>
    void note_gap(const Sample& sample, link::Sequence& numbers, const std::string& topic)
    {
        const auto missing = numbers.note(kOneWriter, sample.sequence_number, sample.entries._length);
        if (missing.count > 0) out_->write(lines_->gap({topic.c_str(), missing.first, missing.count}) + "\n");
    }
    void add(const std::string& line)
    {
        if (is_full()) return;
        out_->write(line + "\n");
        ++written_;
    }

    const LineOptions* options_;
    TextOut* out_;
    std::unique_ptr<logger::Lines> lines_;
    link::Sequence event_numbers_, collision_numbers_;
    std::optional<std::uint64_t> run_;
    std::uint64_t written_ = 0;
};

}  // namespace

Result<Troubles> write_lines(const Log& log, const LineOptions& options, TextOut& out)
{
    std::vector<std::string> topics;
    if (options.filter.events) topics.push_back("plab/events");
    if (options.filter.collisions) topics.push_back("plab/collisions");
    LineWriter writer(options, out);
    Stream stream = log.stream(topics, options.span);
    while (const Entry* entry = writer.is_full() ? nullptr : stream.next()) writer.note(*entry);
    if (auto done = out.finish(); !done) return done.errors();
    return stream.troubles();
}

}  // namespace plab::recordings
