/// Converts a server's scene and a state to geometry to draw.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "link/appearance.h"
#include "link/catalogue.h"
#include "render/render.h"
#include "viewer/captions.h"
#include "viewer/state.h"

namespace plab::view
{

class SceneModel
{
public:
    struct Overlays
    {
        bool captions = true, ground = true;
    };

    explicit SceneModel(const Overlays& overlays) : overlays_(overlays) {}

    /// Use this scene from now on. Cheap if it is already in use.
    void use(std::shared_ptr<const link::CatalogueContents> scene);

    /// Everything visible in this state; valid until the next call. The caller chooses the view.
    render::Drawing& draw(const State& state);

    const std::vector<link::Camera>& cameras() const;
    bool has_object(const std::string& id) const;
    /// Origin of an object (W, m); empty if it has no place in this state.
    std::optional<Vec3> position_of(const std::string& id, const State& state) const;

private:
    struct Part
    {
        render::Form form = render::Form::Sphere;
        Pose X_BS;
        Vec3 size, color;
        std::uint32_t mesh = 0;
    };
    /// An object, ready to be drawn.
    struct Prop
    {
        std::string id;
        std::uint32_t handle = 0;
        std::uint64_t run = 0;
        bool is_shaft = false, is_static = false;
        Pose X_WB;  ///< where it is, or of a shaft its axle at angle 0
        std::vector<Part> parts;
    };

    void rebuild_meshes();
    void add_prop(const link::Object& object);
    void add_parts(const link::Object& object, const Vec3& color, std::vector<Part>& out) const;
    std::optional<Pose> pose_of(const Prop& prop, const State& state) const;

    Overlays overlays_;
    std::shared_ptr<const link::CatalogueContents> scene_;
    std::vector<Prop> props_;
    std::vector<std::string> mesh_ids_;  ///< of shapes, as in drawing_.meshes
    Captions captions_;
    render::Drawing drawing_;
};

/// Poses from the catalogue, for a server that is paused and sends no states.
State state_of_catalogue(const link::CatalogueContents& scene, const link::ServerInfo& server);

}  // namespace plab::view
