/// Topic names, types and QoS of the bus: the one table that server and clients share.
///
/// Every topic lives in the partition that is the server's name, so that several servers share a domain. Why each
/// delivery is as it is: README.md.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "idl/limits.h"
#include "idl/plab.h"

namespace plab::wire
{

enum class Delivery : std::uint8_t
{
    Catalogue,  ///< reliable, kept for late joiners: the last sample of each instance; disposed when it is gone
    Newest,     ///< reliable, the last 4: who is slow misses frames, nobody waits
    Log,        ///< reliable, the last 4096 samples: gaps are seen by their numbers
    Request,    ///< reliable, all; the client blocks for at most a second
    Reply,      ///< reliable, the last 256 of each client
};

struct Topic
{
    const char* name;
    const dds_topic_descriptor_t* type;
    Delivery delivery;
    const char* doc;
};

/// All topics, in the order in which server/docs/bus.md lists them.
std::span<const Topic> topics();

/// The topic of a C type of plab.h: topic_of<plab_v2_Frame>().
template <class T>
const Topic& topic_of();

struct QosDeleter
{
    void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

/// QoS of topic, readers and writers alike.
Qos qos_of(Delivery delivery);
/// QoS of a publisher or subscriber in one partition; "*" reads those of all servers.
Qos partition_qos(const std::string& partition);

}  // namespace plab::wire
