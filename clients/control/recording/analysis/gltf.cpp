#include "control/recording/analysis/gltf.h"

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "control/recording/analysis/gltf_file.h"
#include "control/recording/analysis/gltf_tracks.h"
#include "idl/topics.h"

namespace plab::analysis
{
namespace
{

using Json = GltfFile::Json;

struct GltfShape
{
    Pose pose;
    GltfSurface surface;
};

struct GltfObject
{
    std::string id;
    std::uint32_t handle = 0;
    bool is_static = false;
    Pose pose;
    Vec3 color;
    std::vector<std::string> shapes;
};

Pose pose_of(const plab_v2_Vector& p, const plab_v2_Rotation& r)
{
    const Quat q{r.w, r.x, r.y, r.z};
    return {{p.x, p.y, p.z}, norm(q) > 0 ? normalized(q) : Quat{}};
}

Json list(const Vec3& v) { return Json::array({float(v.x), float(v.y), float(v.z)}); }
Json list(const Quat& q) { return Json::array({float(q.x), float(q.y), float(q.z), float(q.w)}); }

void put_pose(Json& node, const Pose& X)
{
    if (!(X.p == Vec3{})) node["translation"] = list(X.p);
    if (!(X.q == Quat{})) node["rotation"] = list(X.q);
}

class Film
{
public:
    Film(const Log& log, const GltfOptions& options) : log_(log), options_(options) {}

    Result<Exported> make()
    {
        if (auto found = find_run(); !found) return found.errors();
        read_catalogue();
        if (auto read = read_frames(); !read) return read.errors();
        if (log_.is_interrupted()) return reason("interrupted");
        write_nodes();
        if (auto written = file_.write(options_.out); !written) return written.errors();
        out_.files = {options_.out};
        if (tracks_->too_fast() > 0)
            out_.troubles.add("shafts turn by more than half a turn between key frames, and look slower: take a smaller --every");
        return std::move(out_);
    }

private:
    Result<void> find_run()
    {
        Stream stream = log_.stream({frames()}, options_.span);
        while (const Entry* entry = stream.next())
            if (const auto* frame = entry->as<plab_v2_Frame>()) return run_ = frame->run, Result<void>();
        return reason(log_.path() + " has no states" + (options_.span.from || options_.span.to ? " between --from and --to" : ""));
    }

    static std::string frames() { return wire::topic_of<plab_v2_Frame>().name; }

    void read_catalogue()
    {
        Stream stream = log_.stream({wire::topic_of<plab_v2_SceneObject>().name, wire::topic_of<plab_v2_Shape>().name});
        std::map<std::uint32_t, Pose> axles;
        while (const Entry* entry = stream.next())
        {
            if (const auto* shape = entry->as<plab_v2_Shape>())
                shapes_[shape->component_id] = {pose_of(shape->position, shape->orientation), surface_of(*shape)};
            const auto* object = entry->as<plab_v2_SceneObject>();
            if (object == nullptr || object->run != run_) continue;
            GltfObject made{object->component_id,
                            object->handle,
                            std::string_view(object->motion) == "static",
                            pose_of(object->position, object->orientation),
                            {object->color.x, object->color.y, object->color.z},
                            {}};
            for (std::uint32_t i = 0; i < object->shapes._length; ++i) made.shapes.emplace_back(object->shapes._buffer[i]);
            if (std::string_view(object->shape_of) == "shaft") axles[object->handle] = made.pose;
            objects_[object->handle] = std::move(made);
        }
        out_.troubles.merge(stream.troubles());
        tracks_.emplace(std::move(axles));
    }

    Result<void> read_frames()
    {
        Merged merged;
        std::optional<double> first, last;
        Stream stream = log_.stream({frames()}, options_.span);
        while (const Entry* entry = stream.next())
        {
            const auto* frame = entry->as<plab_v2_Frame>();
            if (frame == nullptr) continue;
            if (frame->run != run_) break;
            merged.note(*frame);
            if (last && !(frame->time - *last > options_.every * (1 - 1e-9))) continue;
            if (!first) first = frame->time;
            last = frame->time;
            if (!tracks_->add(merged, static_cast<float>(frame->time - *first)))
                return reason("more than 1 GiB of key frames: take a larger --every, or a part by --from and --to");
            ++out_.messages[frames()];
        }
        out_.troubles.merge(stream.troubles());
        return {};
    }

