/// The server's own topic: its status, and whether another server has its name.
#pragma once

#include <chrono>
#include <optional>

#include "bus/process/trouble.h"
#include "idl/entity.h"
#include "idl/identity.h"
#include "idl/samples.h"

namespace plab::bus
{

class Presence
{
public:
    using Clock = std::chrono::steady_clock;
    explicit Presence(wire::Identity identity) : identity_(std::move(identity)) {}

    Result<void> open(const wire::Entity& participant, const wire::Entity& publisher, const wire::Entity& subscriber);
    void set(wire::Server&& status);
    /// Writes the status if it has changed, and repeats it when none was written for one second.
    void send(Clock::time_point now, std::vector<wire::DroppedSamples> dropped, Trouble& trouble);
    /// Time until send() is due if the status does not change.
    Clock::duration due_in(Clock::time_point now) const;
    /// Why this server has to end, if it must: the server that started first keeps the name.
    std::optional<std::string> find_rival();
    void dispose(Trouble& trouble);
    dds_entity_t writer() const { return writer_.entity().get(); }

private:
    wire::Identity identity_;
    wire::DataWriter<plab_v2_Server> writer_;
    wire::DataReader<plab_v2_Server> reader_;
    wire::SampleView<plab_v2_Server> sample_;
    std::optional<wire::Server> status_;
    bool is_new_ = false;
    Clock::time_point written_{};
};

}  // namespace plab::bus
