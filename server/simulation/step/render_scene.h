/// The visible parts of a world, for components that draw (Phase::Draw).
#pragma once

#include <vector>

#include "plab/picture.h"
#include "world/world.h"

namespace plab::simulation
{

/// Collects the visible shapes (those with the command Shape/Draw), with the present poses of their bodies and shafts.
class RenderSceneBuilder
{
public:
    /// Names, colours and geometry are looked up again before the next picture.
    void structure_changed() { known_ = false, ++revision_; }
    /// The present view of the world; valid until the next call.
    RenderScene view_of(const world::World& world);

private:
    struct Thing
    {
        Facet facet = Facet::Body;
        std::uint32_t index = kNoIndex;
        Visual visual;
        Pose in_object;  ///< X_BS, or in the frame of a shaft
    };
    void learn(const world::World& world);
    void learn_shaft(const world::World& world, const world::Component& component, const Vec3& color);
    void add_shapes(const world::World& world, const world::Component& component, const RefList& shapes, const Vec3& color);

    bool known_ = false;
    std::uint64_t revision_ = 0;
    std::vector<Thing> things_;
    std::vector<Visual> visuals_;
    std::vector<NamedView> views_;
    std::vector<std::string> algorithms_;
};

/// Pose of a shaft's own frame in W: its axle frame rotated by its angle.
Pose pose_of_shaft(const Shafts& shafts, std::uint32_t shaft);

}  // namespace plab::simulation
