#include "control/recording/analysis/lines.h"

#include <initializer_list>
#include <set>

#include "link/names.h"
#include "link/sequence.h"
#include "logger/lines.h"

namespace plab::analysis
{
namespace
{

constexpr std::uint64_t kOneWriter = 0;

class LineWriter
{
public:
    LineWriter(const LineOptions& options, program::TextOut& out)
        : options_(&options), out_(&out), lines_(options.json ? logger::make_json_lines() : logger::make_human_lines())
    {
    }

    void note(const Entry& entry)
    {
        if (const auto place = run_position_of(entry)) note_run(place->run);
        if (const auto* events = entry.as<plab_v2_Events>())
        {
            note_gap(*events, event_numbers_, entry.channel->topic);
            for (std::uint32_t i = 0; i < events->entries._length; ++i)
                if (options_->filter.wants(events->entries._buffer[i])) add(lines_->event(*events, i));
        }
        if (const auto* collisions = entry.as<plab_v2_Collisions>())
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
    program::TextOut* out_;
    std::unique_ptr<logger::Lines> lines_;
    link::Sequence event_numbers_, collision_numbers_;
    std::optional<std::uint64_t> run_;
    std::uint64_t written_ = 0;
};

/// Names of a filter that were not found in the recording so far.
class Unknown
{
public:
    Unknown(const logger::Filter& filter, const Things& things) : objects_(filter.objects), kinds_(filter.kinds)
    {
        for (const auto& ids : {things.objects(), things.interactions()}) known_objects_.insert(ids.begin(), ids.end());
        std::erase_if(objects_, [&](const std::string& id) { return known_objects_.contains(id); });
        for (const char* kind : {"begin", "impact", "rest", "end"}) note_kind(std::string("collision.") + kind);
    }
    bool is_empty() const { return objects_.empty() && kinds_.empty(); }
    void note(const Entry& entry)
    {
        const auto note_ids = [&](std::initializer_list<const char*> ids)
        {
            for (const char* id : ids) std::erase(objects_, id);
        };
        if (const auto* events = entry.as<plab_v2_Events>())
            for (std::uint32_t i = 0; i < events->entries._length; ++i)
            {
                const plab_v2_EventInfo& e = events->entries._buffer[i];
                note_kind(e.kind), note_ids({e.component_id, e.a, e.b});
            }
        if (const auto* collisions = entry.as<plab_v2_Collisions>())
            for (std::uint32_t i = 0; i < collisions->entries._length; ++i)
            {
                const plab_v2_CollisionInfo& c = collisions->entries._buffer[i];
                note_kind(std::string("collision.") + c.kind), note_ids({c.detector, c.a, c.b});
            }
    }
    Errors errors(const std::string& file) const
    {
        Errors out;
        for (const std::string& kind : kinds_)
            out.push_back(
                reason(file + " has no event or collision whose kind begins with '" + kind + "'" + suggestion(kind, known_kinds_)));
        for (const std::string& id : objects_)
            out.push_back(reason(file + " has no component '" + id + "'" + suggestion(id, known_objects_)));
        return out;
    }

private:
    void note_kind(const std::string& kind)
    {
        if (!known_kinds_.insert(kind).second) return;
        std::erase_if(kinds_, [&](const std::string& beginning) { return kind.starts_with(beginning); });
    }
    static std::string suggestion(const std::string& name, const std::set<std::string>& known)
    {
        return link::did_you_mean(name, {known.begin(), known.end()});
    }

    std::vector<std::string> objects_, kinds_;
    std::set<std::string> known_objects_, known_kinds_;
};

}  // namespace

Result<void> check_names(const Log& log, const logger::Filter& filter)
{
    Unknown unknown(filter, log.things());
    if (unknown.is_empty()) return {};
    // Authors define kinds of events, and the catalogue may be missing in the file: only the recorded events show which kinds
    // exist.
    Stream stream = log.stream({"plab/events", "plab/collisions"});
    for (const Entry* entry = stream.next(); entry != nullptr && !unknown.is_empty(); entry = stream.next()) unknown.note(*entry);
    if (unknown.is_empty()) return {};
    return unknown.errors(log.path());
}

Result<Troubles> write_lines(const Log& log, const LineOptions& options, program::TextOut& out)
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

}  // namespace plab::analysis
