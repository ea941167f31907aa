/// Topic names, types and QoS of the bus: the one table that server and clients share.
/// Every topic is in the partition named after the server, so that several servers can share a domain. The reasons for each
/// kind of delivery are in README.md.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "idl/plab.h"
#include "idl/values/limits.h"

namespace plab::wire
{

/// The strings of a sample that is written. Cyclone only reads them, although its C types have no const.
inline char* text(const std::string& s) { return const_cast<char*>(s.c_str()); }
inline char* text(const char* s) { return const_cast<char*>(s); }

enum class Delivery : std::uint8_t
{
    Catalogue,  ///< reliable, kept for late joiners: the last sample of each instance; disposed when the instance no longer exists
    Newest,     ///< reliable, the last 4: a slow reader misses frames, but never blocks the writer
    Log,        ///< reliable, the last 4096 samples: sequence numbers reveal gaps
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
