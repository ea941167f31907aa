#include "foxglove/channels.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "idl/recording/topic_file.h"

namespace plab::foxglove
{
namespace
{

// The types that Foxglove's panels know by name, with the members that its documentation lists, in their order
// (https://docs.foxglove.dev/docs/visualization/message-schemas/scene-update, .../frame-transforms).
constexpr const char* kGeometry = R"(module foxglove {
struct Time { uint32 sec; uint32 nsec; };
struct Duration { int32 sec; uint32 nsec; };
struct Vector3 { double x; double y; double z; };
struct Point3 { double x; double y; double z; };
struct Quaternion { double x; double y; double z; double w; };
)";

constexpr const char* kFrameTransforms = R"(struct FrameTransform {
  Time timestamp; string parent_frame_id; string child_frame_id; Vector3 translation; Quaternion rotation;
};
struct FrameTransforms { sequence<FrameTransform> transforms; };
};
)";

constexpr const char* kSceneUpdate = R"(struct Pose { Vector3 position; Quaternion orientation; };
struct Color { double r; double g; double b; double a; };
struct KeyValuePair { string key; string value; };
struct ArrowPrimitive {
  Pose pose; double shaft_length; double shaft_diameter; double head_length; double head_diameter; Color color;
};
struct CubePrimitive { Pose pose; Vector3 size; Color color; };
struct SpherePrimitive { Pose pose; Vector3 size; Color color; };
struct CylinderPrimitive { Pose pose; Vector3 size; double bottom_scale; double top_scale; Color color; };
enum LineType { LINE_STRIP, LINE_LOOP, LINE_LIST };
struct LinePrimitive {
  LineType type; Pose pose; double thickness; boolean scale_invariant; sequence<Point3> points; Color color; sequence<Color> colors;
  sequence<uint32> indices;
};
struct TriangleListPrimitive {
  Pose pose; sequence<Point3> points; Color color; sequence<Color> colors; sequence<uint32> indices;
};
struct TextPrimitive { Pose pose; boolean billboard; double font_size; boolean scale_invariant; Color color; string text; };
struct ModelPrimitive {
  Pose pose; Vector3 scale; Color color; boolean override_color; string url; string media_type; sequence<uint8> data;
};
enum SceneEntityDeletionType { MATCHING_ID, ALL };
struct SceneEntityDeletion { Time timestamp; SceneEntityDeletionType type; string id; };
struct SceneEntity {
  Time timestamp; string frame_id; string id; Duration lifetime; boolean frame_locked; sequence<KeyValuePair> metadata;
  sequence<ArrowPrimitive> arrows; sequence<CubePrimitive> cubes; sequence<SpherePrimitive> spheres;
  sequence<CylinderPrimitive> cylinders; sequence<LinePrimitive> lines; sequence<TriangleListPrimitive> triangles;
  sequence<TextPrimitive> texts; sequence<ModelPrimitive> models;
};
struct SceneUpdate { sequence<SceneEntityDeletion> deletions; sequence<SceneEntity> entities; };
};
)";

Keep keep_of(wire::Delivery delivery)
{
    const bool is_newest = delivery == wire::Delivery::Catalogue || delivery == wire::Delivery::Newest;
    return is_newest ? Keep::Newest : Keep::Log;
}

std::vector<Channel> make_channels()
{
    std::vector<Channel> out;
    const auto add = [&](Channel channel)
    {
        channel.id = static_cast<ChannelId>(out.size() + 1);
        out.push_back(std::move(channel));
    };
    add({0, kSceneTopic, "foxglove::SceneUpdate", std::string(kGeometry) + kSceneUpdate, Keep::Whole, nullptr});
    add({0, kFramesTopic, "foxglove::FrameTransforms", std::string(kGeometry) + kFrameTransforms, Keep::Newest, nullptr});
    add({0, kContactsTopic, "foxglove::SceneUpdate", std::string(kGeometry) + kSceneUpdate, Keep::Newest, nullptr});
    for (const wire::Topic& topic : wire::topics())
    {
        const auto schema = recording::schema_of(topic);
        assert(schema && "idl/plab.idl declares the types of all topics");
        add({0, topic.name, schema->name, schema->data, keep_of(topic.delivery), &topic});
    }
    return out;
}

}  // namespace

std::span<const Channel> channels()
{
    static const std::vector<Channel> all = make_channels();
    return all;
}

const Channel* find_channel(ChannelId id) { return id >= 1 && id <= channels().size() ? &channels()[id - 1] : nullptr; }

const Channel& channel_of(const std::string& topic)
{
    const auto all = channels();
    const auto at = std::find_if(all.begin(), all.end(), [&](const Channel& c) { return c.topic == topic; });
    assert(at != all.end());
    return *at;
}

}  // namespace plab::foxglove
