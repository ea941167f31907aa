#include "hostile_packets.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <mutex>

namespace
{

constexpr std::size_t kMost = 4000, kHeader = 20;  // bytes of an RTPS header: "RTPS", version, vendor, 12 of the sender

std::mutex& mutex()
{
    static std::mutex m;
    return m;
}
std::vector<plab::test::Packet>& sent()
{
    static std::vector<plab::test::Packet> packets;
    return packets;
}

/// Of unicast ports 7400 + 250 d + 10 + 2 i the even ones are for discovery.
bool is_discovery_port(unsigned port) { return port >= 7410 && (port - 7400) % 250 >= 10 && port % 2 == 0; }

void note(const msghdr& message)
{
    if (message.msg_name == nullptr || static_cast<const sockaddr*>(message.msg_name)->sa_family != AF_INET) return;
    sockaddr_in to{};
    std::memcpy(&to, message.msg_name, sizeof to);
    if (!is_discovery_port(ntohs(to.sin_port))) return;
    plab::test::Packet packet;
    for (std::size_t i = 0; i < message.msg_iovlen; ++i)
    {
        const auto* bytes = static_cast<const std::uint8_t*>(message.msg_iov[i].iov_base);
        packet.insert(packet.end(), bytes, bytes + message.msg_iov[i].iov_len);
    }
    if (packet.size() <= kHeader || std::memcmp(packet.data(), "RTPS", 4) != 0) return;
    const std::lock_guard guard(mutex());
    if (sent().size() < kMost && std::find(sent().begin(), sent().end(), packet) == sent().end()) sent().push_back(std::move(packet));
}

}  // namespace

/// In place of the C library's, for Cyclone in this process too.
extern "C" __attribute__((visibility("default"))) ssize_t sendmsg(int fd, const msghdr* message, int flags)
{
    note(*message);
    return syscall(SYS_sendmsg, fd, message, flags);
}

