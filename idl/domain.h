/// Joins the bus; by default on this host only.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "idl/entity.h"
#include "plab/result.h"

namespace plab::wire
{

struct DomainOptions
{
    std::uint32_t id = 0;
    std::string network_interface;  ///< empty: loopback, no multicast
};

/// The Cyclone DDS configuration for these options.
std::string configuration_of(const DomainOptions& options);

/// A participant, and this process's share in its domain: when the last participant is destroyed, the domain is closed with its
/// sockets and threads.
class Participant
{
public:
    Participant() = default;
    /// `domain`: as join() counted it; none if CYCLONEDDS_URI configured the domain, which Cyclone then closes by itself.
    Participant(Entity entity, std::optional<std::uint32_t> domain) : entity_(std::move(entity)), domain_(domain) {}
    Participant(Participant&& other) noexcept : entity_(std::move(other.entity_)), domain_(std::exchange(other.domain_, {})) {}
    Participant& operator=(Participant&& other) noexcept;
    Participant(const Participant&) = delete;
    Participant& operator=(const Participant&) = delete;
    ~Participant() { reset(); }

    operator const Entity&() const { return entity_; }
    dds_entity_t get() const { return entity_.get(); }
    bool valid() const { return entity_.valid(); }
    void reset();

private:
    Entity entity_;
    std::optional<std::uint32_t> domain_;
};

/// A participant in the domain. CYCLONEDDS_URI, if set, overrides `network_interface` and the default. Errors name what could
/// not be used (an interface that does not exist, an invalid configuration).
Result<Participant> join(const DomainOptions& options);

/// The options given by PLAB_DOMAIN and PLAB_INTERFACE, if set.
Result<DomainOptions> domain_from_environment();

}  // namespace plab::wire
