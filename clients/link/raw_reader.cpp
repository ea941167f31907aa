#include <dds/ddsi/ddsi_serdata.h>

#include <algorithm>
#include <array>

#include "link/discovery.h"

namespace plab::link
{
namespace
{

struct SerdataDeleter
{
    void operator()(ddsi_serdata* data) const { ddsi_serdata_unref(data); }
};

}  // namespace

Result<RawReader> RawReader::open(const Session& session, const wire::Topic& topic, std::int32_t depth)
{
    RawReader out;
    out.type_name_ = topic.type->m_typename;
    const wire::Qos qos = wire::qos_of(topic.delivery);
    const dds_entity_t participant = session.participant().get();
    const dds_entity_t made = dds_create_topic(participant, topic.type, topic.name, qos.get(), nullptr);
    if (made < 0) return wire::failed(std::string("cannot use the topic ") + topic.name, made);
    out.topic_ = wire::Entity(made);
    auto subscriber = wire::make_subscriber(session.participant(), session.server());
    if (!subscriber) return subscriber.errors();
    out.subscriber_ = subscriber.take();
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
    // Clients wait for readers that acknowledge their requests: only the server should.
    if (topic.delivery == wire::Delivery::Request) dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
    const dds_entity_t reader = dds_create_reader(out.subscriber_.get(), made, qos.get(), nullptr);
    if (reader < 0) return wire::failed(std::string("cannot read ") + topic.name, reader);
    out.reader_ = wire::Entity(reader);
    if (auto waits = out.make_waitset(participant); !waits) return waits.errors();
    return out;
}

Result<void> RawReader::make_waitset(dds_entity_t participant)
{
    waitset_ = wire::Entity(dds_create_waitset(participant));
    // A condition, unlike a status, stays true while samples are left.
    const dds_entity_t condition = dds_create_readcondition(reader_.get(), DDS_ANY_STATE);
    if (const auto code = dds_waitset_attach(waitset_.get(), condition, 0); code < 0)
        return wire::failed("cannot wait for samples of " + type_name_, code);
    return {};
}

bool RawReader::wait(Seconds timeout) const { return dds_waitset_wait(waitset_.get(), nullptr, 0, duration_of(timeout)) > 0; }

std::size_t RawReader::take(const std::function<void(const RawSample&)>& handle)
{
    constexpr std::size_t kBatch = 64;
    std::vector<std::byte> bytes;
    std::array<ddsi_serdata*, kBatch> samples{};
    std::array<dds_sample_info_t, kBatch> infos;
    // One batch for each wake-up: a writer that never pauses must not keep the caller in this function.
    const dds_return_t n = dds_takecdr(reader_.get(), samples.data(), kBatch, infos.data(), DDS_ANY_STATE);
    for (std::size_t i = 0; n > 0 && i < static_cast<std::size_t>(n); ++i)
    {
        const std::unique_ptr<ddsi_serdata, SerdataDeleter> data(samples[i]);
        bytes.resize(ddsi_serdata_size(data.get()));
        ddsi_serdata_to_ser(data.get(), 0, bytes.size(), bytes.data());
        handle({bytes, infos[i].valid_data, infos[i].instance_state != DDS_IST_ALIVE, infos[i].source_timestamp,
                infos[i].publication_handle, infos[i].instance_handle});
    }
    return static_cast<std::size_t>(std::max(n, 0));
}

std::uint32_t RawReader::writers() const
{
    dds_subscription_matched_status_t status{};
    return dds_get_subscription_matched_status(reader_.get(), &status) < 0 ? 0 : status.current_count;
}

}  // namespace plab::link
