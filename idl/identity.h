/// Who writes `plab/server`: a simulation, or the player of a recording. Both keep to one server for each name.
#pragma once

#include <cstdint>
#include <string>

#include "idl/plab.h"

namespace plab::wire
{

/// What a server says of itself beside its status.
struct Identity
{
    std::string name, version, host;
    std::int32_t process = 0;
    std::int64_t started_ns = 0;  ///< since 1970
};

/// Of this process, which starts now.
Identity identify(const std::string& name, const std::string& version);

/// Whether `other` is another server of this name, and may keep it: it started earlier, or at the same time and comes
/// first by host and process.
bool keeps_the_name(const plab_v2_Server& other, const Identity& self);

}  // namespace plab::wire
