#include "control/recording/player/track.h"

#include <cstring>

#include "idl/frame_updates.h"
#include "idl/recording/cdr.h"
#include "idl/recording/whole_frame.h"

namespace plab::player
{
namespace
{

/// DDS only reads the sample, although its types have no const.
// Which member contains the run, and which one is the key.
template <class T>
void put_run(T& sample, const Changes& changes)
{
    sample.run += changes.run_shift;
}
void put_run(plab_v2_Shape&, const Changes&) {}
void put_run(plab_v2_Type&, const Changes&) {}
void put_run(plab_v2_Scene& scene, const Changes& changes)
{
    scene.run += changes.run_shift;
    scene.server_name = wire::text(changes.server);
}

template <class T>
void put_key(T&, const std::string&)
{
}
void put_key(plab_v2_Scene& scene, const std::string& key) { scene.server_name = wire::text(key); }
void put_key(plab_v2_SceneObject& object, const std::string& key) { object.component_id = wire::text(key); }
void put_key(plab_v2_Shape& shape, const std::string& key) { shape.component_id = wire::text(key); }
void put_key(plab_v2_Interaction& interaction, const std::string& key) { interaction.component_id = wire::text(key); }
void put_key(plab_v2_Type& type, const std::string& key) { type.type_name = wire::text(key); }
void put_key(plab_v2_Image& image, const std::string& key) { image.camera = wire::text(key); }

template <class T>
constexpr bool kHasKey = std::is_same_v<T, plab_v2_Scene> || std::is_same_v<T, plab_v2_SceneObject> || std::is_same_v<T, plab_v2_Shape> ||
                         std::is_same_v<T, plab_v2_Interaction> || std::is_same_v<T, plab_v2_Type> || std::is_same_v<T, plab_v2_Image>;

template <class T>
std::uint64_t entries_of(const T& sample)
{
    if constexpr (std::is_same_v<T, plab_v2_Hashes>)
        return sample.values._length;
    else if constexpr (std::is_same_v<T, plab_v2_Collisions> || std::is_same_v<T, plab_v2_Events>)
        return sample.entries._length;
    else
        return 1;
}

template <class T>
class TrackOf final : public Track
{
public:
    /// Frames go out as a server's do, also as key frames and deltas.
    using Writer = std::conditional_t<std::is_same_v<T, plab_v2_Frame>, wire::FrameWriter, wire::DataWriter<T>>;

    TrackOf(Writer writer, bool moved_only) : writer_(std::move(writer)), moved_only_(moved_only) {}

    Result<void> send(recording::ByteView bytes, const Changes& changes) override
    {
        if (auto decoded = decoder_.decode(bytes, sample_); !decoded) return decoded;
        T out = whole();  // its texts and sequences still belong to sample_
        put_run(out, changes);
        if constexpr (requires { out.sequence_number; }) out.sequence_number = renumbered(out.sequence_number, entries_of(out));
        const dds_return_t code = writer_.write(out);
        if (code != DDS_RETCODE_OK) return wire::failed(std::string("cannot write ") + wire::topic_of<T>().name, code);
        return {};
    }
    void skip(recording::ByteView bytes) override
    {
        if (decoder_.decode(bytes, sample_)) (void)whole();
    }
    void dispose([[maybe_unused]] const std::string& key) override
    {
        if constexpr (kHasKey<T>)
        {
            T sample{};
            put_key(sample, key);
            (void)writer_.dispose(sample);  // an instance that was never written cannot be disposed of, and need not
        }
    }
    wire::Matched readers() const override { return writer_.matched(); }
    void flush(dds_duration_t longest) override { (void)dds_wait_for_acks(writer_.entity().get(), longest); }

protected:
    void forget() override { whole_.forget(); }

private:
    T whole()
    {
        if constexpr (std::is_same_v<T, plab_v2_Frame>)
            if (moved_only_) return whole_.with(*sample_);
        return *sample_;
    }

    Writer writer_;
    recording::Decoder decoder_;
    recording::Sample<T> sample_;
    recording::WholeFrame whole_;
    bool moved_only_;
};

struct Ends
{
    const wire::Entity& participant;
    const wire::Entity& publisher;
    bool moved_only;
};

/// True if T is the topic's type: `out` is then its track, or why there is none.
template <class T>
bool make_if(const wire::Topic& topic, const Ends& ends, Result<std::unique_ptr<Track>>& out)
{
    if (std::strcmp(wire::topic_of<T>().name, topic.name) != 0) return false;
    auto writer = TrackOf<T>::Writer::make(ends.participant, ends.publisher);
    if (writer)
        out = std::unique_ptr<Track>(std::make_unique<TrackOf<T>>(writer.take(), ends.moved_only));
    else
        out = writer.errors();
    return true;
}

template <class... Ts>
Result<std::unique_ptr<Track>> make_one_of(const wire::Topic& topic, const Ends& ends)
{
    Result<std::unique_ptr<Track>> out = reason(std::string(topic.name) + " is not a topic that a playback can write");
    (void)(make_if<Ts>(topic, ends, out) || ...);
    return out;
}

template <class... Ts>
bool is_one_of(const wire::Topic& topic)
{
    return ((std::strcmp(wire::topic_of<Ts>().name, topic.name) == 0) || ...);
}

}  // namespace

Result<std::unique_ptr<Track>> make_track(const wire::Topic& topic, const wire::Entity& participant, const wire::Entity& publisher,
                                          bool moved_only)
{
    return make_one_of<plab_v2_Scene, plab_v2_SceneObject, plab_v2_Shape, plab_v2_Interaction, plab_v2_Type, plab_v2_Frame,
                       plab_v2_Collisions, plab_v2_Events, plab_v2_Metrics, plab_v2_Image, plab_v2_Journal, plab_v2_Hashes,
                       plab_v2_Snapshot, plab_v2_ContactForces>(topic, {participant, publisher, moved_only});
}

bool is_played(const wire::Topic& topic)
{
    return !is_one_of<plab_v2_Server, plab_v2_Request, plab_v2_Reply, plab_v2_Gone, plab_v2_ViewerSample, plab_v2_UserSample,
                      plab_v2_Forces>(topic);
}

}  // namespace plab::player
