/// Packets of discovery that nobody should send: plab-bus ends of some of them, the run does not.
#pragma once

#include <cstdint>

namespace plab::test
{

/// Sends so many changed packets, one each `pause_us` (us), to a server that counts hashes, and compares those with a run that nobody
/// disturbs.
void attack(std::uint64_t packets, std::uint64_t seed, unsigned pause_us);

}  // namespace plab::test
