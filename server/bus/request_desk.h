/// Where requests come in and replies go out.
#pragma once

#include "bus/outbox.h"
#include "bus/request_book.h"
#include "idl/entity.h"
#include "publish/ring.h"
#include "wire/samples.h"

namespace plab::bus
{

class RequestDesk
{
public:
    using Clock = Outbox::Clock;
    explicit RequestDesk(Trouble& trouble);

    Result<void> open(const wire::Entity& participant, const wire::Entity& publisher, const wire::Entity& subscriber);

    // Step thread ------------------------------------------------------------------------------------------------------
    bool take(publish::RequestText& request);
    void answer(publish::Answer&& answer);

    // Bus thread -------------------------------------------------------------------------------------------------------
    struct Received
    {
        bool any_new = false;  ///< for the step thread
        bool shutdown = false;  ///< one of them is to end the server
        bool more = false;     ///< not all has been read
    };
    Received receive(Clock::time_point now);
    /// Takes the next answer of the step thread. Nothing is lost if it is not sent at once: send_answer() does it.
    bool next_answer();
    void send_answer(Clock::time_point now);
    void retry(Clock::time_point now) { outbox_.retry(now); }
    bool retrying() const { return !outbox_.empty(); }
    dds_entity_t writer() const { return writer_.entity().get(); }

private:
    void receive_one(const plab_v2_Request& request, Clock::time_point now, Received& received);

    Trouble* trouble_;
    RequestBook book_;
    // As many as may wait at a time: neither ring can overflow.
    publish::Ring<publish::RequestText> requests_;
    publish::Ring<publish::Answer> answers_;
    publish::Answer answer_;
    wire::ReplySample sample_;
    wire::Writer<plab_v2_Reply> writer_;
    wire::Reader<plab_v2_Request> reader_;
    Outbox outbox_;
};

}  // namespace plab::bus
