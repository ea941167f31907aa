/// Joining the bus. This host only unless told otherwise.
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

/// The Cyclone DDS configuration that these options mean.
std::string configuration_of(const DomainOptions& options);

/// A participant, and this process's share in its domain: with the last one the domain is closed, sockets and threads with it.
class Participant
{
public:
    Participant() = default;
    /// `domain`: as join() counted it in; none where CYCLONEDDS_URI made the domain, which Cyclone closes by itself.
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

/// A participant in the domain. CYCLONEDDS_URI, where it is set, wins over `network_interface` and over the default.
/// Errors name what could not be used (an interface that does not exist, a broken configuration).
Result<Participant> join(const DomainOptions& options);

/// Options that PLAB_DOMAIN and PLAB_INTERFACE stand for, where they are set.
Result<DomainOptions> domain_from_environment();

}  // namespace plab::wire
