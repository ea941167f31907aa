/// Invalid discovery packets: some of them end plab-bus, but not the run.
#pragma once

#include <cstdint>

namespace plab::test
{

/// Sends this number of changed packets, one each `pause_us` (us), to a server that counts hashes, and compares those with an
/// undisturbed run.
void attack(std::uint64_t packets, std::uint64_t seed, unsigned pause_us);

}  // namespace plab::test
