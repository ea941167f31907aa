/// Servers that come and go: for programs that run on while there is none.
#pragma once

#include <functional>

#include "link/session.h"

namespace plab::link
{

struct FollowHandler
{
    /// There is no server, `why` in a sentence; called several times a second, until there is one.
    std::function<void(const std::string& why)> wait;
    /// A server is there; returns when it has gone. An error: it could not be used, and is looked for again.
    std::function<Result<void>(const Session& session)> serve;
};

/// Returns when `stop` does. The handler may change the server's name in `options` while there is none: then that one is looked for.
void follow_servers(const SessionOptions& options, const Stop& stop, const FollowHandler& handler);

}  // namespace plab::link