namespace plab::test
{

std::vector<Packet> sent_for_discovery()
{
    const std::lock_guard guard(mutex());
    return sent();
}

namespace
{

constexpr std::uint16_t kTypeInformation = 0x75, kParticipantGuid = 0x50, kSentinel = 1;

std::uint16_t word16(const Packet& p, std::size_t at) { return static_cast<std::uint16_t>(p[at] | p[at + 1] << 8); }
void put16(Packet& p, std::size_t at, std::size_t value)
{
    p[at] = static_cast<std::uint8_t>(value), p[at + 1] = static_cast<std::uint8_t>(value >> 8);
}

/// A parameter of a DATA message (little-endian, as this machine sends it).
struct Parameter
{
    std::size_t message = 0, at = 0, length = 0;  ///< where its message begins, and itself; length without its head of 4 bytes
    std::uint16_t id = 0;
};

std::vector<Parameter> parameters_in(const Packet& p)
{
    constexpr std::uint8_t kData = 0x15;
    constexpr std::size_t kBeforeParameters = 4 + 20 + 4;  // head of the message; ids and number; encapsulation
    std::vector<Parameter> out;
    for (std::size_t message = kHeader; message + 4 <= p.size();)
    {
        const std::size_t length = word16(p, message + 2), end = length == 0 ? p.size() : std::min(message + 4 + length, p.size());
        for (std::size_t at = message + kBeforeParameters; p[message] == kData && at + 4 <= end;)
        {
            const Parameter parameter{message, at, word16(p, at + 2), word16(p, at)};
            at += 4 + parameter.length;
            if (parameter.id == kSentinel || at > end) break;
            out.push_back(parameter);
        }
        message = end;
    }
    return out;
}

}  // namespace

PacketMutator::PacketMutator(std::vector<Packet> good, std::uint64_t seed) : random_(seed), good_(std::move(good))
{
    for (const Packet& p : good_)
        for (const Parameter& parameter : parameters_in(p))
        {
            const auto begin = p.begin() + static_cast<std::ptrdiff_t>(parameter.at);
            if (parameter.id == kTypeInformation) types_.emplace_back(begin, begin + 4 + static_cast<std::ptrdiff_t>(parameter.length));
            if (parameter.id == kParticipantGuid) announcements_.push_back(p);
        }
}

Packet PacketMutator::next()
{
    if (types_.empty() || announcements_.empty() || below(2) == 0) return changed(good_[below(good_.size())]);
    return with_broken_type();
}

/// A participant that is not known yet, so its announcement is new.
void PacketMutator::take_another_sender(Packet& p)
{
    for (std::size_t i = 12; i < kHeader; ++i) p[i] = byte();
}

Packet PacketMutator::with_broken_type()
{
    Packet p = announcements_[below(announcements_.size())], type = types_[below(types_.size())];
    for (std::size_t n = 1 + below(3); n > 0; --n) change_once(type, 4);
    type.resize((type.size() + 3) / 4 * 4);
    put16(type, 2, type.size() - 4);
    const auto parameters = parameters_in(p);
    const Parameter before = parameters[below(parameters.size())];
    p.insert(p.begin() + static_cast<std::ptrdiff_t>(before.at), type.begin(), type.end());
    if (const std::size_t length = word16(p, before.message + 2); length > 0) put16(p, before.message + 2, length + type.size());
    take_another_sender(p);
    return p;
}

Packet PacketMutator::changed(Packet p)
{
    if (below(8) != 0) take_another_sender(p);
    for (std::size_t n = 1 + below(4); n > 0; --n) change_once(p, kHeader);
    return p;
}

/// The bytes before `begin` are not changed, nor are the 8 bytes after it.
void PacketMutator::change_once(Packet& p, std::size_t begin)
{
    if (p.size() < begin + 8) return;
    const std::size_t any = begin + below(p.size() - begin);
    const std::size_t at = begin + 4 * below((p.size() - begin) / 4);  // parameters begin at multiples of four
    const auto put = [&](std::uint32_t value, std::size_t size) { std::memcpy(&p[at], &value, std::min(size, p.size() - at)); };
    constexpr std::uint32_t kIds[] = {kTypeInformation, 0x05, 0x07, 0x70, 0x71, 0x77, 0x1014, 0x34, 0x29, 0x1001, 0x8001, kSentinel};
    const std::uint32_t lengths[] = {0, 1, 2, 3, 4, 8, 16, 0x7fff, 0xffff, 0x7fffffff, 0xffffffff, static_cast<std::uint32_t>(below(256))};
    switch (below(8))
    {
        case 0:
            p[any] = byte();
            break;
        case 1:
            p[any] ^= static_cast<std::uint8_t>(1u << below(8));
            break;
        case 2:
            put(kIds[below(std::size(kIds))], 2);
            break;
        case 3:
            put(lengths[below(std::size(lengths))], below(2) == 0 ? 2 : 4);
            break;
        case 4:
            p.resize(begin + 8 + below(p.size() - begin - 8));
            break;
        case 5:  // a piece of another packet
        {
            const std::size_t from = begin + 4 * below((p.size() - begin) / 4);
            std::memmove(&p[at], &p[from], std::min({4 * (1 + below(16)), p.size() - from, p.size() - at}));
            break;
        }
        case 6:
            p.insert(p.begin() + static_cast<std::ptrdiff_t>(at), 4 * (1 + below(8)), byte());
            break;
        default:
            for (std::size_t i = at; i < std::min(at + 4, p.size()); ++i) p[i] = byte();
    }
}

PacketSender::PacketSender(std::uint32_t domain) : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)), base_(7400 + 250 * domain + 10)
{
}

PacketSender::~PacketSender()
{
    if (socket_ >= 0) (void)close(socket_);
}

void PacketSender::send(const Packet& packet, unsigned index) const
{
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(base_ + 2 * index));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)sendto(socket_, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

}  // namespace plab::test
