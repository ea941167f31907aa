#include "bus/process/presence.h"

#include <utility>

namespace plab::bus
{
namespace
{

constexpr std::chrono::seconds kHeartbeat(1);

}  // namespace

Result<void> Presence::open(const wire::Entity& participant, const wire::Entity& publisher, const wire::Entity& subscriber)
{
    auto writer = wire::DataWriter<plab_v2_Server>::make(participant, publisher);
    if (!writer) return writer.errors();
    auto reader = wire::DataReader<plab_v2_Server>::make(participant, subscriber);
    if (!reader) return reader.errors();
    writer_ = writer.take(), reader_ = reader.take();
    return {};
}

void Presence::set(wire::Server&& status)
{
    status_ = std::move(status), is_new_ = true;
    wire::sign(*status_, identity_);
}

void Presence::send(Clock::time_point now, std::vector<wire::DroppedSamples> dropped, Trouble& trouble)
{
    if (!status_ || (!std::exchange(is_new_, false) && now - written_ < kHeartbeat)) return;
    written_ = now;
    status_->dropped = std::move(dropped);
    (void)trouble.check(wire::topic_of<plab_v2_Server>().name, writer_.write(sample_.of(*status_)));
}

Presence::Clock::duration Presence::due_in(Clock::time_point now) const
{
    if (!status_) return kHeartbeat;
    return std::max<Clock::duration>(written_ + kHeartbeat - now, Clock::duration::zero());
}

std::optional<std::string> Presence::find_rival()
{
    std::optional<std::string> why;
    const auto compare = [&](const plab_v2_Server& other, const dds_sample_info_t& info)
    {
        if (why || !info.valid_data || info.instance_state != DDS_IST_ALIVE || !wire::keeps_the_name(other, identity_)) return;
        why = "a server '" + identity_.name + "' is already running on host " + other.host + " (process " + std::to_string(other.process) +
              ") and started earlier: give this one another name";
    };
    (void)reader_.take(compare, 256);
    return why;
}

void Presence::dispose(Trouble& trouble)
{
    plab_v2_Server key{};
    key.name = wire::text(identity_.name);
    if (status_) (void)trouble.check(wire::topic_of<plab_v2_Server>().name, writer_.dispose(key));
}

}  // namespace plab::bus
