#include "control/recording/analysis/log.h"

#include <cmath>
#include <limits>

#include "idl/recording/format.h"

namespace plab::analysis
{
namespace
{

/// Times beyond every recording are clamped to the limits of the scale.
std::uint64_t nanoseconds(double time)
{
    const double ns = std::round(time * 1e9);
    if (!(ns > 0)) return 0;
    constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();
    return ns >= static_cast<double>(kMost) ? kMost : static_cast<std::uint64_t>(ns);
}

}  // namespace

std::string full_topic(const std::string& name)
{
    for (const wire::Topic& topic : wire::topics())
        if (topic.name == "plab/" + name) return topic.name;
    return name;
}

Result<Log> Log::open(const std::string& path, const recording::Watch& watch)
{
    const auto interrupted = std::make_shared<bool>(false);
    const auto note = [watch, interrupted](double share) { return !(*interrupted = *interrupted || !watch(share)); };
    auto reader = recording::open_recording(path, watch ? recording::Watch(note) : recording::Watch());
    if (!reader) return reader.errors();
    Log log(std::make_unique<recording::McapReader>(reader.take()));
    log.interrupted_ = interrupted;
    for (const recording::MetadataIndex& place : log.reader_->index().metadata)
    {
        if (place.name != recording::kAbout) continue;
        auto metadata = log.reader_->metadata(place);
        if (metadata)
            log.head_ = metadata->values;
        else
            log.troubles_.add(metadata.error().text());
        break;
    }
    Stream stream = log.stream({"plab/objects", "plab/interactions", "plab/scene", "plab/journal", "plab/server"});
    while (const Entry* entry = stream.next()) log.things_.note(*entry), log.runs_.note(*entry);
    log.troubles_.merge(stream.troubles());
    return log;
}

recording::Query Log::query(const std::vector<std::string>& topics, const Span& span)
{
    recording::Query query;
    query.topics = topics;
    if (span.from) query.from = nanoseconds(*span.from);
    if (span.to) query.to = nanoseconds(*span.to);
    return query;
}

Stream Log::stream(const std::vector<std::string>& topics, const Span& span) const { return Stream(*reader_, query(topics, span)); }

}  // namespace plab::analysis
