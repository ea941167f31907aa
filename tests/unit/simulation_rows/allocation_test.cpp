// A warm evaluation allocates no memory. This file counts allocations for the whole test program.
#include <atomic>
#include <cstdlib>
#include <new>

#include "mechanism.h"

namespace
{
std::atomic<long> allocations{0};
}

void* operator new(std::size_t n)
{
    ++allocations;
    if (void* p = std::malloc(n == 0 ? 1 : n)) return p;
    throw std::bad_alloc();
}
void* operator new(std::size_t n, const std::nothrow_t&) noexcept
{
    ++allocations;
    return std::malloc(n == 0 ? 1 : n);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

using namespace plab;
using namespace plab::test;

TEST_CASE("warm evaluations and projections allocate nothing")
{
    Mechanism m;
    Ref before = kWorld;
    for (int i = 0; i < 5; ++i)
    {
        const Ref link = m.body(1, {.1, .1, .1}, {.5 + i, 0, 0});
        m.hinge(before, link, {double(i), 0, 0}, {0, 1, 0});
        before = link;
    }
    m.ball(kWorld, before, {5, 0, 0});
    m.build();
    m.run(.01, 1e-3);
    const long now = allocations;
    for (int i = 0; i < 10; ++i)
    {
        m.evaluate();
        m.host.bodies.position[2].z += 1e-7;
        const auto report = m.rows.project(StepContext{});
        CHECK(report.converged);
    }
    CHECK(allocations == now);
}
