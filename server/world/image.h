/// A world as a value: everything that it contains at one time, by component and field. Making an image copies bytes and pointers; shared
/// parts never change, so other threads may read them.
///
/// What Prepare derives from parameters is left out: geometry, materials, opaque cells. Mass properties are included although they are
/// derived, too: a build that computes different last digits then continues with the values that the run had.
#pragma once

#include <memory>
#include <vector>

#include "model/scene.h"
#include "world/layout.h"
#include "world/world.h"

namespace plab::world
{

struct Image
{
    std::shared_ptr<const Directory> directory;
    std::shared_ptr<const model::SceneSpec> scene;       ///< the components as they are now, after swaps
    std::vector<std::shared_ptr<const Layout>> layouts;  ///< by table
    std::vector<std::uint8_t> cells;                     ///< of existing components, in directory order, by layout
    Bodies bodies;                                       ///< by host row; without material and shapes
    Shafts shafts;                                       ///< without axle and shapes
    Quantities quantities;

    const Component& component(std::uint32_t i) const { return directory->components[i]; }
    /// Calls visit(directory index, component, its layout) for each existing component that is not a group, in the order of `cells`.
    template <class Visit>
    void for_each(Visit visit) const
    {
        for (std::uint32_t i = 0; i < directory->components.size(); ++i)
            if (const Component& c = component(i); c.alive && c.table != kNoIndex) visit(i, c, *layouts[c.table]);
    }
};

/// Maps the indices of an image to those of a world that was made from it.
class Renumbering
{
public:
    Renumbering(const Image& image, const World& world);
    /// kNoIndex if it does not exist there.
    std::uint32_t component(std::uint32_t old) const { return old < component_.size() ? component_[old] : kNoIndex; }
    std::uint32_t body(std::uint32_t old) const { return old < body_.size() ? body_[old] : kNoIndex; }
    std::uint32_t shaft(std::uint32_t old) const { return old < shaft_.size() ? shaft_[old] : kNoIndex; }
    /// Of a component, body or shaft.
    Ref ref(Ref old) const;

private:
    std::vector<std::uint32_t> component_, body_, shaft_;
};

}  // namespace plab::world
