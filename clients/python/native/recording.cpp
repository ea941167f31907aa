#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "idl/recording/cdr.h"
#include "idl/recording/format.h"
#include "idl/recording/whole_frame.h"
#include "idl/samples.h"
#include "link/json.h"
#include "python/native/guard.h"
#include "python/native/handles.h"

/// The reader does not move: the cursor points to it.
struct PlabRecording
{
    plab::recording::McapReader reader;
    std::optional<plab::recording::Cursor> cursor;
    plab::recording::Decoder decoder;
    plab::recording::Sample<plab_v2_Frame> frame;
    plab::recording::WholeFrame whole;
    std::string text;
};

namespace
{

using namespace plab;
using python::guarded;
using recording::ByteView;

/// A topic's messages as JSON.
using ToJson = Result<link::Json> (*)(recording::Decoder&, ByteView);

template <class Value, class T>
Result<link::Json> value_json(recording::Decoder& decoder, ByteView bytes)
{
    recording::Sample<T> sample;
    if (auto decoded = decoder.decode(bytes, sample); !decoded) return decoded.errors();
    return link::json_of(wire::value_of<Value>(*sample));
}

template <class T>
Result<link::Json> entries_json(recording::Decoder& decoder, ByteView bytes)
{
    recording::Sample<T> sample;
    if (auto decoded = decoder.decode(bytes, sample); !decoded) return decoded.errors();
    link::Json out = link::Json::array();
    for (std::uint32_t i = 0; i < sample->entries._length; ++i) out.push_back(link::json_of(*sample, i));
    return out;
}

const std::map<std::string, ToJson>& json_topics()
{
    static const std::map<std::string, ToJson> topics{
        {wire::topic_of<plab_v2_SceneObject>().name, &value_json<wire::SceneObject, plab_v2_SceneObject>},
        {wire::topic_of<plab_v2_Interaction>().name, &value_json<wire::Interaction, plab_v2_Interaction>},
        {wire::topic_of<plab_v2_Metrics>().name, &value_json<wire::Metrics, plab_v2_Metrics>},
        {wire::topic_of<plab_v2_Events>().name, &entries_json<plab_v2_Events>},
        {wire::topic_of<plab_v2_Collisions>().name, &entries_json<plab_v2_Collisions>},
    };
    return topics;
}

bool is_states(const std::string& topic) { return topic == wire::topic_of<plab_v2_Frame>().name; }

Result<PlabRecording*> open(const char* path)
{
    auto reader = recording::open_recording(path);
    if (!reader) return reader.errors();
    return new PlabRecording{reader.take(), {}, {}, {}, {}, {}};
}

Result<const char*> about(PlabRecording& recording)
{
    link::Json out = link::Json::object();
    // A file whose beginning was lost has none.
    if (const auto metadata = recording.reader.metadata(recording::kAbout))
        for (const auto& [key, value] : metadata->values) out[key] = value;
    recording.text = link::line_of(out);
    return recording.text.c_str();
}

std::uint64_t nanoseconds(double seconds)
{
    constexpr double kMost = 9e18;
    return seconds > 0 ? static_cast<std::uint64_t>(std::fmin(std::round(seconds * 1e9), kMost)) : 0;
}

Result<int> select(PlabRecording& recording, const char* const* topics, std::size_t count, double from, double to)
{
    recording::Query query{{topics, topics + count}, nanoseconds(from), nanoseconds(to)};
    for (const std::string& topic : query.topics)
        if (!is_states(topic) && !json_topics().contains(topic)) return reason("messages of '" + topic + "' cannot be read here");
    recording.whole.forget();
    recording.cursor = recording.reader.messages(query);
    return 1;
}

/// Frames are completed: a recording may omit what did not move.
Result<void> read(PlabRecording& recording, const recording::Found& found, PlabMessage& out)
{
    if (is_states(out.topic))
    {
        if (auto decoded = recording.decoder.decode(found.message.data, recording.frame); !decoded) return decoded.errors();
        const plab_v2_Frame& whole = recording.whole.with(*recording.frame);
        out.frame = python::view_of(whole, whole.bodies._buffer, whole.bodies._length, whole.shafts._buffer, whole.shafts._length);
        return {};
    }
    auto json = json_topics().at(out.topic)(recording.decoder, found.message.data);
    if (!json) return json.errors();
    recording.text = link::line_of(*json);
    out.text = recording.text.c_str();
    return {};
}

Result<int> next(PlabRecording& recording, PlabMessage& out)
{
    if (!recording.cursor) return reason("no messages are selected");
    auto found = recording.cursor->next();
    if (!found) return found.errors();
    if (!*found) return 0;
    out = {};
    out.topic = (*found)->channel->topic.c_str();
    out.time = static_cast<double>((*found)->message.log_time) * 1e-9;
    if (auto done = read(recording, **found, out); !done)
        return reason(recording.reader.name() + ": " + out.topic + " at " + std::to_string(out.time) + " s: " + done.error().text());
    return 1;
}

}  // namespace

PlabRecording* plab_recording_open(const char* path)
{
    return guarded([&] { return open(path); });
}

const char* plab_recording_about(PlabRecording* recording)
{
    return guarded([&] { return about(*recording); });
}

int plab_recording_select(PlabRecording* recording, const char* const* topics, std::size_t count, double from, double to)
{
    return guarded([&] { return select(*recording, topics, count, from, to); });
}

int plab_recording_next(PlabRecording* recording, PlabMessage* out)
{
    return guarded([&] { return next(*recording, *out); });
}

void plab_recording_close(PlabRecording* recording) { delete recording; }
