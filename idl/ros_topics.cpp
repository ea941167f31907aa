#include "idl/ros_topics.h"

#include <array>

namespace plab::wire::ros
{

constexpr Profile kNewest{false, false, 1}, kReliable{true, false, 100}, kLatched{true, true, 1}, kSensor{true, false, 10};

const MessageTopic kClock{"clock", &rosgraph_msgs_msg_dds__Clock__desc, kNewest,
                          "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564"};
const MessageTopic kTransforms{"tf", &tf2_msgs_msg_dds__TFMessage__desc, kReliable,
                               "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"};
const MessageTopic kStaticTransforms{"tf_static", &tf2_msgs_msg_dds__TFMessage__desc, kLatched, kTransforms.type_hash};
const MessageTopic kJointStates{"joint_states", &sensor_msgs_msg_dds__JointState__desc, kSensor,
                                "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"};
const MessageTopic kMarkers{"visualization_marker_array", &visualization_msgs_msg_dds__MarkerArray__desc, kLatched,
                            "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf"};
const MessageTopic kContacts{"contacts", &ros_gz_interfaces_msg_dds__Contacts__desc, kReliable,
                             "RIHS01_2cf36dd51e105580839fb7d6c028846a6342a8dfd62fde733d05f3e0c9ec4b5b"};
const MessageTopic kGraph{"ros_discovery_info", &rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc, kLatched,
                          "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"};

namespace
{

const std::array<MessageTopic, 6> kTopics{kClock, kTransforms, kStaticTransforms, kJointStates, kMarkers, kContacts};

const std::array<ServiceInfo, 16> kServices{{
    {"get_simulator_features", &simulation_interfaces_srv_dds__GetSimulatorFeatures_Request__desc,
     &simulation_interfaces_srv_dds__GetSimulatorFeatures_Response__desc,
     "RIHS01_982b8c1adef1d556f6ecdc019d1269fc39413626a9222d73b4fc874bd798b7db",
     "RIHS01_ede4dc8227cbb2f86a24612c999dcaa67d17dab21dab566cefdc233e7a2a65d1"},
    {"get_simulation_state", &simulation_interfaces_srv_dds__GetSimulationState_Request__desc,
     &simulation_interfaces_srv_dds__GetSimulationState_Response__desc,
     "RIHS01_c6d65bc5c0a95ca2886bc57f146f803e01722c84ddb5acd5f32a4417f55eecfb",
     "RIHS01_dc80ce852a5ab04c2b23cdd47910cee1bcc46e0f1931cac85825e6916b15517f"},
    {"set_simulation_state", &simulation_interfaces_srv_dds__SetSimulationState_Request__desc,
     &simulation_interfaces_srv_dds__SetSimulationState_Response__desc,
     "RIHS01_73283477d36ba619db2ac37a3e599077ca244502c9d8ca2a7183afcb2224f476",
     "RIHS01_6351aebf2bbf06e2993977918b944240f7403b532a9e4a344c53e71a56afd174"},
    {"step_simulation", &simulation_interfaces_srv_dds__StepSimulation_Request__desc,
     &simulation_interfaces_srv_dds__StepSimulation_Response__desc,
     "RIHS01_cda33f6887815f3dce0f90e61fd8efd39bda13ae264ddede15c33fbad890630e",
     "RIHS01_5b4acf2d0ce7c3fc125d0bef2acb9b5a81377e80db6b696b81beeffb9824fb5c"},
    {"reset_simulation", &simulation_interfaces_srv_dds__ResetSimulation_Request__desc,
     &simulation_interfaces_srv_dds__ResetSimulation_Response__desc,
     "RIHS01_2c766d09c3aa30f01fadc55a42fd760b63db358c7d1d3b6a64ea9978225ffbc7",
     "RIHS01_718428121e0f1755720878d3c28f1688da7581ee5a5d56d26d10d941a28a50a0"},
    {"get_entities", &simulation_interfaces_srv_dds__GetEntities_Request__desc, &simulation_interfaces_srv_dds__GetEntities_Response__desc,
     "RIHS01_f0a4c6c0c39c87f84cbd1ea31956b9f39b3fa538ae9c4aa7fc243a32360e8c70",
     "RIHS01_dd1916edbdc659d355e77980b16ed6eb4d41d5ff445557931ed65c58b00f7b2c"},
    {"get_entities_states", &simulation_interfaces_srv_dds__GetEntitiesStates_Request__desc,
     &simulation_interfaces_srv_dds__GetEntitiesStates_Response__desc,
     "RIHS01_0af5302d3526834e83bd9861fbcc5214af2b9a4b0c93a965840fb1a6c2891724",
     "RIHS01_b651848f4d93a2b0ec5ec3f36659297ca30547c499f933eb279b60f8be434315"},
    {"get_entity_state", &simulation_interfaces_srv_dds__GetEntityState_Request__desc,
     &simulation_interfaces_srv_dds__GetEntityState_Response__desc,
     "RIHS01_580141cc957c4ee99a7e46bc545db351ab9ce6c3099d4092b1186ddc6a38bd5a",
     "RIHS01_125f1ca9dc2fc072443deb28587bbb1026fa34db4dfaf59e9a6b7128e0c81331"},
    {"set_entity_state", &simulation_interfaces_srv_dds__SetEntityState_Request__desc,
     &simulation_interfaces_srv_dds__SetEntityState_Response__desc,
     "RIHS01_0ec3cca7e2bde7323c0c7ea4a5a7947f81edb90c144fc0aef5e2052e94e10061",
     "RIHS01_bbd9bcb2def000f1ed8cb9482abff46c5a11cfe4184203f336b920f249d757f4"},
    {"get_entity_info", &simulation_interfaces_srv_dds__GetEntityInfo_Request__desc,
     &simulation_interfaces_srv_dds__GetEntityInfo_Response__desc,
     "RIHS01_9bdd2628d931108734e304ae1fac80d268a46783fa0060d4a43831c54c30f3b3",
     "RIHS01_eaa358f007b09b06645f93b5a1c6ae0389f27bee7747e760122994ab1308e1c8"},
    {"get_entity_bounds", &simulation_interfaces_srv_dds__GetEntityBounds_Request__desc,
     &simulation_interfaces_srv_dds__GetEntityBounds_Response__desc,
     "RIHS01_41766afd481abfa03a9dface86a487e317da516333af3f5b017df248dd5d7fee",
     "RIHS01_728d414a3be6d7689fad9d3218c8378c68fbe08c2cfbf9878ac14de713fcf4c1"},
    {"spawn_entity", &simulation_interfaces_srv_dds__SpawnEntity_Request__desc, &simulation_interfaces_srv_dds__SpawnEntity_Response__desc,
     "RIHS01_9bc04fe30d4844466c57b7b090fd7e9aa426995f3eb6ff9a726826ab7223e1fd",
     "RIHS01_be8c9fc03b6faaf95570949c80195c8ca75dd99f7efc23262309d497b2923982"},
    {"spawn_entities", &simulation_interfaces_srv_dds__SpawnEntities_Request__desc,
     &simulation_interfaces_srv_dds__SpawnEntities_Response__desc,
     "RIHS01_03f070057ac2ab26d723fe9f07c7d57bd39ace34ad34bb043cdbca36825c98d9",
     "RIHS01_85df56d44250220df64762bf3e769cce45f84730eff8b9823093ca3041ecbbf5"},
    {"delete_entity", &simulation_interfaces_srv_dds__DeleteEntity_Request__desc,
     &simulation_interfaces_srv_dds__DeleteEntity_Response__desc, "RIHS01_4b41b2ebdc313a0c98c7c2218849edc8b7b905fd759a23b68c576496a47dc792",
     "RIHS01_2f68929b527a3bbee03637a1c8192f2aa2982807738389aa0781f8e785673ca7"},
    {"load_world", &simulation_interfaces_srv_dds__LoadWorld_Request__desc, &simulation_interfaces_srv_dds__LoadWorld_Response__desc,
     "RIHS01_cd389402a680703d3f9b45b1c3d6bb09c0578b4644654227f0b2e98a2f059f48",
     "RIHS01_7bab3265c2461d98a44dd04830c5dc997b3d8605c50861824066246c96a7716e"},
    {"get_current_world", &simulation_interfaces_srv_dds__GetCurrentWorld_Request__desc,
     &simulation_interfaces_srv_dds__GetCurrentWorld_Response__desc,
     "RIHS01_414ac6e1c5fd5f8be0b828ca7ff8cbee7166297809de31a36129f1d0913cd877",
     "RIHS01_039f99eb4e156ac597efed7598249921f8e47e5bff8c299d86ab081983a3a52a"},
}};

}  // namespace

std::span<const MessageTopic> topics() { return kTopics; }
std::span<const ServiceInfo> services() { return kServices; }

#define PLAB_ROS_SERVICE(Name, index)     \
    template <>                           \
    const ServiceInfo& service_of<Name>() \
    {                                     \
        return kServices[index];          \
    }
PLAB_ROS_SERVICE(GetSimulatorFeatures, 0)
PLAB_ROS_SERVICE(GetSimulationState, 1)
PLAB_ROS_SERVICE(SetSimulationState, 2)
PLAB_ROS_SERVICE(StepSimulation, 3)
PLAB_ROS_SERVICE(ResetSimulation, 4)
PLAB_ROS_SERVICE(GetEntities, 5)
PLAB_ROS_SERVICE(GetEntitiesStates, 6)
PLAB_ROS_SERVICE(GetEntityState, 7)
PLAB_ROS_SERVICE(SetEntityState, 8)
PLAB_ROS_SERVICE(GetEntityInfo, 9)
PLAB_ROS_SERVICE(GetEntityBounds, 10)
PLAB_ROS_SERVICE(SpawnEntity, 11)
PLAB_ROS_SERVICE(SpawnEntities, 12)
PLAB_ROS_SERVICE(DeleteEntity, 13)
PLAB_ROS_SERVICE(LoadWorld, 14)
PLAB_ROS_SERVICE(GetCurrentWorld, 15)
#undef PLAB_ROS_SERVICE

std::string topic_name(const std::string& space, const std::string& name) { return "rt" + space + "/" + name; }

std::string request_name(const std::string& space, const std::string& node, const std::string& service)
{
    return "rq" + space + "/" + node + "/" + service + "Request";
}

std::string reply_name(const std::string& space, const std::string& node, const std::string& service)
{
    return "rr" + space + "/" + node + "/" + service + "Reply";
}

Qos qos_of(const Profile& profile, const std::string& type_hash, const std::string& extra)
{
    Qos qos(dds_create_qos());
    dds_qset_reliability(qos.get(), profile.is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, profile.depth);
    dds_qset_durability(qos.get(), profile.is_transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    if (profile.is_transient_local)
        dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, profile.depth, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                                    DDS_LENGTH_UNLIMITED);
    const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos.get(), 1, &xcdr1);
    // ROS topics have no keys: nothing is disposed of.
    dds_qset_writer_data_lifecycle(qos.get(), false);
    const std::string data = extra + "typehash=" + type_hash + ";";
    dds_qset_userdata(qos.get(), data.data(), data.size());
    return qos;
}

}  // namespace plab::wire::ros
