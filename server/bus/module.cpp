/// What bus.so exports: the end of the bus that is in plabd.
#include <exception>

#include "bus/server_bus.h"

extern "C" __attribute__((visibility("default"))) std::unique_ptr<plab::bus::Bus> plab_bus_open(const plab::bus::BusOptions& options,
                                                                                                plab::Error& error)
{
    // Nothing is thrown across the module's border.
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
