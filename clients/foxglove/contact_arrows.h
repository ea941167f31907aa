/// The forces of contacts as foxglove::SceneUpdate: one entity, "contacts", of arrows, which each message replaces.
#pragma once

#include <string>

#include "foxglove/scene.h"
#include "idl/values/values.h"

namespace plab::foxglove
{

class ContactArrows
{
public:
    /// To be called when the scene has changed. The force that is the mean weight of what moves has an arrow as long as the mean of its
    /// sizes.
    void use(const DrawnScene& scene);
    /// CDR. Of a pair the force on the body that moves is drawn, on the second one if both do; forces of impacts in another colour. `time`:
    /// ns.
    std::string update(const wire::ContactForces& contacts, const DrawnScene& scene, std::uint64_t time) const;

    /// m of an arrow for each N.
    double scale() const { return scale_; }

private:
    double scale_ = 0, longest_ = 0;  ///< m/N, m
};

}  // namespace plab::foxglove
