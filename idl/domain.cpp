#include "idl/domain.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>

namespace plab::wire
{
namespace
{

// Domains 0 to 232 have ports below 65536.
constexpr std::uint32_t kLastDomain = 232;

bool is_interface_name(const std::string& name)
{
    return !name.empty() && name.size() < 64 && name.find_first_of("\"'<>&/ \t\n") == std::string::npos;
}

Error not_joined(const DomainOptions& options, dds_return_t code)
{
    std::string why = "cannot join DDS domain " + std::to_string(options.id);
    if (std::getenv("CYCLONEDDS_URI") != nullptr)
        why += " with the configuration in CYCLONEDDS_URI";
    else
        why += " on interface " + (options.network_interface.empty() ? std::string("lo") : options.network_interface);
    return reason(why + ": " + dds_strretcode(code) + " (see the message of Cyclone DDS on standard error)");
}

/// Domains that this process has opened with a configuration of its own, and the number of participants in each.
class OpenDomains
{
public:
    static OpenDomains& instance()
    {
        // Never destroyed: a process that calls exit() with open participants leaves them to the system.
        static OpenDomains& domains = *new OpenDomains;
        return domains;
    }

    /// The error of Cyclone DDS if it cannot open the domain; 0 or more: the domain is counted.
    dds_return_t enter(const DomainOptions& options)
    {
        const std::lock_guard guard(mutex_);
        const auto known = open_.find(options.id);
        if (known != open_.end()) return static_cast<dds_return_t>(++known->second.participants);
        const dds_entity_t domain = dds_create_domain(options.id, configuration_of(options).c_str());
        if (domain > 0) open_.emplace(options.id, OpenDomain{Entity(domain), 1});
        return domain;
    }
    void leave(std::uint32_t id)
    {
        const std::lock_guard guard(mutex_);
        const auto known = open_.find(id);
        if (known != open_.end() && --known->second.participants == 0) open_.erase(known);
    }

private:
    struct OpenDomain
    {
        Entity entity;
        int participants = 0;
    };
    std::mutex mutex_;
    std::map<std::uint32_t, OpenDomain> open_;
};

}  // namespace

Participant& Participant::operator=(Participant&& other) noexcept
{
    if (this != &other) reset(), entity_ = std::move(other.entity_), domain_ = std::exchange(other.domain_, {});
    return *this;
}

void Participant::reset()
{
    entity_.reset();
    if (domain_) OpenDomains::instance().leave(*std::exchange(domain_, {}));
}

std::string configuration_of(const DomainOptions& options)
{
    // Big datagrams double the throughput on loopback, whose MTU is 65536. On a real network with an MTU of 1500, one lost packet
    // of such a datagram would lose all of its 44, so there Cyclone's own sizes stay (fragments of 1344 bytes, 14720 in a datagram).
    // A frame of 10,000 bodies has 1.1 MB, more than Cyclone's receive buffer of 1 MB holds: what does not fit is sent again. Only
    // the maximum is given, so a kernel that allows less (net.core.rmem_max) gives what it allows.
    // On loopback every participant announces itself every 2 s: with Cyclone's own interval, one whose first announcement is lost
    // stays unseen for 8 s.
    std::string general, discovery;
    if (options.network_interface.empty())
    {
        general =
            "<Interfaces><NetworkInterface name=\"lo\" multicast=\"false\"/></Interfaces><AllowMulticast>false</AllowMulticast>"
            "<MaxMessageSize>65500B</MaxMessageSize><FragmentSize>65000B</FragmentSize>";
        discovery = "<SPDPInterval>2s</SPDPInterval><Peers><Peer address=\"127.0.0.1\"/></Peers>";
    }
    else
        general = "<Interfaces><NetworkInterface name=\"" + options.network_interface + "\"/></Interfaces>";
    return "<CycloneDDS><Domain><General>" + general +
           "</General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>120</MaxAutoParticipantIndex>" +
           discovery +
           "</Discovery><Internal><SocketReceiveBufferSize max=\"4MB\"/><WriterLingerDuration>100ms</WriterLingerDuration></Internal>"
           "</Domain></CycloneDDS>";
}

Result<Participant> join(const DomainOptions& options)
{
    if (options.id > kLastDomain) return reason("a DDS domain must be from 0 to 232, not " + std::to_string(options.id));
    if (!options.network_interface.empty() && !is_interface_name(options.network_interface))
        return reason("'" + options.network_interface + "' is not the name of a network interface");
    std::optional<std::uint32_t> counted;
    if (const char* const own = std::getenv("CYCLONEDDS_URI"); own == nullptr || *own == 0)
    {
        const dds_return_t entered = OpenDomains::instance().enter(options);
        // Other code in this process may have opened it.
        if (entered < 0 && entered != DDS_RETCODE_PRECONDITION_NOT_MET) return not_joined(options, entered);
        if (entered > 0) counted = options.id;
    }
    const dds_entity_t participant = dds_create_participant(options.id, nullptr, nullptr);
    Participant out(Entity(std::max(participant, 0)), counted);
    if (participant < 0) return not_joined(options, participant);
    return out;
}

Result<DomainOptions> domain_from_environment()
{
    DomainOptions options;
    if (const char* text = std::getenv("PLAB_DOMAIN"); text != nullptr && *text != 0)
    {
        const char* const end = text + std::strlen(text);
        const auto [stop, error] = std::from_chars(text, end, options.id);
        if (error != std::errc() || stop != end || options.id > kLastDomain)
            return reason(std::string("PLAB_DOMAIN must be a number from 0 to 232, not '") + text + "'");
    }
    if (const char* text = std::getenv("PLAB_INTERFACE"); text != nullptr) options.network_interface = text;
    return options;
}

}  // namespace plab::wire
