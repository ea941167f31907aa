/// What compiling a blueprint may take.
#pragma once

#include <cstddef>
#include <string>

namespace plab::model
{

struct CompileLimits
{
    /// Of a scene, generated ones among them: 100,000 bodies take 0.5 GB. Where counts come in (<repeat>, files, requests)
    /// this is what keeps a slip of the hand from filling the memory.
    std::size_t components = 100'000;
    std::string raised_by;     ///< what a user would write to raise it ("--max-components N"), for the message; may be empty
    std::size_t errors = 100;  ///< reported at once; the rest are counted
};

}  // namespace plab::model
