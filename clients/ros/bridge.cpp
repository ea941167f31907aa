#include "ros/bridge.h"

#include <cstdio>
#include <exception>

#include "idl/values/ros_names.h"
#include "ros/connection.h"

namespace plab::ros
{

struct Bridge::Parts
{
    Node node;  ///< before all that is made of it
    Publishers publishers;
    std::unique_ptr<ServiceDesk> desk;
};

Bridge::Bridge() = default;

Result<std::unique_ptr<Bridge>> Bridge::open(const BridgeOptions& options)
{
    std::unique_ptr<Bridge> out(new Bridge);
    out->options_ = options;
    auto node = Node::join({options.link.domain, options.space, wire::ros::token_of(options.link.server)});
    if (!node) return node.errors();
    out->parts_ = std::make_unique<Parts>();
    out->parts_->node = node.take();
    auto publishers = Publishers::make(out->parts_->node);
    if (!publishers) return publishers.errors();
    out->parts_->publishers = publishers.take();
    auto desk = ServiceDesk::open(out->parts_->node, options.converter);
    if (!desk) return desk.errors();
    out->parts_->desk = desk.take();
    if (auto announced = out->parts_->node.announce(); !announced) return announced.errors();
    out->thread_ = std::thread([self = out.get()] { self->run(); });
    return out;
}

Bridge::~Bridge()
{
    stop_ = true;
    if (thread_.joinable()) thread_.join();
}

void Bridge::run()
{
    const link::Stop stop = [this] { return stop_.load(); };
    const auto say = [](const std::string& why) { std::fprintf(stderr, "plab-bus: ROS: %s\n", why.c_str()); };
    while (!stop_)
    {
        try
        {
            auto session = link::Session::join(options_.link);
            if (!session) return say(session.error().text());
            constexpr link::Seconds kLook(1);
            if (!session->find_server(options_.link, kLook, stop)) continue;
            auto connection = Connection::open(*session, parts_->publishers, *parts_->desk, options_.rate, stop);
            if (!connection)
            {
                if (!stop_) say(connection.error().text());
                continue;
            }
            while (!stop_ && !(*connection)->is_over()) (*connection)->step();
        }
        catch (const std::exception& e)
        {
            // Memory: what was too large is left out, and it begins anew.
            say(e.what());
        }
    }
}

}  // namespace plab::ros
