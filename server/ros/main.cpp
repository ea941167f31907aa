// plab-bus-ros: plab-bus with a node of ROS 2 in the same process. plabd starts it in place of plab-bus if it is told --ros.
#include <algorithm>

#include "bus/process/program.h"
#include "import/import.h"
#include "ros/bridge.h"

namespace
{

using namespace plab;

Result<ros::ConvertedScene> convert(const ros::ForeignScene& scene)
{
    import::ImportOptions options;
    if (!scene.name.empty()) options.part = import::Part{scene.name, scene.place};
    const auto format = scene.format == "urdf" ? import::SceneFormat::Urdf : import::SceneFormat::Mjcf;
    auto imported = import::import_text(scene.text, scene.file.empty() ? scene.format : scene.file, format, options);
    if (!imported) return imported.errors();
    return ros::ConvertedScene{std::move(imported->blueprint), std::move(imported->root), std::move(imported->losses)};
}

class RosNode : public bus::Companion
{
public:
    explicit RosNode(std::unique_ptr<ros::Bridge> bridge) : bridge_(std::move(bridge)) {}

private:
    std::unique_ptr<ros::Bridge> bridge_;
};

Result<std::unique_ptr<bus::Companion>> make_node(const bus::StartMessage& start)
{
    ros::BridgeOptions options;
    options.link.server = start.name;
    options.link.domain = {start.domain, start.network_interface};
    options.space = start.ros_space, options.rate = start.ros_rate, options.converter = &convert;
    auto bridge = ros::Bridge::open(options);
    if (!bridge) return bridge.errors();
    return std::unique_ptr<bus::Companion>(std::make_unique<RosNode>(bridge.take()));
}

}  // namespace

int main(int argc, char** argv)
{
    return bus::run_program(argc, argv, "plab-bus-ros", "carries the topics of one server between it and DDS, and is a node of ROS 2",
                            &make_node);
}
