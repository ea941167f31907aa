/// Limits for compiling a blueprint.
#pragma once

#include <cstddef>
#include <string>

namespace plab::model
{

struct CompileLimits
{
    /// Components of a scene, generated ones included: 100,000 bodies take 0.5 GB. Where counts are involved (<repeat>, files,
    /// requests), this keeps a typing error from exhausting the memory.
    std::size_t components = 100'000;
    std::string raised_by;     ///< how a user can raise the limit ("--max-components N"), for the message; may be empty
    std::size_t errors = 100;  ///< number of reported errors; the rest are counted
};

}  // namespace plab::model
