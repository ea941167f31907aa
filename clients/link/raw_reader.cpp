#include <dds/ddsi/ddsi_serdata.h>

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

bool RawReader::wait(Seconds timeout) const { return dds_waitset_wait(waitset_.get(), nullptr, 0, duration_of(timeout)) > 0; }

void RawReader::take(const std::function<void(const RawSample&)>& handle)
{
    constexpr std::size_t kBatch = 64;
    std::vector<std::byte> bytes;
    std::array<ddsi_serdata*, kBatch> samples{};
    std::array<dds_sample_info_t, kBatch> infos;
    // One round for each wake-up: a writer that never pauses must not keep the caller in here.
    const dds_return_t n = dds_takecdr(reader_.get(), samples.data(), kBatch, infos.data(), DDS_ANY_STATE);
    for (std::size_t i = 0; n > 0 && i < static_cast<std::size_t>(n); ++i)
    {
        const std::unique_ptr<ddsi_serdata, SerdataDeleter> data(samples[i]);
        bytes.resize(ddsi_serdata_size(data.get()));
        ddsi_serdata_to_ser(data.get(), 0, bytes.size(), bytes.data());
        handle(
            {bytes, infos[i].valid_data, infos[i].instance_state != DDS_IST_ALIVE, infos[i].source_timestamp, infos[i].publication_handle});
    }
}

std::uint32_t RawReader::writers() const
{
    dds_subscription_matched_status_t status{};
    return dds_get_subscription_matched_status(reader_.get(), &status) < 0 ? 0 : status.current_count;
}

}  // namespace plab::link
