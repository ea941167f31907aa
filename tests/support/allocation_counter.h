/// Counts the calls of operator new in a test program that is linked with allocation_counter.cpp.
#pragma once

#include <atomic>

namespace plab::test
{

extern std::atomic<long> allocations;

}  // namespace plab::test
