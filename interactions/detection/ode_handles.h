/// Owning handles of ODE objects: this plugin holds ODE objects in no other way.
#pragma once

#include <ode/ode.h>

#include <memory>

namespace plab::detection
{

struct GeomDestroyer
{
    void operator()(dxGeom* geom) const { dGeomDestroy(geom); }
};
struct SpaceDestroyer
{
    void operator()(dxSpace* space) const { dSpaceDestroy(space); }
};
using GeomHandle = std::unique_ptr<dxGeom, GeomDestroyer>;
using SpaceHandle = std::unique_ptr<dxSpace, SpaceDestroyer>;

/// Initialises ODE once per process, and its data for the calling thread. Worlds in other threads may use it for as long as the
/// plugin is loaded.
bool start_ode();

}  // namespace plab::detection
