// A warm evaluation allocates no memory.
#include "support/allocation_counter.h"
#include "train.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("a warm evaluation with graph, pairs and drives allocates nothing")
{
    Train t;
    for (int i = 0; i < 6; ++i) t.add_shaft(1 + i);
    CouplingTable assign("Assign"), impulse("Impulse"), gears("Graph");
    assign.add(0, 0, 1, 2), gears.add(1, 1, 2, -1), impulse.add(2, 2, 3, 0.5), impulse.add(3, 4, 5, 3);
    REQUIRE(assign.prepare().ok());
    REQUIRE(impulse.prepare().ok());
    REQUIRE(gears.prepare().ok());
    gears.connect(t.graph);
    t.build();
    const std::vector<double> torque = {1, 2, 3, 4, 5, 6};
    std::vector<double> work(4, 0.0);
    const auto evaluate = [&]
    {
        const auto couple = [&]
        {
            assign.couple(t.coupling);
            impulse.couple(t.coupling);
        };
        t.graph.derive(t.shafts);
        t.begin_accelerations(torque);
        t.coupling.solve(couple);
        t.coupling.account(work, 0.1);
        t.react();
        t.shafts.speed[1] += 1;
        t.graph.engage(t.shafts, &work);
        t.begin_speeds();
        t.coupling.solve(couple);
        t.coupling.store_speeds(t.shafts);
    };
    evaluate();
    const long before = allocations;
    for (int i = 0; i < 10; ++i) evaluate();
    CHECK(allocations == before);
    CHECK(before > 0);
}
