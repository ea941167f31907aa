// A warm evaluation allocates no memory.
#include "mechanism.h"
#include "support/allocation_counter.h"

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
