/// What leaves a running scene: the values of the wire (idl/values/values.h), which the step thread fills and other threads send or write,
/// and the messages that they travel in. idl/plab.idl documents units and meanings.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "idl/values/values.h"

namespace plab::publish
{

/// What changed in the catalogue.
struct CatalogueChange
{
    bool everything = false;  ///< components that are not listed here no longer exist
    wire::Scene scene;
    std::vector<wire::SceneObject> objects;
    std::vector<wire::Shape> shapes;
    std::vector<wire::Interaction> interactions;
    std::vector<wire::Type> types;  ///< empty: unchanged
    std::vector<std::string> gone;  ///< ids of components of any kind
};
PLAB_MEMBERS(CatalogueChange, everything, scene, objects, shapes, interactions, types, gone)

/// A request as received; server/control converts it to operations.
struct ReceivedRequest : wire::Request
{
    std::int64_t arrived_ns = 0;  ///< monotonic time
};

/// The newest sample of a client for one component.
template <class Sample>
struct ReceivedSample
{
    Sample sample;
    bool gone = false;            ///< the client is gone; of `sample` only client and component count
    std::uint64_t skipped = 0;    ///< samples since the last one that was taken, which a newer one replaced
    std::int64_t arrived_ns = 0;  ///< monotonic time
};
/// What clients have sent about people since it was taken last.
struct ReceivedPeople
{
    std::vector<ReceivedSample<wire::UserSample>> users;
    std::vector<ReceivedSample<wire::ViewerSample>> viewers;
};

}  // namespace plab::publish
