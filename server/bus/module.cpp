/// What bus.so exports: plabd's end of the bus.
#include <exception>

#include "bus/server_bus.h"

extern "C" __attribute__((visibility("default"))) std::unique_ptr<plab::bus::Bus> plab_bus_open(const plab::bus::BusOptions& options,
                                                                                                plab::Error& error)
{
    // No exception may cross the module's boundary.
    try
    {
        auto bus = plab::bus::ServerBus::open(options);
        if (bus) return bus.take();
        error = bus.error();
    }
    catch (const std::exception& e)
    {
        error = plab::reason(std::string("cannot open the bus: ") + e.what());
    }
    return nullptr;
}
static_assert(std::is_same_v<plab::bus::Open, decltype(&plab_bus_open)>);
