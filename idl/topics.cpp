#include "idl/topics.h"

#include <array>

namespace plab::wire
{
namespace
{

constexpr std::array<Topic, 22> kTopics{{
    {"plab/server", &plab_v2_Server_desc, Delivery::Catalogue, "the server's state, at least once a second"},
    {"plab/scene", &plab_v2_Scene_desc, Delivery::Catalogue, "the loaded scene, and its cameras"},
    {"plab/objects", &plab_v2_SceneObject_desc, Delivery::Catalogue, "bodies and shafts"},
    {"plab/shapes", &plab_v2_Shape_desc, Delivery::Catalogue, "geometry of bodies"},
    {"plab/interactions", &plab_v2_Interaction_desc, Delivery::Catalogue, "all other components, with their algorithms"},
    {"plab/types", &plab_v2_Type_desc, Delivery::Catalogue, "types that can be added or swapped in"},
    {"plab/states", &plab_v2_Frame_desc, Delivery::Newest, "positions and velocities, one sample per frame"},
    {"plab/updates", &plab_v2_FrameUpdate_desc, Delivery::Newest, "the same as key frames and deltas, for many objects and readers"},
    {"plab/collisions", &plab_v2_Collisions_desc, Delivery::Log, "contacts that begin, bounce, rest and end"},
    {"plab/events", &plab_v2_Events_desc, Delivery::Log, "events of interactions, failures, applied requests"},
    {"plab/metrics", &plab_v2_Metrics_desc, Delivery::Catalogue, "cost, error and work of each interaction, energy"},
    {"plab/requests", &plab_v2_Request_desc, Delivery::Request, "requests of clients"},
    {"plab/replies", &plab_v2_Reply_desc, Delivery::Reply, "replies, each for one client"},
    {"plab/images", &plab_v2_Image_desc, Delivery::Newest, "pictures of cameras in the scene"},
    {"plab/journal", &plab_v2_Journal_desc, Delivery::Log, "requests that took effect, as text"},
    {"plab/hashes", &plab_v2_Hashes_desc, Delivery::Log, "the state hash of every step"},
    {"plab/snapshots", &plab_v2_Snapshot_desc, Delivery::Newest, "everything that a run needs to continue from there"},
    {"plab/gone", &plab_v2_Gone_desc, Delivery::Log, "in recordings only: catalogue entries that were disposed of"},
    {"plab/viewers", &plab_v2_ViewerSample_desc, Delivery::Newest, "from where clients look at the scene"},
    {"plab/users", &plab_v2_UserSample_desc, Delivery::Newest, "hands and devices of people"},
    {"plab/forces", &plab_v2_Forces_desc, Delivery::Newest, "forces on them, after each step"},
    {"plab/contacts", &plab_v2_ContactForces_desc, Delivery::Newest, "where bodies touch, and the forces there"},
}};

}  // namespace

std::span<const Topic> topics() { return kTopics; }

#define PLAB_TOPIC(Type, index)                             \
    template <>                                             \
    const Topic& topic_of<Type>()                           \
    {                                                       \
        static_assert(kTopics[index].type == &Type##_desc); \
        return kTopics[index];                              \
    }
PLAB_TOPIC(plab_v2_Server, 0)
PLAB_TOPIC(plab_v2_Scene, 1)
PLAB_TOPIC(plab_v2_SceneObject, 2)
PLAB_TOPIC(plab_v2_Shape, 3)
PLAB_TOPIC(plab_v2_Interaction, 4)
PLAB_TOPIC(plab_v2_Type, 5)
PLAB_TOPIC(plab_v2_Frame, 6)
PLAB_TOPIC(plab_v2_FrameUpdate, 7)
PLAB_TOPIC(plab_v2_Collisions, 8)
PLAB_TOPIC(plab_v2_Events, 9)
PLAB_TOPIC(plab_v2_Metrics, 10)
PLAB_TOPIC(plab_v2_Request, 11)
PLAB_TOPIC(plab_v2_Reply, 12)
PLAB_TOPIC(plab_v2_Image, 13)
PLAB_TOPIC(plab_v2_Journal, 14)
PLAB_TOPIC(plab_v2_Hashes, 15)
PLAB_TOPIC(plab_v2_Snapshot, 16)
PLAB_TOPIC(plab_v2_Gone, 17)
PLAB_TOPIC(plab_v2_ViewerSample, 18)
PLAB_TOPIC(plab_v2_UserSample, 19)
PLAB_TOPIC(plab_v2_Forces, 20)
PLAB_TOPIC(plab_v2_ContactForces, 21)
#undef PLAB_TOPIC

Qos qos_of(Delivery delivery)
{
    constexpr dds_duration_t kBlocking = DDS_SECS(1);
    Qos qos(dds_create_qos());
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, delivery == Delivery::Request ? kBlocking : 0);
    dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
    // The default since XTypes is to guess; every reader that is not XTypes-aware wants XCDR1.
    const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos.get(), 1, &xcdr1);
    switch (delivery)
    {
        case Delivery::Catalogue:
            dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
            dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                                        DDS_LENGTH_UNLIMITED);
            dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
            dds_qset_writer_data_lifecycle(qos.get(), true);
            break;
        case Delivery::Newest:
            dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 4);
            break;
        case Delivery::Log:
            dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 4096);
            break;
        case Delivery::Request:
            dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
            break;
        case Delivery::Reply:
            dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 256);
            break;
    }
    return qos;
}

Qos partition_qos(const std::string& partition)
{
    Qos qos(dds_create_qos());
    dds_qset_partition1(qos.get(), partition.c_str());
    return qos;
}

}  // namespace plab::wire
