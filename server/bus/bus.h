/// The bus as the daemon sees it. The daemon loads build/lib/plab/bus.so when it is wanted; without it no DDS is mapped.
#pragma once

#include <memory>
#include <string>

#include "publish/observer.h"

namespace plab::bus
{

struct BusOptions
{
    std::string name = "plab";      ///< of the server: the partition of its topics
    std::string version;            ///< of pLab
    std::uint32_t domain = 0;       ///< DDS domain
    std::string network_interface;  ///< empty: this host only
    /// Wakes the step loop when a request has arrived, or when somebody begins to watch a stream (a paused server may
    /// want to show where it stands). Called on a thread of the bus; must not wait.
    void (*wake)(void*) = nullptr;
    void* wake_argument = nullptr;
    /// A client asks for the end of the server: the step thread, which may be at a step that takes long, learns it at once. Called on
    /// a thread of the bus; the request itself comes by take().
    void (*end)(void*) = nullptr;
    void* end_argument = nullptr;
    /// "" or what a step or trial that takes long is at, for the server's own topic. Asked on a thread of the bus. Null: nobody tells.
    std::string (*busy)(void*) = nullptr;
    void* busy_argument = nullptr;
    /// A line for the server's log about trouble on the bus, at most a few in a second. Called on a thread of the bus.
    /// Null: standard error.
    void (*log)(void*, const char* line) = nullptr;
    void* log_argument = nullptr;
};

class Bus : public publish::Observer
{
public:
    /// The oldest request that nobody has taken yet. Each request is handed out once, however often its client sent it.
    virtual bool take(publish::RequestText& request) = 0;
    /// To the client that asked, and to nobody else. Never dropped.
    virtual void answer(publish::Answer&& answer) = 0;
    /// Empty while all is well; else why this server must end (another one has its name).
    virtual std::string lost() const = 0;
    /// What became of the process that speaks with clients, if it ended and another one took its place since the last call.
    virtual std::string take_restart() = 0;
    /// That process; 0: there is none at present.
    virtual int process() const = 0;
};

/// What bus.so exports under kEntryName. On failure (no such interface, the name is taken, ...) nothing, and the reason.
using Open = std::unique_ptr<Bus> (*)(const BusOptions& options, Error& error);
inline constexpr const char* kEntryName = "plab_bus_open";

}  // namespace plab::bus
