/// What the step thread hands to the writer of a recording.
#pragma once

#include <cstdint>
#include <memory>
#include <variant>

#include "publish/records.h"

namespace plab::record
{

/// A server's status, with what the recorder adds about itself.
struct Entry
{
    using Body = std::variant<std::unique_ptr<wire::Frame>, wire::Collisions, wire::Events, wire::Metrics, wire::Image, wire::Journal,
                              wire::Hashes, wire::Snapshot, publish::CatalogueChange, wire::Server, wire::ContactForces>;
    std::uint64_t run = 0;
    double time = 0;            ///< s, simulated, in that run
    std::int64_t stamp_ns = 0;  ///< since 1970
    Body body;
};

}  // namespace plab::record
