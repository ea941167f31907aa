#include "ode_handles.h"

namespace plab::detection
{

bool start_ode()
{
    // Closed when the plugin is unloaded; by then all spaces are gone, together with the worlds that held them.
    struct Ode
    {
        bool started = dInitODE2(0) != 0;
        Ode() = default;
        Ode(const Ode&) = delete;
        Ode& operator=(const Ode&) = delete;
        ~Ode()
        {
            if (started) dCloseODE();
        }
    };
    static const Ode ode;
    return ode.started && dAllocateODEDataForThread(dAllocateFlagCollisionData) != 0;
}

}  // namespace plab::detection
