#include "control/recording/player/server_facade.h"

#include "idl/samples.h"

namespace plab::player
{
namespace
{

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

Result<void> ServerFacade::use(recording::ByteView status)
{
    recording::Sample<plab_v2_Server> sample;
    if (auto decoded = decoder_.decode(status, sample); !decoded) return decoded;
    wire::read_sample(*sample, recorded_);
    return {};
}

void ServerFacade::send(const PlaybackState& s)
{
    wire::Server out = recorded_;
    wire::sign(out, identity_);
    out.run = s.run, out.step = s.step, out.time = s.time;
    out.paused = s.is_paused, out.rate_asked = s.rate_asked, out.rate_reached = s.rate_reached;
    if (out.last_event > 0) out.last_event += s.event_shift;
    if (out.last_collision > 0) out.last_collision += s.collision_shift;
    out.requests_refused += refused_;
    out.playback = file_;
    out.overload.clear();
    // These fields only applied to the recorded server: here no step takes too long, nothing can be restored, and nothing is
    // recorded.
    out.rewind_from = -1;
    out.snapshots.clear();
    out.recording = {};
    wire::SampleView<plab_v2_Server> view;
    (void)status_.write(view.of(out));
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
    wire::Reply reply;
    wire::read_sample(request.client, reply.client);
    reply.number = request.number, reply.outcome = "refused";
    reply.reasons = {"this is a playback of " + file_ + ": it cannot be changed"};
    reply.run = state.run, reply.revision = recorded_.revision;
    reply.step = state.step, reply.time = state.time;
    wire::SampleView<plab_v2_Reply> view;
    (void)replies_.write(view.of(reply));
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

}  // namespace plab::player
