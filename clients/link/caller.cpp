#include "link/caller.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <random>

#include "idl/samples.h"

namespace plab::link
{
namespace
{

using Clock = std::chrono::steady_clock;

using Guid = std::array<std::uint8_t, sizeof(dds_guid_t)>;
using Endpoint = dds_builtintopic_endpoint_t* (*)(dds_entity_t, dds_instance_handle_t);

/// The participants of the entities that an entity is matched with.
std::vector<Guid> participants_of(const wire::Entity& entity, dds_return_t (*matched)(dds_entity_t, dds_instance_handle_t*, std::size_t),
                                  Endpoint data)
{
    std::vector<Guid> out;
    std::vector<dds_instance_handle_t> handles(static_cast<std::size_t>(std::max(0, matched(entity.get(), nullptr, 0))));
    const auto count = std::max(0, matched(entity.get(), handles.data(), handles.size()));
    handles.resize(std::min(handles.size(), static_cast<std::size_t>(count)));
    for (const dds_instance_handle_t handle : handles)
    {
        dds_builtintopic_endpoint_t* const endpoint = data(entity.get(), handle);
        if (endpoint == nullptr) continue;  // gone in the meantime
        std::memcpy(out.emplace_back().data(), &endpoint->participant_key, sizeof(Guid));
        dds_builtintopic_free_endpoint(endpoint);
    }
    return out;
}

/// Whether a participant that answers requests also reads them. Other participants read them too (a recorder), and one of those
/// may be found first: a request sent before the server is matched does not reach it.
bool reaches_server(const wire::Entity& requests, const wire::Entity& replies)
{
    const auto readers = participants_of(requests, &dds_get_matched_subscriptions, &dds_get_matched_subscription_data);
    const auto servers = participants_of(replies, &dds_get_matched_publications, &dds_get_matched_publication_data);
    return std::find_first_of(readers.begin(), readers.end(), servers.begin(), servers.end()) != readers.end();
}

/// The server's reader may discover this writer slightly later than this side discovers the reader, and earlier samples are not kept for
/// it: so a request is soon sent again.
constexpr Seconds kFirstBetween(0.02);

}  // namespace

struct Caller::State
{
    /// A request that waits for its reply.
    struct Pending
    {
        Request request;
        std::uint64_t number = 0;
        Seconds between = kFirstBetween;
        Clock::time_point sent_at, seen_at;  ///< the request last sent, the server last seen
    };

    const Session* session = nullptr;
    wire::ClientId id{};
    std::uint64_t last = 0;
    Pending pending;
    wire::DataReader<plab_v2_Reply> replies;  // its filter reads `id`: State never moves
    wire::DataWriter<plab_v2_Request> requests;

