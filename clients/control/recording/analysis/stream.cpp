#include "control/recording/analysis/stream.h"

#include <algorithm>
#include <tuple>

#include "idl/recording/cdr.h"

namespace plab::analysis
{

using recording::Sample;

void Troubles::add(const std::string& text)
{
    if (++count <= kMostTexts) texts.push_back(text);
}

void Troubles::merge(const Troubles& other)
{
    for (const std::string& text : other.texts)
        if (std::find(texts.begin(), texts.end(), text) == texts.end()) add(text);
    count += other.count - other.texts.size();
}

struct Stream::Samples
{
    recording::Decoder decoder;
    std::tuple<Sample<plab_v2_Server>, Sample<plab_v2_Scene>, Sample<plab_v2_SceneObject>, Sample<plab_v2_Shape>,
               Sample<plab_v2_Interaction>, Sample<plab_v2_Type>, Sample<plab_v2_Frame>, Sample<plab_v2_Collisions>, Sample<plab_v2_Events>,
               Sample<plab_v2_Metrics>, Sample<plab_v2_Request>, Sample<plab_v2_Reply>, Sample<plab_v2_Image>, Sample<plab_v2_Journal>,
               Sample<plab_v2_Hashes>, Sample<plab_v2_Snapshot>, Sample<plab_v2_Gone>>
        all;
};

template <class T>
Result<Content> Stream::decode(Samples& samples, recording::ByteView bytes)
{
    auto& sample = std::get<Sample<T>>(samples.all);
    if (auto done = samples.decoder.decode(bytes, sample); !done) return done.errors();
    return Content(static_cast<const T*>(&*sample));
}

template <class T>
void Stream::enter(std::map<std::string_view, Decode>& table)
{
    table.emplace(wire::topic_of<T>().name, &Stream::decode<T>);
}

const std::map<std::string_view, Stream::Decode>& Stream::table()
{
    static const auto made = []
    {
        std::map<std::string_view, Decode> out;
        enter<plab_v2_Server>(out), enter<plab_v2_Scene>(out), enter<plab_v2_SceneObject>(out), enter<plab_v2_Shape>(out);
        enter<plab_v2_Interaction>(out), enter<plab_v2_Type>(out), enter<plab_v2_Frame>(out), enter<plab_v2_Collisions>(out);
        enter<plab_v2_Events>(out), enter<plab_v2_Metrics>(out), enter<plab_v2_Request>(out), enter<plab_v2_Reply>(out);
        enter<plab_v2_Image>(out), enter<plab_v2_Journal>(out), enter<plab_v2_Hashes>(out), enter<plab_v2_Snapshot>(out),
            enter<plab_v2_Gone>(out);
        return out;
    }();
    return made;
}

Stream::Stream(const recording::McapReader& reader, const recording::Query& query)
    : reader_(&reader), cursor_(reader.messages(query)), samples_(std::make_unique<Samples>())
{
}
Stream::~Stream() = default;
Stream::Stream(Stream&&) noexcept = default;

/// Null: not of this version of the wire.
Stream::Decode Stream::decode_for(const recording::Channel& channel)
{
    const auto [known, is_new] = decodes_.try_emplace(channel.id, nullptr);
    if (!is_new) return known->second;
    const auto found = table().find(channel.topic);
    if (found == table().end() || channel.message_encoding != "cdr") return nullptr;
    const recording::Schema* const schema = reader_->schema_of(channel);
    for (const wire::Topic& topic : wire::topics())
        if (channel.topic == topic.name && schema != nullptr && schema->name == topic.type->m_typename) known->second = found->second;
    return known->second;
}

const Entry* Stream::next()
{
    while (true)
    {
        auto found = cursor_.next();
        if (!found)
        {
            troubles_.add(found.error().text());
            continue;
        }
        if (!*found) return nullptr;
        const recording::Found& here = **found;
        entry_ = {here.channel, here.message.log_time, here.message.publish_time, here.message.data, {}};
        const Decode how = decode_for(*here.channel);
        if (how == nullptr) return &entry_;
        auto content = how(*samples_, here.message.data);
        if (content)
        {
            entry_.content = *content;
            return &entry_;
        }
        troubles_.add(reader_->name() + ": " + here.channel->topic + " at " + std::to_string(here.message.log_time) +
                      " ns: " + content.error().text());
    }
}

namespace
{

using Places = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

template <class State>
Places places_of(std::span<const State> states)
{
    Places out;
    out.reserve(states.size());
    for (std::uint32_t i = 0; i < states.size(); ++i) out.emplace_back(states[i].handle, i);
    std::sort(out.begin(), out.end());
    return out;
}

template <class State>
const State* find(const Places& places, std::span<const State> states, std::uint32_t handle)
{
    const auto at = std::lower_bound(places.begin(), places.end(), std::pair(handle, std::uint32_t{0}));
    return at != places.end() && at->first == handle ? &states[at->second] : nullptr;
}

}  // namespace

void Merged::note(const plab_v2_Frame& frame)
{
    now_ = &whole_.with(frame);
    // Within a revision rows keep their places; new ones are appended.
    const bool same =
        frame.run == run_ && frame.revision == revision_ && bodies_.size() == bodies().size() && shafts_.size() == shafts().size();
    if (same) return;
    run_ = frame.run, revision_ = frame.revision;
    bodies_ = places_of(bodies()), shafts_ = places_of(shafts());
}

const plab_v2_BodyState* Merged::find_body(std::uint32_t handle) const { return find(bodies_, bodies(), handle); }
const plab_v2_ShaftState* Merged::find_shaft(std::uint32_t handle) const { return find(shafts_, shafts(), handle); }

}  // namespace plab::analysis
