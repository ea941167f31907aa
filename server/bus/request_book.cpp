#include "bus/request_book.h"

#include <algorithm>
#include <cassert>

namespace plab::bus
{
namespace
{

/// Approximate memory that a stored answer needs.
std::size_t bytes_of(const wire::Reply& answer)
{
    std::size_t bytes = sizeof answer;
    for (const std::string& reason : answer.reasons) bytes += sizeof reason + reason.size();
    for (const wire::SwapReport& swap : answer.swaps)
    {
        bytes += sizeof swap + swap.component_id.size() + swap.from_type.size() + swap.to_type.size();
        for (const wire::FieldFate& field : swap.fields) bytes += sizeof field + field.name.size();
    }
    return bytes;
}

wire::Reply refusal(const wire::ClientId& client, std::uint64_t number, Error why)
{
    wire::Reply answer;
    answer.client = client, answer.number = number, answer.outcome = "refused", answer.trial = "none";
    answer.reasons.push_back(why.text());
    return answer;
}

std::size_t without(std::size_t all, std::size_t kept) { return all > kept ? all - kept : 0; }

Error full(const std::string& what) { return reason(what + " already waiting: send it again, with a new number, when some are done"); }

}  // namespace

RequestBook::Client& RequestBook::client_of(const wire::ClientId& id)
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
        why += ", and its reply is no longer kept: it is not carried out again, and it is not known here whether it was";
    else
        why += ": numbers must increase";
    return Decision{Verdict::Refused, refusal(client.id, number, reason(std::move(why)))};
}

std::optional<Error> RequestBook::no_room(const Client& client, const Load& load) const
{
    if (load.shutdown)
    {
        if (shutdowns_.requests < limits_.shutdowns) return std::nullopt;
        return reason(std::to_string(shutdowns_.requests) + " requests to shut down are already waiting: one is enough");
    }
    if (client.counted >= limits_.waiting_per_client)
        return full(std::to_string(client.counted) + " requests of this client, the maximum for one client, are");
    if (all_.requests >= limits_.waiting)
        return full(std::to_string(all_.requests) + " requests, the maximum for all clients together, are");
    if (load.names_step && with_step_.requests >= without(limits_.waiting, limits_.kept_for_next_step))
        return full(std::to_string(with_step_.requests) + " requests that name a step, the maximum of these, are");
    return no_bytes(load);
}

std::optional<Error> RequestBook::no_bytes(const Load& load) const
{
    const auto too_much = [&](const Count& count, std::size_t most) { return count.bytes + load.bytes > most; };
    const auto words = [&](const Count& count, const char* of, std::size_t most)
    {
        return reason("the request has " + std::to_string(load.bytes) + " bytes, and " + std::to_string(count.bytes) + " bytes of " + of +
                      " are already waiting, of at most " + std::to_string(most) +
                      ": send it again, with a new number, when some are done");
    };
    if (too_much(all_, limits_.waiting_bytes)) return words(all_, "requests", limits_.waiting_bytes);
    const std::size_t most = without(limits_.waiting_bytes, limits_.bytes_kept_for_next_step);
    if (load.names_step && too_much(with_step_, most)) return words(with_step_, "requests that name a step", most);
    return std::nullopt;
}

void RequestBook::count(Client& client, const Load& load)
{
    const auto add = [&](Count& to) { ++to.requests, to.bytes += load.bytes; };
    if (load.shutdown) return add(shutdowns_);
    ++client.counted;
    add(all_);
    if (load.names_step) add(with_step_);
}

void RequestBook::discount(Client& client, const Load& load)
{
    const auto take = [&](Count& from) { --from.requests, from.bytes -= load.bytes; };
    if (load.shutdown) return take(shutdowns_);
    --client.counted;
    take(all_);
    if (load.names_step) take(with_step_);
}

RequestBook::Decision RequestBook::open(const wire::ClientId& id, std::uint64_t number, const Load& load, const std::optional<Error>& wrong)
{
    // Without a client id or a number, the request cannot be identified later.
    if (number == 0 || id == wire::ClientId{})
        return {Verdict::Refused, refusal(id, number, wrong.value_or(reason("the request has no client id or no number")))};
    Client& client = client_of(id);
    if (auto decision = known(client, number)) return *std::move(decision);
    client.highest = number;
    if (std::optional<Error> refused = wrong ? wrong : no_room(client, load))
    {
        Decision decision{Verdict::Refused, refusal(id, number, *std::move(refused))};
        keep(client, decision.answer);
        return decision;
    }
    client.waiting.emplace(number, load);
    count(client, load);
    forget_silent_clients(client);
    return {};
}

bool RequestBook::close(const wire::Reply& answer)
{
    const auto found = by_id_.find(answer.client);
    if (found == by_id_.end()) return false;
    Client& client = *found->second;
    const auto waited = client.waiting.find(answer.number);
    if (waited == client.waiting.end()) return false;
    discount(client, waited->second);
    client.waiting.erase(waited);
    keep(client, answer);
    return true;
}

void RequestBook::keep(Client& client, const wire::Reply& answer)
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
        // This records which client still waits for an answer.
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
