// What managers tell of steps that did not converge.
#include <set>

#include "managers/manager_rows.h"
#include "support/one_row.h"

using namespace plab;
using namespace plab::managers;

namespace
{

struct Kept final : EventSink
{
    std::vector<Tick> ticks;
    void emit(Event e) override
    {
        CHECK(e.kind == "manager.not_converged");
        ticks.push_back(e.tick);
    }
};

}  // namespace

TEST_CASE("a manager tells of the first failure after half a second without one")
{
    test::OneRow<SoftStepRows> manager;
    Kept kept;
    // At 1/100 s: twice on end, again after 0.2 s, then after 0.5 s and after 0.6 s, in one of two islands.
    const std::set<Tick> failures{10, 11, 31, 81, 141};
    for (Tick tick = 0; tick < 200; ++tick)
    {
        StepContext context;
        context.tick = tick, context.dt = 0.01, context.events = &kept;
        Island fine, failed;
        fine.h = failed.h = context.dt, fine.size = failed.size = 1;
        failed.residual = 1, failed.converged = !failures.contains(tick);
        manager.rows.account.add(context, 0, fine, 0.1);
        manager.rows.account.add(context, 0, failed, 0.1);
        CHECK((manager.rows.account.last_failure[0] == tick) == failures.contains(tick));
    }
    CHECK(kept.ticks == std::vector<Tick>{10, 141});
}
