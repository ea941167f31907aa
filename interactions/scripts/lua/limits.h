/// The resource limits of one script.
#pragma once

#include <cstddef>
#include <cstdint>

namespace plab::scripts
{

struct Limits
{
    std::int64_t instructions = 0;  ///< per call
    std::size_t memory = 0;         ///< bytes
};

}  // namespace plab::scripts
