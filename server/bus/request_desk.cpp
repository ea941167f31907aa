#include "bus/request_desk.h"

#include <cassert>

#include "bus/request_check.h"

namespace plab::bus
{
namespace
{

constexpr std::size_t kLongestReason = 300;

}  // namespace

RequestDesk::RequestDesk()
    : book_({}),
      requests_(wire::kMostRequestsWaiting + wire::kMostShutdownsWaiting),
      answers_(wire::kMostRequestsWaiting + wire::kMostShutdownsWaiting)
{
}

bool RequestDesk::take(publish::ReceivedRequest& request)
{
    publish::ReceivedRequest* const oldest = requests_.begin_pop();
    if (oldest == nullptr) return false;
    request = std::move(*oldest);
    requests_.end_pop();
    return true;
}

void RequestDesk::answer(wire::Reply&& answer)
{
    answers_.begin_push() = std::move(answer);
    answers_.end_push();
    assert(answers_.dropped() == 0 && "more answers than requests");
}

RequestDesk::Received RequestDesk::receive(RequestMessage&& message, std::int64_t now_ns)
{
    wire::Request& request = message.request;
    std::string wrong = std::move(message.wrong);
    if (wrong.size() > kLongestReason || !is_utf8(wrong)) wrong = "the request cannot be decoded";
    if (wrong.empty()) wrong = wrong_with(request);
    RequestBook::Load load;
    if (wrong.empty()) load = {.names_step = request.at >= 0, .shutdown = is_shutdown(request), .bytes = bytes_of(request)};
    RequestBook::Decision decision =
        book_.open(request.client, request.number, load, wrong.empty() ? std::nullopt : std::optional<Error>(reason(std::move(wrong))));
    switch (decision.verdict)
    {
        case RequestBook::Verdict::New:
            requests_.begin_push() = {std::move(request), now_ns};
            requests_.end_push();
            return {true, load.shutdown};
        case RequestBook::Verdict::Waiting:
            return {};
        case RequestBook::Verdict::Answered:
        case RequestBook::Verdict::Refused:
            decision.answer.repeated = decision.verdict == RequestBook::Verdict::Answered;
            at_once_.push_back(std::move(decision.answer));
            return {};
    }
    return {};
}

std::optional<wire::Reply> RequestDesk::next_answer(std::uint64_t& strays)
{
    if (!at_once_.empty())
    {
        std::optional<wire::Reply> out(std::move(at_once_.front()));
        at_once_.pop_front();
        return out;
    }
    while (wire::Reply* const oldest = answers_.begin_pop())
    {
        wire::Reply answer = std::move(*oldest);
        answers_.end_pop();
        if (book_.close(answer)) return answer;
        ++strays;
    }
    return {};
}

}  // namespace plab::bus