    static bool is_mine(const void* sample, void* self)
    {
        return std::memcmp(static_cast<const plab_v2_Reply*>(sample)->client, static_cast<State*>(self)->id.data(),
                           sizeof(wire::ClientId)) == 0;
    }
};

void Caller::StateDeleter::operator()(State* state) const { delete state; }

Result<Caller> Caller::make(const Session& session, Seconds timeout, const Stop& stop)
{
    Caller caller;
    caller.state_.reset(new State);
    State& state = *caller.state_;
    state.session = &session;
    std::random_device random;
    std::generate(std::begin(state.id), std::end(state.id), [&] { return static_cast<std::uint8_t>(random()); });
    auto replies = session.reader<plab_v2_Reply>(&State::is_mine, &state);
    if (!replies) return replies.errors();
    auto requests = session.writer<plab_v2_Request>();
    if (!requests) return requests.errors();
    state.replies = replies.take(), state.requests = requests.take();
    const auto end = moment_after(timeout);
    while (!reaches_server(state.requests.entity(), state.replies.entity()))
    {
        if (Clock::now() >= end || (stop && stop())) return reason("server '" + session.server() + "' did not answer");
        dds_sleepfor(DDS_MSECS(1));
    }
    return caller;
}

Result<std::uint64_t> Caller::send(const Request& request)
{
    const std::uint64_t number = state_->last + 1;
    if (auto sent = send_again(request, number); !sent) return sent.errors();
    state_->last = number;
    return number;
}

Result<void> Caller::send_again(const Request& request, std::uint64_t number)
{
    wire::Request whole{state_->id, number, request.at.value_or(-1), -1, request.operations};
    if (request.revision) whole.revision = static_cast<std::int64_t>(*request.revision);
    wire::SampleView<plab_v2_Request> view;
    if (const dds_return_t code = state_->requests.write(view.of(whole)); code != DDS_RETCODE_OK)
        return wire::failed("cannot send the request", code);
    return {};
}

void Caller::take(const std::function<void(std::uint64_t, Reply)>& handle)
{
    (void)state_->replies.take(
        [&](const plab_v2_Reply& reply, const dds_sample_info_t& info)
        {
            if (info.valid_data) handle(reply.number, wire::value_of<Reply>(reply));
        });
}

std::string Caller::last_request() const
{
    if (state_->last == 0) return {};
    std::string out;
    for (const std::uint8_t byte : state_->id)
        for (const int digit : {byte >> 4, byte & 15}) out += "0123456789abcdef"[digit];
    return out + ":" + std::to_string(state_->last);
}

Presence Caller::presence() const
{
    // A new reader gets the server's state at once, and all readers get it once per second.
    constexpr Seconds kState(1.5);
    if (state_->replies.writers() == 0) return Presence::Gone;
    if (!state_->session->servers(kState, 1).empty()) return Presence::There;
    return state_->replies.writers() == 0 ? Presence::Gone : Presence::Silent;
}

Result<void> Caller::begin(const Request& request)
{
    auto number = send(request);
    if (!number) return number.errors();
    const auto now = Clock::now();
    state_->pending = {request, *number, kFirstBetween, now, now};
    return {};
}

Result<std::optional<Reply>> Caller::wait(Seconds slice)
{
    constexpr Seconds kMostBetween(1.0), kGone(0.5);
    State::Pending& pending = state_->pending;
    if (state_->replies.writers() > 0) pending.seen_at = Clock::now();
    // Its last reply may arrive before or after the notice of its end.
    if (Clock::now() - pending.seen_at >= kGone) return reason("server '" + state_->session->server() + "' has gone without a reply");
    const Seconds until_again = std::max(pending.between - Seconds(Clock::now() - pending.sent_at), Seconds(1e-3));
    (void)state_->session->wait(state_->replies, std::min(slice, until_again));
    std::optional<Reply> answer;
    take(
        [&](std::uint64_t of, Reply reply)
        {
            if (of != pending.number || answer) return;
            answer = std::move(reply);
            // The caller made one request. That this function repeated it, and that another copy was answered first, is an
            // internal detail.
            answer->repeated = false;
        });
    if (answer || Clock::now() - pending.sent_at < pending.between) return answer;
    // A request for a later step is answered at that step: repeating it is harmless because of its number.
    if (auto sent = send_again(pending.request, pending.number); !sent) return sent.errors();
    pending.sent_at = Clock::now(), pending.between = std::min(2 * pending.between, kMostBetween);
    return answer;
}

Result<Reply> Caller::call(const Request& request, Seconds timeout, const Stop& stop)
{
    constexpr Seconds kSlice(0.1);
    const auto end = moment_after(timeout);
    if (auto begun = begin(request); !begun) return begun.errors();
    while (true)
    {
        auto reply = wait(std::min(Seconds(end - Clock::now()), kSlice));
        if (!reply) return reply.errors();
        if (*reply) return **reply;
        if (Clock::now() >= end) return reason("no reply from server '" + state_->session->server() + "' within the time-out");
        if (stop && stop()) return reason("interrupted before the reply");
    }
}

}  // namespace plab::link
