/// Calls of operator new in this process; only programs that link allocations.cpp count them.
#pragma once

#include <cstdint>

namespace plab::study
{

std::uint64_t allocations();

}  // namespace plab::study
