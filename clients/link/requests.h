/// Requests that wait for the server's reply. None of them blocks: each is sent again until it is answered, which the server
/// carries out once.
#pragma once

#include <chrono>
#include <functional>
#include <map>

#include "link/caller.h"

namespace plab::link
{

class Requests
{
public:
    static constexpr std::size_t kMost = 128;
    /// The reply, or why there is none.
    using Then = std::function<void(const Result<Reply>&)>;

    explicit Requests(Caller caller) : caller_(std::move(caller)) {}

    /// `then` is called by update(), or at once if it cannot be sent.
    void send(Request request, Then then);
    /// Hands out replies, sends again what was not answered, and gives up what takes too long.
    void update();
    /// There will be no replies.
    void give_up(const std::string& why);

private:
    using Clock = std::chrono::steady_clock;
    struct Waiting
    {
        Request request;
        Then then;
        Clock::time_point next, end;
        std::chrono::milliseconds between{20};
    };

    Caller caller_;
    std::map<std::uint64_t, Waiting> waiting_;
};

}  // namespace plab::link
