/// Identifies the writer of `plab/server`: a simulation, or the player of a recording. Both obey the rule that a server name is
/// unique.
#pragma once

#include <cstdint>
#include <string>

#include "idl/plab.h"
#include "idl/values/values.h"

namespace plab::wire
{

/// The identity of a server, apart from its status.
struct Identity
{
    std::string name, version, host;
    std::int32_t process = 0;
    std::int64_t started_ns = 0;  ///< since 1970
};

/// The identity of this process, starting now.
Identity identify(const std::string& name, const std::string& version);

/// Fills in what a server says of itself with every status.
void sign(Server& server, const Identity& identity);

/// Whether `other` is another server with this name, and may keep it: it started earlier, or at the same time and is first by
/// host and process.
bool keeps_the_name(const plab_v2_Server& other, const Identity& self);

}  // namespace plab::wire
