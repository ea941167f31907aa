/// The bus as the daemon sees it. The daemon loads build/lib/plab/bus.so only when the bus is needed; without it, no DDS
/// library is mapped.
#pragma once

#include <memory>
#include <string>

#include "publish/observer.h"

namespace plab::bus
{

/// Whether the server looks like a node of ROS 2 as well (server/docs/ros.md).
struct RosOptions
{
    bool enabled = false;
    std::string space;  ///< namespace: "", or with '/' in front
    double rate = 60;   ///< messages of a topic per second of real time, at most
};

struct BusOptions
{
    std::string name = "plab";      ///< name of the server: the partition of its topics
    std::string version;            ///< version of pLab
    std::uint32_t domain = 0;       ///< DDS domain
    std::string network_interface;  ///< empty: this host only
    RosOptions ros;
    /// Wakes the step loop when a request has arrived, or when a client starts to read a stream (a paused server may have to
    /// show its current state). Called on a thread of the bus; must not wait.
    void (*wake)(void*) = nullptr;
    void* wake_argument = nullptr;
    /// A client requests the shutdown of the server: this notifies the step thread at once, even during a long step.
    /// Called on a thread of the bus; the request itself arrives through take().
    void (*end)(void*) = nullptr;
    void* end_argument = nullptr;
    /// "" or the activity of a step or trial that takes long, for the server's own topic. Called on a thread of the bus. Null:
    /// no such report.
    std::string (*busy)(void*) = nullptr;
    void* busy_argument = nullptr;
    /// Logs one line about trouble on the bus, at most a few per second. Called on a thread of the bus. Null: standard error.
    void (*log)(void*, const char* line) = nullptr;
    void* log_argument = nullptr;
};

class Bus : public publish::Observer
{
public:
    /// The oldest request that has not been taken yet. Each request is handed out once, however often its client sent it.
    virtual bool take(publish::ReceivedRequest& request) = 0;
    /// The newest samples of users and viewers since the last call, in place of what `people` held. Never waits: samples that are just
    /// being written come with the next call.
    virtual void take_people(publish::ReceivedPeople& people) = 0;
    /// Sends an answer to the client that asked, and to no other client. Never dropped.
    virtual void answer(wire::Reply&& answer) = 0;
    /// Empty while all is well; otherwise the reason why this server must end (another server has its name).
    virtual std::string lost() const = 0;
    /// What happened to the process that talks to the clients, if it ended and was replaced since the last call.
    virtual std::string take_restart() = 0;
    /// Process id of that process; 0: there is none at present.
    virtual int process() const = 0;
};

/// What bus.so exports under kEntryName. On failure (no such interface, the name is taken, ...) it returns nothing, and the
/// reason.
using Open = std::unique_ptr<Bus> (*)(const BusOptions& options, Error& error);
inline constexpr const char* kEntryName = "plab_bus_open";

}  // namespace plab::bus
