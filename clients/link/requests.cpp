#include "link/requests.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace plab::link
{
namespace
{

constexpr std::chrono::milliseconds kMostBetween(1000);
constexpr std::chrono::seconds kPatience(30);

}  // namespace

void Requests::send(Request request, Then then)
{
    if (waiting_.size() >= kMost) return then(reason("too many requests wait for their replies; try again"));
    const auto number = caller_.send(request);
    if (!number) return then(number.errors());
    const auto now = Clock::now();
    Waiting waiting{std::move(request), std::move(then), now, now + kPatience};
    waiting.next += waiting.between;
    waiting_.emplace(*number, std::move(waiting));
}

void Requests::update()
{
    std::vector<std::pair<Then, Result<Reply>>> done;
    caller_.take(
        [&](std::uint64_t number, Reply reply)
        {
            const auto at = waiting_.find(number);
            if (at == waiting_.end()) return;
            reply.repeated = false;  // that this class repeats requests is its own affair
            done.emplace_back(std::move(at->second.then), std::move(reply));
            waiting_.erase(at);
        });
    const auto now = Clock::now();
    for (auto at = waiting_.begin(); at != waiting_.end();)
    {
        Waiting& waiting = at->second;
        if (now >= waiting.end)
        {
            done.emplace_back(std::move(waiting.then), reason("the server has not answered within 30 s; whether it did this is unknown"));
            at = waiting_.erase(at);
            continue;
        }
        if (now >= waiting.next)
        {
            (void)caller_.send_again(waiting.request, at->first);
            waiting.between = std::min(2 * waiting.between, kMostBetween);
            waiting.next = now + waiting.between;
        }
        ++at;
    }
    for (auto& [then, reply] : done) then(reply);
}

void Requests::give_up(const std::string& why)
{
    for (auto& [number, waiting] : std::exchange(waiting_, {})) waiting.then(reason(why));
}

}  // namespace plab::link
