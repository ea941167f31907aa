#include "viewer/file_source.h"

#include <cstdio>

#include "idl/recording/format.h"
#include "idl/samples.h"
#include "viewer/scene_model.h"

namespace plab::view
{
namespace
{

/// A recording made from the bus has the catalogue in order of arrival, which may be after the first frame of its revision, by
/// up to this time.
constexpr std::uint64_t kFileSettle = 150'000'000;  // ns of wall time
constexpr std::uint64_t kFar = 1'000'000'000;       // ns of the recording: an upper bound, whatever the clocks say

template <class T>
const std::string& name_of()
{
    static const std::string name = wire::topic_of<T>().name;
    return name;
}

template <class T>
bool is_topic(const recording::Found& found)
{
    return found.channel->topic == name_of<T>();
}

std::optional<link::Metrics> metrics_of(recording::ByteView bytes)
{
    recording::Sample<plab_v2_Metrics> sample;
    recording::Decoder decoder;
    if (!decoder.decode(bytes, sample)) return {};
    return wire::value_of<link::Metrics>(*sample);
}

/// The last ones until `time`, or the first ones; empty: there are none.
std::optional<link::Metrics> metrics_at(const recording::McapReader& reader, std::uint64_t time)
{
    const auto last = reader.last_at(name_of<plab_v2_Metrics>(), time);
    if (last && *last) return metrics_of((*last)->data);
    recording::Cursor cursor = reader.messages({{name_of<plab_v2_Metrics>()}});
    const auto first = cursor.next();
    return first && *first ? metrics_of((*first)->message.data) : std::nullopt;
}

}  // namespace

Result<std::unique_ptr<Source>> FileSource::open(const std::string& file, std::optional<double> from)
{
    auto reader = recording::open_recording(file);
    if (!reader) return reader.errors();
    if (reader->channels_of({name_of<plab_v2_SceneObject>()}).empty())
        return reason(file + ": has no " + name_of<plab_v2_SceneObject>() + ": there is nothing to draw");
    std::unique_ptr<FileSource> out(new FileSource(reader.take()));
    out->start(from);
    return std::unique_ptr<Source>(std::move(out));
}

/// Skips what lies before a position far into the file. Time and time line differ by a constant within a run.
void FileSource::start(std::optional<double> from)
{
    catalogue_.emplace(reader_.messages({{name_of<plab_v2_Scene>(), name_of<plab_v2_SceneObject>(), name_of<plab_v2_Shape>(),
                                          name_of<plab_v2_Interaction>(), name_of<plab_v2_Gone>()}}));
    for (const wire::Topic* topic : {&wire::topic_of<plab_v2_Scene>(), &wire::topic_of<plab_v2_SceneObject>(),
                                     &wire::topic_of<plab_v2_Interaction>(), &wire::topic_of<plab_v2_Gone>()})
        peeks_.emplace(topic->name, recording::make_peek(*topic));
    const std::vector<std::string> states{name_of<plab_v2_Frame>()};
    frames_.emplace(reader_.messages({states}));
    const auto first = next_frame();
    const std::uint64_t log_time = first ? first->message.log_time : 0;
    const bool is_later = first && from && decode_frame(*first) && frame_->time < *from;
    const std::uint64_t run = is_later ? frame_->run : 0;
    const double ahead = is_later ? *from - frame_->time : 0;
    const std::uint64_t begin = frame_that_leads_to(log_time, static_cast<std::uint64_t>(ahead * 1e9));
    frames_.emplace(reader_.messages({states, begin}));
    if (begin == log_time) return;
    const auto there = next_frame();
    // In another run the constant differs: then there is no short cut.
    const bool is_there = there && decode_frame(*there) && frame_->run == run;
    frames_.emplace(reader_.messages({states, is_there ? begin : 0}));
}

/// The time of the frame needed to draw the one at `first` + `ahead`: the frame before it; if frames contain only what moved,
/// one before the last full frame.
std::uint64_t FileSource::frame_that_leads_to(std::uint64_t first, std::uint64_t ahead) const
{
    constexpr auto kBack = static_cast<std::uint64_t>(1.5e9 * recording::kFullFrameEvery);
    const auto about = reader_.metadata("plab");
    const bool moved_only = about && about->values.contains("states") && about->values.at("states") == "moved";
    if (moved_only) return first + (ahead > kBack ? ahead - kBack : 0);
    const auto before = reader_.last_at(name_of<plab_v2_Frame>(), first + ahead);
    return before && *before ? (*before)->message.log_time : first;
}

std::optional<recording::Found> FileSource::next_frame()
{
    while (true)
    {
        auto found = frames_->next();
        if (found) return *found;
        ++broken_;  // a damaged chunk: the cursor continues after it
    }
}

bool FileSource::decode_frame(const recording::Found& found)
{
    if (decoder_.decode(found.message.data, frame_)) return true;
    ++broken_;
    return false;
}

std::optional<Moment> FileSource::pop(link::Seconds)
{
    while (const auto found = next_frame())
    {
        if (!decode_frame(*found)) continue;
        const bool is_new = frame_->run != run_ || frame_->revision != revision_;
        run_ = frame_->run, revision_ = frame_->revision, time_ = frame_->time;
        follow_scene(found->message, is_new);
        show(found->message.log_time);
        any_ = true;
        return Moment{state_of(whole_.with(*frame_)), shown_};
    }
    if (!any_ && !closed_)
        if (auto moment = only_catalogue()) return moment;
    char text[64];
    std::snprintf(text, sizeof text, "the recording ends at t = %.3f s", time_);
    closed_ = text;
    if (broken_ > 0) *closed_ += ", and " + std::to_string(broken_) + " of its parts are damaged (plabctl recover)";
    return {};
}

/// A server that was paused all the time has sent no states: objects are at their last listed positions.
std::optional<Moment> FileSource::only_catalogue()
{
    const auto info = server();
    if (!info) return {};
    any_ = true, time_ = info->time;
    while (ahead()) apply(*std::exchange(ahead_, std::nullopt));
    show(std::numeric_limits<std::uint64_t>::max());
    return Moment{state_of_catalogue(*shown_, *info), shown_};
}

FileSource::Ahead& FileSource::ahead()
{
    while (!ahead_)
    {
        auto next = catalogue_->next();
        if (next)
        {
            ahead_ = *next;
            break;
        }
        ++broken_;
    }
    return ahead_;
}

void FileSource::follow_scene(const recording::Message& frame, bool is_new)
{
    const auto is_due = [&](const recording::Message& m)
    {
        if (m.log_time <= frame.log_time) return true;
        return is_new && m.log_time <= frame.log_time + kFar && m.publish_time > 0 && m.publish_time <= frame.publish_time + kFileSettle;
    };
    while (ahead() && is_due(ahead_->message) && !is_of_later(*ahead_)) apply(*std::exchange(ahead_, std::nullopt));
}

/// Whether a message of the catalogue belongs to a step after the frame's. A message without a time is dated by the last
/// message before it; if frames are rare, that may be long before.
bool FileSource::is_of_later(const recording::Found& found)
{
    const auto peek = peeks_.find(found.channel->topic);
    if (peek == peeks_.end()) return false;
    const auto header = peek->second->at(found.message.data);
    return header && (header->run > frame_->run || (header->run == frame_->run && header->step > frame_->step));
}

void FileSource::apply(const recording::Found& found)
{
    const auto decoded = [&]<class T>(recording::Sample<T>& sample)
    {
        if (!is_topic<T>(found)) return false;
        if (decoder_.decode(found.message.data, sample)) return is_changed_ = true;
        ++broken_;
        return false;
    };
    recording::Sample<plab_v2_Scene> scene;
    recording::Sample<plab_v2_SceneObject> object;
    recording::Sample<plab_v2_Shape> shape;
    recording::Sample<plab_v2_Interaction> interaction;
    recording::Sample<plab_v2_Gone> gone;
    if (decoded(scene)) now_.scene = wire::value_of<link::Scene>(*scene);
    if (decoded(object)) wire::read_sample(*object, now_.objects[object->component_id]);
    if (decoded(shape)) wire::read_sample(*shape, now_.shapes[shape->component_id]);
    if (decoded(interaction)) wire::read_sample(*interaction, now_.interactions[interaction->component_id]);
    if (decoded(gone)) erase(gone->topic_name, gone->component_id);
}

void FileSource::erase(const std::string& topic, const std::string& id)
{
    const auto erase_from = [&]<class T>(std::map<std::string, T>& things)
    {
        if (id.empty())
            things.clear();
        else
            things.erase(id);
    };
    if (topic == name_of<plab_v2_SceneObject>()) erase_from(now_.objects);
    if (topic == name_of<plab_v2_Shape>()) erase_from(now_.shapes);
    if (topic == name_of<plab_v2_Interaction>()) erase_from(now_.interactions);
}

/// The scene to show from now on; costs decide which captions are shown, so it gets the last ones, or the first.
void FileSource::show(std::uint64_t time)
{
    if (!is_changed_) return;
    is_changed_ = false;
    now_.metrics = metrics_at(reader_, time);
    shown_ = std::make_shared<const link::CatalogueContents>(now_);
}

std::optional<link::ServerInfo> FileSource::server() const
{
    const auto last = reader_.last_at(name_of<plab_v2_Server>(), std::numeric_limits<std::uint64_t>::max());
    if (!last || !*last) return {};
    recording::Sample<plab_v2_Server> sample;
    recording::Decoder decoder;
    if (!decoder.decode((*last)->data, sample)) return {};
    return wire::value_of<link::ServerInfo>(*sample);
}

}  // namespace plab::view
