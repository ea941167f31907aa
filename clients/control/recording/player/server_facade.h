/// Makes a playback appear as a server: its name, its status, and a refusal for every request.
#pragma once

#include <optional>
#include <string>

#include "idl/entity.h"
#include "idl/identity.h"
#include "idl/name_lock.h"
#include "idl/recording/cdr.h"

namespace plab::player
{

/// The current position of the playback.
struct PlaybackState
{
    std::uint64_t run = 0;
    std::int64_t step = 0;
    double time = 0;  ///< s, simulated
    bool is_paused = false;
    double rate_asked = 1, rate_reached = 0;
    std::uint64_t run_shift = 0, event_shift = 0, collision_shift = 0;  ///< offsets from the recording's numbers to the published ones
};

class ServerFacade
{
public:
    /// Reserves the name. An error: a server of this name is already running on this host.
    static Result<ServerFacade> open(std::uint32_t domain, const std::string& name, const std::string& version, const std::string& file);
    /// From now on it is visible and accepts requests.
    Result<void> join(const wire::Entity& participant, const wire::Entity& publisher, const wire::Entity& subscriber);

    /// The latest status of the recorded server; data that is not a sample of plab/server is an error.
    Result<void> use(recording::ByteView status);
    void send(const PlaybackState& state);
    /// Refuses the requests that have arrived.
    void answer(const PlaybackState& state);
    /// Why this playback has to end, if it must: the server that started first keeps the name.
    std::optional<std::string> find_rival();
    /// Disposes of its instances; waits at most this long.
    void leave(dds_duration_t longest);

    const wire::Entity& requests() const { return requests_.entity(); }
    const std::string& name() const { return identity_.name; }

private:
    ServerFacade(wire::NameLock lock, wire::Identity identity, std::string file)
        : lock_(std::move(lock)), identity_(std::move(identity)), file_(std::move(file))
    {
    }
    void refuse(const plab_v2_Request& request, const PlaybackState& state);

    wire::NameLock lock_;
    wire::Identity identity_;
    std::string file_;
    recording::Decoder decoder_;
    wire::Server recorded_;  ///< the latest status of the recorded server
    wire::DataWriter<plab_v2_Server> status_;
    wire::DataReader<plab_v2_Server> others_;
    wire::DataReader<plab_v2_Request> requests_;
    wire::DataWriter<plab_v2_Reply> replies_;
    std::uint64_t refused_ = 0;
};

}  // namespace plab::player