    std::size_t material_of(const Vec3& color)
    {
        const Vec3 shown = color.x < 0 ? Vec3{0.7, 0.7, 0.72} : color;
        const std::array key{float(shown.x), float(shown.y), float(shown.z)};
        const auto [found, fresh] = materials_.try_emplace(key, materials_.size());
        if (fresh)
            file_.json()["materials"].push_back(
                {{"pbrMetallicRoughness",
                  {{"baseColorFactor", {key[0], key[1], key[2], 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.7}}}});
        return found->second;
    }

    void write_nodes()
    {
        file_.json()["asset"] = {{"version", "2.0"}, {"generator", "plabctl export"}};
        file_.json()["scene"] = 0;
        file_.json()["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
        nodes_.push_back({{"name", "scene"}, {"rotation", Json::array({-std::sqrt(0.5f), 0, 0, std::sqrt(0.5f)})}});
        for (const auto& [handle, object] : objects_) write_object(object);
        if (!children_.empty()) nodes_[0]["children"] = children_;
        file_.json()["nodes"] = nodes_;
        if (!channels_.empty())
            file_.json()["animations"] = Json::array({{{"name", "run"}, {"channels", channels_}, {"samplers", samplers_}}});
    }

    void write_object(const GltfObject& object)
    {
        const auto found = tracks_->by_handle().find(object.handle);
        const Track* const track = found == tracks_->by_handle().end() ? nullptr : &found->second;
        if (track == nullptr && !object.is_static) return;  // not in this part of the run
        Json node{{"name", object.id}};
        if (track == nullptr)
            put_pose(node, object.pose);
        else
        {
            const float* const p = track->poses.data();
            put_pose(node, {{p[0], p[1], p[2]}, {p[6], p[3], p[4], p[5]}});
        }
        Json shapes = Json::array();
        for (const std::string& id : object.shapes)
        {
            const auto shape = shapes_.find(id);
            if (shape == shapes_.end() || shape->second.surface.triangles.empty()) continue;
            Json part{{"name", id}, {"mesh", file_.add_mesh(shape->second.surface, material_of(object.color))}};
            put_pose(part, shape->second.pose);
            shapes.push_back(nodes_.size()), nodes_.push_back(std::move(part));
        }
        if (!shapes.empty()) node["children"] = std::move(shapes);
        const std::size_t index = nodes_.size();
        children_.push_back(index), nodes_.push_back(std::move(node));
        if (track != nullptr) animate(index, *track);
    }

    /// The accessor of the times; made when something moves.
    std::size_t times(std::size_t count)
    {
        const auto [found, fresh] = times_.try_emplace(count, 0);
        if (fresh) found->second = file_.add_floats(std::span(tracks_->times()).first(count), 1, true);
        return found->second;
    }

    void add_channel(std::size_t node, const char* path, std::span<const float> values, int width, const char* interpolation)
    {
        const std::size_t input = times(values.size() / std::size_t(width));
        samplers_.push_back({{"input", input}, {"interpolation", interpolation}, {"output", file_.add_floats(values, width, false)}});
        channels_.push_back({{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    }

    void animate(std::size_t node, const Track& track)
    {
        const std::size_t all = tracks_->times().size();
        if (track.moves())
        {
            std::vector<float> places, turns;
            for (std::size_t i = 0; i < track.poses.size(); ++i) (i % 7 < 3 ? places : turns).push_back(track.poses[i]);
            add_channel(node, "translation", places, 3, "LINEAR"), add_channel(node, "rotation", turns, 4, "LINEAR");
        }
        if (track.is_always_there() && track.frames() == all) return;
        std::vector<float> sizes;
        for (std::size_t k = 0; k < all; ++k) sizes.insert(sizes.end(), 3, k < track.frames() ? track.there[k] : 0);
        add_channel(node, "scale", sizes, 3, "STEP");
    }

    const Log& log_;
    const GltfOptions& options_;
    Exported out_;
    std::uint64_t run_ = 0;
    std::map<std::string, GltfShape> shapes_;
    std::map<std::uint32_t, GltfObject> objects_;
    std::optional<Tracks> tracks_;
    GltfFile file_;
    Json nodes_ = Json::array(), children_ = Json::array(), channels_ = Json::array(), samplers_ = Json::array();
    std::map<std::array<float, 3>, std::size_t> materials_;
    std::map<std::size_t, std::size_t> times_;
};

}  // namespace

Result<Exported> export_gltf(const Log& log, const GltfOptions& options) { return Film(log, options).make(); }

}  // namespace plab::analysis
