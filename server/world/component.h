/// The entry of a component in the directory of a world.
#pragma once

#include <cstdint>
#include <string>

#include "plab/ref.h"

namespace plab::world
{

/// A directory entry. The index belongs to the id as long as a component of that id exists, also across swaps.
struct Component
{
    std::string id;
    std::uint32_t table = kNoIndex;  ///< kNoIndex: a group
    Row row = kNoIndex;
    Facet facet = Facet::Component;
    std::uint32_t host_index = kNoIndex;
    std::uint64_t commands = 0;  ///< bit per command of its type: takes part in the step
    bool alive = false;
    bool quarantined = false;

    /// How roles refer to this component.
    Ref ref(std::uint32_t directory_index) const
    {
        return facet == Facet::Component ? Ref{facet, directory_index} : Ref{facet, host_index};
    }
};

}  // namespace plab::world
