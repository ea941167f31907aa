/// A server as a node of ROS 2: reads what the server publishes, and publishes that under the names and types of ROS; answers the services
/// of simulation_interfaces by requests to the server.
#pragma once

#include <atomic>
#include <thread>

#include "link/session.h"
#include "ros/resource.h"

namespace plab::ros
{

struct BridgeOptions
{
    link::SessionOptions link;  ///< with the server's name
    std::string space;          ///< namespace of topics, services and node: "", or with '/' in front
    double rate = 60;           ///< messages of a topic per second of real time, at most
    Converter converter;        ///< may be empty: then blueprints are the only scenes
};

/// Runs on a thread of its own from open() to its end. Waits for the server, also for the next one of that name.
class Bridge
{
public:
    static Result<std::unique_ptr<Bridge>> open(const BridgeOptions& options);
    ~Bridge();
    Bridge(const Bridge&) = delete;
    Bridge& operator=(const Bridge&) = delete;

private:
    struct Parts;

    Bridge();
    void run();

    BridgeOptions options_;
    std::unique_ptr<Parts> parts_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace plab::ros
