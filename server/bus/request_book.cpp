#include "bus/request_book.h"

#include <algorithm>
#include <cassert>

namespace plab::bus
{
namespace
{

/// About what an answer keeps of memory.
std::size_t bytes_of(const publish::Answer& answer)
{
    std::size_t bytes = sizeof answer;
    for (const Error& e : answer.reply.errors) bytes += sizeof e + e.where.file.size() + e.element.size() + e.reason.size();
    for (const simulation::SwapReport& swap : answer.reply.swaps)
    {
        bytes += sizeof swap + swap.id.size() + swap.from.size() + swap.to.size();
        for (const simulation::FieldFate& fate : swap.fields) bytes += sizeof fate + fate.field.size();
    }
    return bytes;
}

publish::Answer refusal(const publish::ClientId& client, std::uint64_t number, Error why)
{
    publish::Answer answer;
    answer.client = client, answer.number = number;
    answer.reply.errors.push_back(std::move(why));
    return answer;
}

}  // namespace

RequestBook::Client& RequestBook::client_of(const publish::ClientId& id)
{
    const auto found = by_id_.find(id);
    if (found != by_id_.end())
        clients_.splice(clients_.end(), clients_, found->second);
    else
    {
        clients_.emplace_back().id = id;
        by_id_.emplace(id, std::prev(clients_.end()));
    }
    return clients_.back();
}

std::optional<RequestBook::Decision> RequestBook::known(const Client& client, std::uint64_t number) const
{
    if (number > client.highest) return std::nullopt;
    if (client.waiting.contains(number)) return Decision{Verdict::Waiting, {}};
    const auto kept = std::find_if(client.answers.begin(), client.answers.end(), [&](const auto& a) { return a.number == number; });
    if (kept != client.answers.end()) return Decision{Verdict::Answered, *kept};
    std::string why = "request " + std::to_string(number) + " came after request " + std::to_string(client.highest);
    if (number <= client.forgotten)
        why += ", and its answer is not kept any more: it is not carried out again, nor said whether it was";
    else
        why += ": numbers must rise";
    return Decision{Verdict::Refused, refusal(client.id, number, reason(std::move(why)))};
}

RequestBook::Decision RequestBook::open(const publish::ClientId& id, std::uint64_t number, const std::optional<Error>& wrong)
{
    // Without an id or a number there is nothing to remember it by.
    if (number == 0 || id == publish::ClientId{})
        return {Verdict::Refused, refusal(id, number, wrong.value_or(reason("the request has no client id or no number")))};
    Client& client = client_of(id);
    if (auto decision = known(client, number)) return *std::move(decision);
    client.highest = number;
    std::optional<Error> refused = wrong;
    if (!refused && waiting_ >= limits_.waiting)
        refused = reason(std::to_string(waiting_) + " requests are waiting already: send it again, with a new number, when some are done");
    if (refused)
    {
        Decision decision{Verdict::Refused, refusal(id, number, *std::move(refused))};
        keep(client, decision.answer);
        return decision;
    }
    client.waiting.insert(number);
    ++waiting_;
    forget_silent_clients(client);
    return {};
}

bool RequestBook::close(const publish::Answer& answer)
{
    const auto found = by_id_.find(answer.client);
    if (found == by_id_.end() || found->second->waiting.erase(answer.number) == 0) return false;
    --waiting_;
    keep(*found->second, answer);
    return true;
}

void RequestBook::keep(Client& client, const publish::Answer& answer)
{
    client.answers.push_back(answer);
    answer_bytes_ += bytes_of(answer);
    while (client.answers.size() > std::max<std::size_t>(limits_.answers, 1)) forget_oldest_answer(client);
    forget_silent_clients(client);
    while (answer_bytes_ > limits_.answer_bytes && client.answers.size() > 1) forget_oldest_answer(client);
}

void RequestBook::forget_oldest_answer(Client& client)
{
    client.forgotten = std::max(client.forgotten, client.answers.front().number);
    answer_bytes_ -= bytes_of(client.answers.front());
    client.answers.pop_front();
}

void RequestBook::forget_silent_clients(const Client& except)
{
    const auto too_much = [&] { return clients_.size() > limits_.clients || answer_bytes_ > limits_.answer_bytes; };
    for (auto client = clients_.begin(); client != clients_.end() && too_much();)
    {
        // Who still waits for an answer is known by it.
        if (&*client == &except || !client->waiting.empty())
        {
            ++client;
            continue;
        }
        while (!client->answers.empty()) forget_oldest_answer(*client);
        by_id_.erase(client->id);
        client = clients_.erase(client);
    }
}

}  // namespace plab::bus
