/// Owners of ODE's handles: the only way in which this plugin holds them.
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

/// Starts the library once per process and gives the calling thread what it needs there. ODE is never closed: worlds
/// in other threads may still use it, and it owns nothing but caches.
bool start_ode();

}  // namespace plab::detection
