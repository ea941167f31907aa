/// What services say of entities: the bodies and shafts of a scene.
#pragma once

#include <regex.h>

#include <memory>
#include <optional>

#include "ros/messages.h"
#include "ros/outcome.h"
#include "ros/scene_frames.h"

namespace plab::ros
{

/// Pose and velocity (of the origin of its frame) in the world.
struct Motion
{
    Pose pose;
    Vec3 v, w;
};

/// Of all entities at the moment of a frame. Must not outlive the frame.
class Motions
{
public:
    /// `frame` may be null: then everything is where the catalogue has it.
    explicit Motions(const plab_v2_Frame* frame);
    Motion of(const SceneFrame& entity) const;

private:
    std::unordered_map<std::uint32_t, const plab_v2_BodyState*> bodies_;
    std::unordered_map<std::uint32_t, const plab_v2_ShaftState*> shafts_;
};

/// An axis-parallel box.
struct Box
{
    Vec3 low, high;
};
/// Around all shapes of an object, in its own frame; none if it has no shape, or one without end.
std::optional<Box> box_of(const link::Object& object, const link::CatalogueContents& scene);
/// Around that box where it is.
Box moved(const Box& box, const Pose& pose);

/// simulation_interfaces/msg/EntityCategory
std::uint8_t category_of(const link::Object& object);
std::vector<std::string> tags_of(const link::Object& object);

msg::EntityState state_message(const Motion& motion, const msg::Time& stamp);

/// A filter of GetEntities, checked.
class EntityFilter
{
public:
    /// Reads the filter; otherwise says why it cannot.
    Outcome read(const msg::EntityFilters& filters);
    /// Whether it depends on where entities are.
    bool needs_places() const { return box_ || ball_; }
    bool fits(const std::string& name, const link::Object& object, const link::CatalogueContents& scene, const Pose& pose) const;

private:
    struct RegexDeleter
    {
        void operator()(regex_t* pattern) const { regfree(pattern), delete pattern; }
    };
    bool fits_bounds(const link::Object& object, const link::CatalogueContents& scene, const Pose& pose) const;

    std::unique_ptr<regex_t, RegexDeleter> pattern_;
    std::vector<std::uint8_t> categories_;
    std::vector<std::string> tags_;
    bool needs_all_tags_ = false;
    std::optional<Box> box_;
    std::optional<std::pair<Vec3, double>> ball_;
};

}  // namespace plab::ros
