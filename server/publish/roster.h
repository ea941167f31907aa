/// The components of the scene: handles of objects, and since when each component has its current type.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "plab/context.h"
#include "world/world.h"

namespace plab::publish
{

class Roster
{
public:
    enum class Kind : std::uint8_t
    {
        Object,
        Shape,
        Interaction,
    };
    struct Member
    {
        std::uint32_t index = kNoIndex;  ///< in the world's directory
        Kind kind = Kind::Object;
        const model::ComponentType* type = nullptr;
        Tick since = 0;
        std::uint32_t handle = 0;  ///< objects only; starts at 1, never reused within a run
    };
    struct Differences
    {
        std::vector<std::string> came, retyped, gone;
        bool other_kind = false;  ///< the id now denotes a component of another kind
    };
    /// An object by its row in the host's table.
    struct ObjectRow
    {
        std::uint32_t handle = 0, row = 0;
    };

    /// A new run: no component is known, handles restart.
    void restart();
    /// Call when the structure may have changed; `boundary` is the step at which it did.
    Differences update(const world::World& world, Tick boundary);

    /// Null if there is no such component, or if it is a group.
    const Member* find(const std::string& id) const;
    const std::map<std::string, Member>& members() const { return members_; }
    /// In order of their ids, static objects included.
    const std::vector<ObjectRow>& bodies() const { return bodies_; }
    const std::vector<ObjectRow>& shafts() const { return shafts_; }
    std::size_t count(Kind kind) const { return counts_[static_cast<std::size_t>(kind)]; }

private:
    void welcome(const world::Component& component, Member& member, Tick boundary);

    std::map<std::string, Member> members_;
    std::vector<ObjectRow> bodies_, shafts_;
    std::size_t counts_[3] = {};
    std::uint32_t next_handle_ = 1;
};

}  // namespace plab::publish
