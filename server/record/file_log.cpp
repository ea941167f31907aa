#include "record/file_log.h"

#include <algorithm>

#include "wire/wire_view.h"

namespace plab::record
{
namespace
{

Vec3 vector_of(const plab_v2_Vector& v) { return {v.x, v.y, v.z}; }
Quat rotation_of(const plab_v2_Rotation& q) { return {q.w, q.x, q.y, q.z}; }

publish::OperationText operation_of(const plab_v2_Operation& op)
{
    publish::OperationText out{op.verb, op.target, op.argument, op.blueprint, {}};
    for (std::uint32_t i = 0; i < op.values._length; ++i) out.values.emplace_back(op.values._buffer[i].name, op.values._buffer[i].text);
    return out;
}

publish::JournalRecord journal_of(const plab_v2_Journal& j)
{
    publish::JournalRecord out;
    out.run = j.run, out.revision = j.revision, out.number = j.sequence_number, out.step = j.step, out.time = j.time;
    out.origin = std::string_view(j.origin) == "client" ? "client" : "command line";
    std::copy(std::begin(j.client), std::end(j.client), out.client.begin());
    out.request = j.number;
    for (std::uint32_t i = 0; i < j.operations._length; ++i) out.operations.push_back(operation_of(j.operations._buffer[i]));
    return out;
}

const char* cause_of(std::string_view cause)
{
    for (const char* known : {"begin", "periodic", "request"})
        if (cause == known) return known;
    return "";
}

void merge(const plab_v2_Frame& f, publish::Frame& out)
{
    out.run = f.run, out.revision = f.revision, out.number = f.sequence_number;
    out.step = f.step, out.time = f.time, out.stamp_ns = f.stamp_ns;
    const auto put = [](auto& list, const auto& state)
    {
        const auto at = std::find_if(list.begin(), list.end(), [&](const auto& s) { return s.handle == state.handle; });
        if (at != list.end())
            *at = state;
        else
            list.push_back(state);
    };
    for (std::uint32_t i = 0; i < f.bodies._length; ++i)
    {
        const plab_v2_BodyState& b = f.bodies._buffer[i];
        put(out.bodies, publish::BodyState{b.handle, vector_of(b.position), rotation_of(b.orientation), vector_of(b.linear_velocity),
                                           vector_of(b.angular_velocity)});
    }
    for (std::uint32_t i = 0; i < f.shafts._length; ++i)
    {
        const plab_v2_ShaftState& s = f.shafts._buffer[i];
        put(out.shafts, publish::ShaftState{s.handle, s.angle, s.speed});
    }
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

Result<publish::SnapshotRecord> FileLog::read(const RecordedSnapshot& snapshot)
{
    std::optional<publish::SnapshotRecord> out;
    recording::Query query;
    query.topics = {wire::topic_of<plab_v2_Snapshot>().name};
    query.from = query.to = snapshot.place;
    auto done = each<plab_v2_Snapshot>(query,
                                       [&](const plab_v2_Snapshot& s, std::uint64_t)
                                       {
                                           if (s.run != snapshot.run || s.step != snapshot.step) return true;
                                           out.emplace();
                                           out->run = s.run, out->revision = s.revision, out->step = s.step, out->time = s.time;
                                           out->name = s.name, out->cause = cause_of(s.cause), out->state_hash = s.state_hash;
                                           out->blueprint = s.blueprint;
                                           out->data.assign(s.data._buffer, s.data._buffer + s.data._length);
                                           return false;
                                       });
    if (!done) return done.errors();
    if (!out) return reason(reader_.name() + ": the snapshot of step " + std::to_string(snapshot.step) + " is not there");
    return *std::move(out);
}

Result<std::vector<publish::JournalRecord>> FileLog::journal(std::uint64_t run)
{
    std::vector<publish::JournalRecord> out;
    auto done = each<plab_v2_Journal>(query_of(wire::topic_of<plab_v2_Journal>().name, run),
                                      [&](const plab_v2_Journal& j, std::uint64_t)
                                      {
                                          if (j.run == run) out.push_back(journal_of(j));
                                          return true;
                                      });
    if (!done) return done.errors();
    std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
    return out;
}

Result<void> FileLog::begin_hashes(std::uint64_t run)
{
    hash_run_ = run;
    hashes_.emplace(reader_.messages(query_of(wire::topic_of<plab_v2_Hashes>().name, run)));
    return {};
}

Result<std::optional<publish::HashRecord>> FileLog::next_hashes()
{
    while (hashes_)
    {
        auto next = hashes_->next();
        if (!next) return next.errors();
        if (!*next) break;
        if (auto decoded = decoder_.decode((*next)->message.data, hash_sample_); !decoded) return decoded.errors();
        if (hash_sample_->run != hash_run_) continue;
        publish::HashRecord out;
        out.run = hash_sample_->run, out.first = hash_sample_->sequence_number, out.step = hash_sample_->step;
        out.hashes.assign(hash_sample_->values._buffer, hash_sample_->values._buffer + hash_sample_->values._length);
        return std::optional(std::move(out));
    }
    return std::optional<publish::HashRecord>();
}

Result<std::optional<publish::Frame>> FileLog::frame(std::uint64_t run, Tick step)
{
    // Frames may contain only what moved: merge all frames of the run up to that one to get a complete one.
    publish::Frame merged;
    bool there = false;
    auto done = each<plab_v2_Frame>(query_of(wire::topic_of<plab_v2_Frame>().name, run),
                                    [&](const plab_v2_Frame& f, std::uint64_t)
                                    {
                                        if (f.run != run) return true;
                                        // If there are several after one step, the last one counts: a request may have changed
                                        // states.
                                        if (there && f.step > merged.step) return false;
                                        merge(f, merged);
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
