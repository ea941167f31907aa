/// What ROS 2 puts on DDS: names, types and QoS of its topics and services, for whoever has to look like a ROS node.
///
/// Names and type names are those that all of ROS's own implementations use on DDS: a topic `clock` is `rt/clock`, a service `s` has the
/// topics `rq/sRequest` and `rr/sReply`, and the type of a message has the modules of its package, of msg or srv and dds_, and a '_' behind
/// it. Type hashes (REP-2016, ROS 2 Iron and later) travel in the USER_DATA of each endpoint; tests/ros computes them from the definitions
/// of the messages.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "idl/ros/rmw_dds_common.h"
#include "idl/ros/ros_gz_interfaces.h"
#include "idl/ros/rosgraph_msgs.h"
#include "idl/ros/sensor_msgs.h"
#include "idl/ros/simulation_interfaces.h"
#include "idl/ros/tf2_msgs.h"
#include "idl/ros/visualization_msgs.h"
#include "idl/topics.h"

namespace plab::wire::ros
{

using Clock = rosgraph_msgs_msg_dds__Clock_;
using Transforms = tf2_msgs_msg_dds__TFMessage_;
using Transform = geometry_msgs_msg_dds__TransformStamped_;
using JointState = sensor_msgs_msg_dds__JointState_;
using MarkerArray = visualization_msgs_msg_dds__MarkerArray_;
using Marker = visualization_msgs_msg_dds__Marker_;
using Contacts = ros_gz_interfaces_msg_dds__Contacts_;
using Contact = ros_gz_interfaces_msg_dds__Contact_;
using ParticipantEntities = rmw_dds_common_msg_dds__ParticipantEntitiesInfo_;
using Header = std_msgs_msg_dds__Header_;
using Time = builtin_interfaces_msg_dds__Time_;
using RosVector = geometry_msgs_msg_dds__Vector3_;
using RosPose = geometry_msgs_msg_dds__Pose_;
using EntityState = simulation_interfaces_msg_dds__EntityState_;
using EntityFilters = simulation_interfaces_msg_dds__EntityFilters_;
using ServiceResult = simulation_interfaces_msg_dds__Result_;
using SpawnResult = simulation_interfaces_msg_dds__SpawnResult_;
using Spawn = simulation_interfaces_msg_dds__SpawnEntity_;

/// QoS as ROS words it: reliable or best effort, volatile or transient local, keep last `depth`.
struct Profile
{
    bool is_reliable = true, is_transient_local = false;
    std::int32_t depth = 10;
};

struct MessageTopic
{
    const char* name;  ///< without prefix and namespace
    const dds_topic_descriptor_t* type;
    Profile profile;
    const char* type_hash;
};

/// The topic on which a message of this type is published; a type is published on one topic, but for transforms.
std::span<const MessageTopic> topics();
extern const MessageTopic kClock, kTransforms, kStaticTransforms, kJointStates, kMarkers, kContacts, kGraph;

/// A service of simulation_interfaces with its C types.
template <class RequestType, class ResponseType>
struct Service
{
    using Request = RequestType;
    using Response = ResponseType;
};
using GetSimulatorFeatures =
    Service<simulation_interfaces_srv_dds__GetSimulatorFeatures_Request_, simulation_interfaces_srv_dds__GetSimulatorFeatures_Response_>;
using GetSimulationState =
    Service<simulation_interfaces_srv_dds__GetSimulationState_Request_, simulation_interfaces_srv_dds__GetSimulationState_Response_>;
using SetSimulationState =
    Service<simulation_interfaces_srv_dds__SetSimulationState_Request_, simulation_interfaces_srv_dds__SetSimulationState_Response_>;
using StepSimulation =
    Service<simulation_interfaces_srv_dds__StepSimulation_Request_, simulation_interfaces_srv_dds__StepSimulation_Response_>;
using ResetSimulation =
    Service<simulation_interfaces_srv_dds__ResetSimulation_Request_, simulation_interfaces_srv_dds__ResetSimulation_Response_>;
using GetEntities = Service<simulation_interfaces_srv_dds__GetEntities_Request_, simulation_interfaces_srv_dds__GetEntities_Response_>;
using GetEntitiesStates =
    Service<simulation_interfaces_srv_dds__GetEntitiesStates_Request_, simulation_interfaces_srv_dds__GetEntitiesStates_Response_>;
using GetEntityState =
    Service<simulation_interfaces_srv_dds__GetEntityState_Request_, simulation_interfaces_srv_dds__GetEntityState_Response_>;
using SetEntityState =
    Service<simulation_interfaces_srv_dds__SetEntityState_Request_, simulation_interfaces_srv_dds__SetEntityState_Response_>;
using GetEntityInfo =
    Service<simulation_interfaces_srv_dds__GetEntityInfo_Request_, simulation_interfaces_srv_dds__GetEntityInfo_Response_>;
using GetEntityBounds =
    Service<simulation_interfaces_srv_dds__GetEntityBounds_Request_, simulation_interfaces_srv_dds__GetEntityBounds_Response_>;
using SpawnEntity = Service<simulation_interfaces_srv_dds__SpawnEntity_Request_, simulation_interfaces_srv_dds__SpawnEntity_Response_>;
using SpawnEntities =
    Service<simulation_interfaces_srv_dds__SpawnEntities_Request_, simulation_interfaces_srv_dds__SpawnEntities_Response_>;
using DeleteEntity = Service<simulation_interfaces_srv_dds__DeleteEntity_Request_, simulation_interfaces_srv_dds__DeleteEntity_Response_>;
using LoadWorld = Service<simulation_interfaces_srv_dds__LoadWorld_Request_, simulation_interfaces_srv_dds__LoadWorld_Response_>;
using GetCurrentWorld =
    Service<simulation_interfaces_srv_dds__GetCurrentWorld_Request_, simulation_interfaces_srv_dds__GetCurrentWorld_Response_>;

struct ServiceInfo
{
    const char* name;  ///< without namespace
    const dds_topic_descriptor_t* request;
    const dds_topic_descriptor_t* response;
    const char *request_hash, *response_hash;
};
template <class OneService>
const ServiceInfo& service_of();
std::span<const ServiceInfo> services();

/// "rt/clock", "rt/space/clock". `space`: "", or with '/' in front.
std::string topic_name(const std::string& space, const std::string& name);
/// "rq/space/node/get_entitiesRequest" and "rr/space/node/get_entitiesReply".
std::string request_name(const std::string& space, const std::string& node, const std::string& service);
std::string reply_name(const std::string& space, const std::string& node, const std::string& service);

/// QoS of an endpoint. `extra`: further "key=value;" of its USER_DATA, before the type hash.
Qos qos_of(const Profile& profile, const std::string& type_hash, const std::string& extra = {});
/// Of the ends of a service, as ROS has them: reliable, volatile, keep last `depth`.
inline constexpr Profile kServiceProfile{true, false, 10};

}  // namespace plab::wire::ros
