#include "control/playback/server_facade.h"

#include <cstring>

namespace plab::playback
{
namespace
{

/// DDS only reads the sample, although its types have no const.
constexpr dds_return_t kMostAtOnce = 256;  ///< a flood of requests must not stop the playback

template <class T>
Result<void> take_into(T& into, Result<T> made)
{
    if (!made) return made.errors();
    into = made.take();
    return {};
}

}  // namespace

Result<ServerFacade> ServerFacade::open(std::uint32_t domain, const std::string& name, const std::string& version, const std::string& file)
{
    if (!wire::is_server_name(name))
        return reason("'" + name + "' is not a valid server name: use 1 to 64 letters, digits, '.', '_' or '-'");
    auto lock = wire::NameLock::take(domain, name);
    if (!lock) return lock.errors();
    return ServerFacade(lock.take(), wire::identify(name, version), file);
}

Result<void> ServerFacade::join(const wire::Entity& participant, const wire::Entity& publisher, const wire::Entity& subscriber)
{
    if (auto done = take_into(replies_, wire::DataWriter<plab_v2_Reply>::make(participant, publisher)); !done) return done;
    if (auto done = take_into(requests_, wire::DataReader<plab_v2_Request>::make(participant, subscriber)); !done) return done;
    if (auto done = take_into(others_, wire::DataReader<plab_v2_Server>::make(participant, subscriber)); !done) return done;
    return take_into(status_, wire::DataWriter<plab_v2_Server>::make(participant, publisher));
}

Result<void> ServerFacade::use(recording::ByteView status) { return decoder_.decode(status, *recorded_); }

void ServerFacade::send(const PlaybackState& s)
{
    plab_v2_Server out = **recorded_;  // its texts and sequences still belong to the sample
    out.name = wire::text(identity_.name), out.version = wire::text(identity_.version), out.host = wire::text(identity_.host);
    out.process = identity_.process, out.started_ns = identity_.started_ns;
    out.run = s.run, out.step = s.step, out.time = s.time;
    out.paused = s.is_paused, out.rate_asked = s.rate_asked, out.rate_reached = s.rate_reached;
    if (out.last_event > 0) out.last_event += s.event_shift;
    if (out.last_collision > 0) out.last_collision += s.collision_shift;
    out.requests_refused += refused_;
    out.playback = wire::text(file_);
    out.overload = wire::text("");
    // These fields only applied to the recorded server: here no step takes too long, nothing can be restored, and nothing is
    // recorded.
    out.rewind_from = -1;
    out.snapshots = {};
    out.recording = {};
    (void)status_.write(out);
}

void ServerFacade::answer(const PlaybackState& state)
{
    (void)requests_.take(
        [&](const plab_v2_Request& request, const dds_sample_info_t& info)
        {
            if (info.valid_data) refuse(request, state);
        },
        kMostAtOnce);
}

void ServerFacade::refuse(const plab_v2_Request& request, const PlaybackState& state)
{
    const std::string why = "this is a playback of " + file_ + ": it cannot be changed";
    char* reasons[] = {wire::text(why)};
    plab_v2_Reply reply{};
    std::memcpy(reply.client, request.client, sizeof reply.client);
    reply.number = request.number;
    reply.outcome = wire::text("refused");
    reply.reasons = {1, 1, reasons, false};
    reply.run = state.run, reply.revision = (*recorded_)->revision;
    reply.step = state.step, reply.time = state.time;
    (void)replies_.write(reply);
    ++refused_;
}

std::optional<std::string> ServerFacade::find_rival()
{
    std::optional<std::string> why;
    const auto compare = [&](const plab_v2_Server& other, const dds_sample_info_t& info)
    {
        if (why || !info.valid_data || info.instance_state != DDS_IST_ALIVE || !wire::keeps_the_name(other, identity_)) return;
        why = "a server '" + identity_.name + "' is already running on host " + other.host + " (process " + std::to_string(other.process) +
              "): give the playback another name (--name)";
    };
    (void)others_.take(compare, kMostAtOnce);
    return why;
}

void ServerFacade::leave(dds_duration_t longest)
{
    plab_v2_Server key{};
    key.name = wire::text(identity_.name);
    (void)status_.dispose(key);
    (void)dds_wait_for_acks(status_.entity().get(), longest);
}

}  // namespace plab::playback
