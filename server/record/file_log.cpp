#include "record/file_log.h"

#include <algorithm>

#include "idl/samples.h"

namespace plab::record
{
namespace
{

/// A frame that has only what moved, into the one before it.
void merge(const wire::Frame& f, wire::Frame& out)
{
    out.run = f.run, out.revision = f.revision, out.sequence_number = f.sequence_number;
    out.step = f.step, out.time = f.time, out.stamp_ns = f.stamp_ns;
    const auto put = [](auto& list, const auto& states)
    {
        for (const auto& state : states)
        {
            const auto at = std::find_if(list.begin(), list.end(), [&](const auto& s) { return s.handle == state.handle; });
            if (at != list.end())
                *at = state;
            else
                list.push_back(state);
        }
    };
    put(out.bodies, f.bodies), put(out.shafts, f.shafts);
}

}  // namespace

Result<std::unique_ptr<FileLog>> FileLog::open(const std::string& file)
{
    auto reader = recording::open_recording(file);
    if (!reader) return reader.errors();
    std::unique_ptr<FileLog> log(new FileLog(reader.take()));
    if (auto listed = log->list_snapshots(); !listed) return listed.errors();
    return log;
}

template <class T, class Use>
Result<void> FileLog::each(const recording::Query& query, Use use)
{
    recording::Sample<T> sample;
    recording::Cursor cursor = reader_.messages(query);
    for (;;)
    {
        auto next = cursor.next();
        if (!next) return next.errors();
        if (!*next) return {};
        if (auto decoded = decoder_.decode((*next)->message.data, sample); !decoded) return decoded.errors();
        if (!use(*sample, (*next)->message.log_time)) return {};
    }
}

recording::Query FileLog::query_of(const char* topic, std::uint64_t run) const
{
    recording::Query query;
    query.topics = {topic};
    const auto begin = begin_of_run_.find(run);
    if (begin != begin_of_run_.end()) query.from = begin->second;
    return query;
}

Result<void> FileLog::list_snapshots()
{
    return each<plab_v2_Snapshot>({.topics = {wire::topic_of<plab_v2_Snapshot>().name}},
                                  [&](const plab_v2_Snapshot& s, std::uint64_t log_time)
                                  {
                                      begin_of_run_.try_emplace(s.run, log_time);
                                      snapshots_.push_back({s.run, s.step, s.time, s.name, s.cause, log_time});
                                      return true;
                                  });
}

Result<wire::Snapshot> FileLog::read(const RecordedSnapshot& snapshot)
{
    std::optional<wire::Snapshot> out;
    recording::Query query;
    query.topics = {wire::topic_of<plab_v2_Snapshot>().name};
    query.from = query.to = snapshot.place;
    auto done = each<plab_v2_Snapshot>(query,
                                       [&](const plab_v2_Snapshot& s, std::uint64_t)
                                       {
                                           if (s.run != snapshot.run || s.step != snapshot.step) return true;
                                           out = wire::value_of<wire::Snapshot>(s);
                                           return false;
                                       });
    if (!done) return done.errors();
    if (!out) return reason(reader_.name() + ": the snapshot of step " + std::to_string(snapshot.step) + " is not there");
    return *std::move(out);
}

Result<std::vector<wire::Journal>> FileLog::journal(std::uint64_t run)
{
    std::vector<wire::Journal> out;
    auto done = each<plab_v2_Journal>(query_of(wire::topic_of<plab_v2_Journal>().name, run),
                                      [&](const plab_v2_Journal& j, std::uint64_t)
                                      {
                                          if (j.run == run) out.push_back(wire::value_of<wire::Journal>(j));
                                          return true;
                                      });
    if (!done) return done.errors();
    std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.sequence_number < b.sequence_number; });
    return out;
}

Result<void> FileLog::begin_hashes(std::uint64_t run)
{
    hash_run_ = run;
    hashes_.emplace(reader_.messages(query_of(wire::topic_of<plab_v2_Hashes>().name, run)));
    return {};
}

Result<std::optional<wire::Hashes>> FileLog::next_hashes()
{
    while (hashes_)
    {
        auto next = hashes_->next();
        if (!next) return next.errors();
        if (!*next) break;
        if (auto decoded = decoder_.decode((*next)->message.data, hash_sample_); !decoded) return decoded.errors();
        if (hash_sample_->run != hash_run_) continue;
        return std::optional(wire::value_of<wire::Hashes>(*hash_sample_));
    }
    return std::optional<wire::Hashes>();
}

Result<std::optional<wire::Frame>> FileLog::frame(std::uint64_t run, Tick step)
{
    // Frames may contain only what moved: merge all frames of the run up to that one to get a complete one.
    wire::Frame merged;
    bool there = false;
    auto done = each<plab_v2_Frame>(query_of(wire::topic_of<plab_v2_Frame>().name, run),
                                    [&](const plab_v2_Frame& f, std::uint64_t)
                                    {
                                        if (f.run != run) return true;
                                        // If there are several after one step, the last one counts: a request may have changed
                                        // states.
                                        if (there && f.step > merged.step) return false;
                                        merge(wire::value_of<wire::Frame>(f), merged);
                                        there = f.step >= step;
                                        return f.step <= step;
                                    });
    if (!done) return done.errors();
    return there ? std::optional(std::move(merged)) : std::nullopt;
}

Result<std::vector<std::pair<std::uint32_t, std::string>>> FileLog::objects(std::uint64_t run)
{
    std::map<std::uint32_t, std::string> names;
    auto done = each<plab_v2_SceneObject>({.topics = {wire::topic_of<plab_v2_SceneObject>().name}},
                                          [&](const plab_v2_SceneObject& o, std::uint64_t)
                                          {
                                              if (o.run == run) names[o.handle] = o.component_id;
                                              return true;
                                          });
    if (!done) return done.errors();
    return std::vector<std::pair<std::uint32_t, std::string>>(names.begin(), names.end());
}

std::string FileLog::origin(const std::string& key) const
{
    const auto about = reader_.metadata(recording::kAbout);
    if (!about) return {};
    const auto found = about->values.find(key);
    return found == about->values.end() ? std::string() : found->second;
}

std::string FileLog::damage() const
{
    const recording::FileIndex& index = reader_.index();
    if (!index.troubles.empty()) return index.troubles.front().text();
    return index.is_closed ? std::string() : reader_.name() + " was not closed: the last messages may be missing";
}

}  // namespace plab::record
