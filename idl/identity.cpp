#include "idl/identity.h"

#include <unistd.h>

#include <array>
#include <chrono>
#include <string_view>
#include <tuple>

namespace plab::wire
{

Identity identify(const std::string& name, const std::string& version)
{
    std::array<char, 256> host{};
    (void)gethostname(host.data(), host.size() - 1);
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return {name, version, host.data(), getpid(), std::chrono::duration_cast<std::chrono::nanoseconds>(now).count()};
}

void sign(Server& server, const Identity& identity)
{
    server.name = identity.name, server.version = identity.version, server.host = identity.host;
    server.process = identity.process, server.started_ns = identity.started_ns;
}

bool keeps_the_name(const plab_v2_Server& other, const Identity& self)
{
    if (other.started_ns <= 0 || other.host == nullptr || other.name == nullptr || self.name != other.name) return false;
    const auto order = [](std::int64_t started, std::string_view host, std::int32_t process) { return std::tuple(started, host, process); };
    return order(other.started_ns, other.host, other.process) < order(self.started_ns, self.host, self.process);
}

}  // namespace plab::wire
