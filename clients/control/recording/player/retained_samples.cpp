#include "control/recording/player/retained_samples.h"

#include <algorithm>
#include <array>

#include "idl/recording/cdr.h"

namespace plab::player
{
namespace
{

const std::array<const wire::Topic*, 5>& catalogue_topics()
{
    static const std::array<const wire::Topic*, 5> topics{&wire::topic_of<plab_v2_SceneObject>(), &wire::topic_of<plab_v2_Shape>(),
                                                          &wire::topic_of<plab_v2_Interaction>(), &wire::topic_of<plab_v2_Type>(),
                                                          &wire::topic_of<plab_v2_Scene>()};
    return topics;
}

const char* gone_topic() { return wire::topic_of<plab_v2_Gone>().name; }

}  // namespace

bool is_catalogue(const std::string& topic)
{
    const auto& all = catalogue_topics();
    return std::any_of(all.begin(), all.end(), [&](const wire::Topic* t) { return topic == t->name; });
}

RetainedSamples::RetainedSamples()
{
    for (const wire::Topic* topic : catalogue_topics()) peeks_.emplace(topic->name, recording::make_peek(*topic));
}

Result<InstanceKey> RetainedSamples::put(const std::string& topic, recording::ByteView bytes)
{
    auto header = peeks_.at(topic)->at(bytes);
    if (!header) return header.errors();
    InstanceKey place{topic, header->key};
    entries_[place].assign(bytes.begin(), bytes.end());
    return place;
}

Result<std::set<InstanceKey>> RetainedSamples::remove(recording::ByteView gone)
{
    recording::Sample<plab_v2_Gone> sample;
    recording::Decoder decoder;
    if (auto decoded = decoder.decode(gone, sample); !decoded) return decoded.errors();
    const std::string topic = sample->topic_name, key = sample->component_id;
    std::set<InstanceKey> out;
    for (auto entry = entries_.begin(); entry != entries_.end();)
    {
        const bool goes = entry->first.first == topic && (key.empty() || entry->first.second == key);
        if (goes) out.insert(entry->first);
        entry = goes ? entries_.erase(entry) : std::next(entry);
    }
    return out;
}

RetainedSamples retained_at(const recording::McapReader& reader, std::uint64_t time)
{
    recording::Query query{{gone_topic()}, 0, time};
    for (const wire::Topic* topic : catalogue_topics()) query.topics.emplace_back(topic->name);
    RetainedSamples out;
    recording::Cursor messages = reader.messages(query);
    while (true)
    {
        const auto next = messages.next();
        if (!next) continue;  // the cursor goes on behind what is damaged
        if (!*next) return out;
        const recording::Found& found = **next;
        if (found.channel->topic == gone_topic())
            (void)out.remove(found.message.data);
        else
            (void)out.put(found.channel->topic, found.message.data);
    }
}

}  // namespace plab::player
