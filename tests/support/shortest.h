/// The time that a small piece of code takes at best.
#pragma once

#include <algorithm>
#include <chrono>

// Comparisons of times mean something only where the compiler optimises and nothing instruments the code.
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PLAB_TIMES_MEAN_SOMETHING 1
#endif

namespace plab::test
{

/// The shortest time of 60, in s: whatever else runs on the machine only makes times longer.
template <class F>
double shortest(const F& f)
{
    double best = 1e9;
    for (int i = 0; i < 60; ++i)
    {
        const auto start = std::chrono::steady_clock::now();
        f();
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

}  // namespace plab::test
