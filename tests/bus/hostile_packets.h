/// DDS discovery packets as this process sends them, and altered ones for other processes.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace plab::test
{

using Packet = std::vector<std::uint8_t>;

/// What this process has sent to discovery ports so far: announcements of participants, readers and writers with their types,
/// acknowledgements. Only sendmsg() is intercepted.
std::vector<Packet> sent_for_discovery();

/// Changed packets in any number: bytes, lengths, identifiers of parameters, ends are altered. Half of them announce a participant
/// with an invalid description of a type: Cyclone 0.10.2 aborts at some of these.
class PacketMutator
{
public:
    PacketMutator(std::vector<Packet> good, std::uint64_t seed);
    Packet next();
    /// Descriptions of types and announcements of participants among the good ones.
    std::size_t types() const { return types_.size(); }
    std::size_t announcements() const { return announcements_.size(); }

private:
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % (n > 0 ? n : 1)); }
    std::uint8_t byte() { return static_cast<std::uint8_t>(random_()); }
    void take_another_sender(Packet& packet);
    Packet changed(Packet packet);
    Packet with_broken_type();
    void change_once(Packet& packet, std::size_t begin);

    std::mt19937_64 random_;
    std::vector<Packet> good_, types_, announcements_;
};

/// Sends packets to the discovery ports of participants on this host.
class PacketSender
{
public:
    explicit PacketSender(std::uint32_t domain);
    ~PacketSender();
    PacketSender(const PacketSender&) = delete;
    PacketSender& operator=(const PacketSender&) = delete;
    /// To participant `index`: 0 is the first one that joined.
    void send(const Packet& packet, unsigned index) const;

private:
    int socket_ = -1;
    std::uint32_t base_ = 0;
};

}  // namespace plab::test
