/// Joining the bus. This host only unless told otherwise.
#pragma once

#include <cstdint>
#include <string>

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

/// A participant in the domain. CYCLONEDDS_URI, where it is set, wins over `network_interface` and over the default.
/// Errors name what could not be used (an interface that does not exist, a broken configuration).
Result<Entity> join(const DomainOptions& options);

/// Options that PLAB_DOMAIN and PLAB_INTERFACE stand for, where they are set.
Result<DomainOptions> domain_from_environment();

}  // namespace plab::wire
