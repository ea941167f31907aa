/// A world as a value: everything that it holds at one time, by component and field. Making one is a copy of bytes and
/// of pointers; what it shares never changes, so that other threads may read it.
///
/// Left out is what Prepare makes from parameters: geometry, materials, opaque cells. Mass properties are in it, though they
/// follow too: a build that computes another last digit goes on with those that the run had.
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
    std::shared_ptr<const model::SceneSpec> scene;       ///< the component set as it is, with swaps
    std::vector<std::shared_ptr<const Layout>> layouts;  ///< by table
    std::vector<std::uint8_t> cells;                     ///< of living components, in directory order, by layout
    Bodies bodies;                                       ///< by host row; without material and shapes
    Shafts shafts;                                       ///< without axle and shapes
    Quantities quantities;

    const Component& component(std::uint32_t i) const { return directory->components[i]; }
    /// Calls visit(directory index, component, its layout) for each living component that is no group, in the order of `cells`.
    template <class Visit>
    void for_each(Visit visit) const
    {
        for (std::uint32_t i = 0; i < directory->components.size(); ++i)
            if (const Component& c = component(i); c.alive && c.table != kNoIndex) visit(i, c, *layouts[c.table]);
    }
};

/// Where the components of an image are in a world that was made from it.
class Renumbering
{
public:
    Renumbering(const Image& image, const World& world);
    /// kNoIndex for who is not there.
    std::uint32_t component(std::uint32_t old) const { return old < component_.size() ? component_[old] : kNoIndex; }
    std::uint32_t body(std::uint32_t old) const { return old < body_.size() ? body_[old] : kNoIndex; }
    std::uint32_t shaft(std::uint32_t old) const { return old < shaft_.size() ? shaft_[old] : kNoIndex; }
    /// Of a component, body or shaft.
    Ref ref(Ref old) const;

private:
    std::vector<std::uint32_t> component_, body_, shaft_;
};

}  // namespace plab::world
