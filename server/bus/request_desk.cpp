#include "bus/request_desk.h"

#include <cassert>

#include "bus/request_check.h"

namespace plab::bus
{

RequestDesk::RequestDesk(Trouble& trouble)
    : trouble_(&trouble),
      book_({}),
      requests_(wire::kMostRequestsWaiting + wire::kMostShutdownsWaiting),
      answers_(wire::kMostRequestsWaiting + wire::kMostShutdownsWaiting),
      outbox_([this](const publish::Answer& answer, bool repeated) { return writer_.write(sample_.of(answer, repeated)); }, trouble)
{
}

Result<void> RequestDesk::open(const wire::Entity& participant, const wire::Entity& publisher, const wire::Entity& subscriber)
{
    // The writer first: who has found the reader and asks at once has a writer to hear from.
    auto writer = wire::Writer<plab_v2_Reply>::make(participant, publisher);
    if (!writer) return writer.errors();
    auto reader = wire::Reader<plab_v2_Request>::make(participant, subscriber);
    if (!reader) return reader.errors();
    writer_ = writer.take(), reader_ = reader.take();
    return {};
}

bool RequestDesk::take(publish::RequestText& request)
{
    publish::RequestText* const oldest = requests_.begin_pop();
    if (oldest == nullptr) return false;
    request = std::move(*oldest);
    requests_.end_pop();
    return true;
}

void RequestDesk::answer(publish::Answer&& answer)
{
    answers_.begin_push() = std::move(answer);
    answers_.end_push();
    assert(answers_.dropped() == 0 && "more answers than requests");
}

RequestDesk::Received RequestDesk::receive(Clock::time_point now)
{
    constexpr dds_return_t kMostAtATime = 256;
    Received received;
    const auto handle = [&](const plab_v2_Request& request, const dds_sample_info_t& info)
    {
        if (info.valid_data) receive_one(request, now, received);
    };
    const dds_return_t n = reader_.take(handle, kMostAtATime);
    (void)trouble_->check(wire::topic_of<plab_v2_Request>().name, n < 0 ? n : DDS_RETCODE_OK);
    received.more = n >= kMostAtATime;
    return received;
}

void RequestDesk::receive_one(const plab_v2_Request& request, Clock::time_point now, Received& received)
{
    auto text = read_request(request);
    const std::optional<Error> wrong = text ? std::nullopt : std::optional<Error>(text.error());
    RequestBook::Load load;
    if (text) load = {.names_step = text->at >= 0, .shutdown = is_shutdown(*text), .bytes = bytes_of(*text)};
    const RequestBook::Decision decision = book_.open(client_of(request), request.number, load, wrong);
    switch (decision.verdict)
    {
        case RequestBook::Verdict::New:
            text->arrived_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now.time_since_epoch()).count();
            requests_.begin_push() = text.take();
            requests_.end_push();
            received.any_new = true;
            received.shutdown = received.shutdown || load.shutdown;
            break;
        case RequestBook::Verdict::Waiting:
            break;
        case RequestBook::Verdict::Answered:
            outbox_.send(decision.answer, true, now);
            break;
        case RequestBook::Verdict::Refused:
            outbox_.send(decision.answer, false, now);
            break;
    }
}

bool RequestDesk::next_answer()
{
    publish::Answer* const answer = answers_.begin_pop();
    if (answer == nullptr) return false;
    answer_ = std::move(*answer);
    answers_.end_pop();
    return true;
}

void RequestDesk::send_answer(Clock::time_point now)
{
    if (book_.close(answer_))
        outbox_.send(answer_, false, now);
    else
        trouble_->say("an answer to a request that nobody waits for was left out");
}

}  // namespace plab::bus
