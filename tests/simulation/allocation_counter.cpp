// Counts calls of the allocator in this process: a warm step must make none.
#include <atomic>
#include <cstdlib>
#include <new>

std::atomic<long> plab_test_allocations{0};

void* operator new(std::size_t n)
{
    ++plab_test_allocations;
    if (void* p = std::malloc(n == 0 ? 1 : n)) return p;
    throw std::bad_alloc();
}
void* operator new[](std::size_t n) { return operator new(n); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
