#include "idl/name_lock.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

namespace plab::wire
{
namespace
{

struct Address
{
    sockaddr_un name{};
    socklen_t length = 0;
    const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&name); }
};

/// A name that begins with a zero byte is not a file (abstract socket).
Address address_of(std::uint32_t domain, const std::string& server)
{
    Address address;
    address.name.sun_family = AF_UNIX;
    const std::string path = std::string(1, '\0') + "plab/" + std::to_string(domain) + "/" + server;
    const std::size_t length = std::min(path.size(), sizeof address.name.sun_path);
    std::memcpy(address.name.sun_path, path.data(), length);
    address.length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length);
    return address;
}

/// A socket type that can report the listening process: connection-oriented, with packets. Datagram sockets cannot.
int make_socket() { return socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0); }

/// The process that listens there; 0 if it cannot be determined.
int holder_of(const Address& address)
{
    const int fd = make_socket();
    if (fd < 0) return 0;
    ucred peer{};
    socklen_t length = sizeof peer;
    const bool known = connect(fd, address.get(), address.length) == 0 && getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &length) == 0;
    (void)close(fd);
    return known ? peer.pid : 0;
}

}  // namespace

Result<NameLock> NameLock::take(std::uint32_t domain, const std::string& name)
{
    // Connections are never accepted. Once the queue is full, further clients do not learn the process id.
    constexpr int kQueue = 128;
    NameLock lock(make_socket());
    if (lock.socket_ < 0) return reason(std::string("cannot reserve the server's name: ") + std::strerror(errno));
    const Address address = address_of(domain, name);
    if (bind(lock.socket_, address.get(), address.length) == 0)
    {
        if (listen(lock.socket_, kQueue) == 0) return lock;
        return reason(std::string("cannot reserve the server's name: ") + std::strerror(errno));
    }
    if (errno != EADDRINUSE) return reason(std::string("cannot reserve the server's name: ") + std::strerror(errno));
    const int pid = holder_of(address);
    return reason("a server '" + name + "' is already running on this host in domain " + std::to_string(domain) +
                  (pid > 0 ? " (process " + std::to_string(pid) + ")" : "") + ": give this one another name");
}

NameLock::~NameLock()
{
    if (socket_ >= 0) (void)close(socket_);
}

}  // namespace plab::wire
