// Several islands in one call: each becomes what it would become alone, whatever the number of threads.
#include <cmath>

#include "islands.h"
#include "managers/manager_rows.h"
#include "plab/random.h"
#include "plab/shares.h"
#include "simulation/threads/worker_pool.h"
#include "support/one_row.h"

using namespace plab;
using namespace plab::managers;
using plab::test::IslandWorld;
using plab::test::OneRow;

namespace
{

/// Gravity on some bodies.
class PartMotion final : public IslandMotion
{
public:
    PartMotion(Bodies& bodies, std::span<const std::uint32_t> members) : bodies_(&bodies), members_(members) {}
    void kick(double h) override
    {
        for (const std::uint32_t b : members_) bodies_->velocity[b].z -= 9.81 * h;
    }
    void move(double h) override
    {
        for (const std::uint32_t b : members_)
        {
            bodies_->position[b] += bodies_->velocity[b] * h;
            bodies_->orientation[b] = normalized(exp_rotation(bodies_->angular_velocity[b] * h) * bodies_->orientation[b]);
            bodies_->refresh_spin(b);
        }
    }
    void move_mean(double h) override { move(h); }
    void refresh_rows() override {}
    bool put_rows_midway(double) override { return false; }
    void refresh_depths() override {}

private:
    Bodies* bodies_;
    std::span<const std::uint32_t> members_;
};

/// Stacks of 1 to 30 boxes with random speeds: islands of 4 to 120 points, the last one larger than all others together.
struct Stacks
{
    Stacks()
    {
        std::uint64_t seed = 5;
        for (const std::size_t boxes : {1u, 3u, 30u, 2u, 16u, 17u, 7u, 200u})
        {
            first_member.push_back(world.members.size()), first_contact.push_back(world.contacts.size());
            world.add_stack(std::vector<double>(boxes, 1 + next_uniform(seed)), 0.5);
        }
        first_member.push_back(world.members.size()), first_contact.push_back(world.contacts.size());
        const auto some = [&] { return next_uniform(seed) - 0.5; };
        for (const std::uint32_t b : world.members) world.bodies.velocity[b] = {some(), some(), some()};
        for (Contact& c : world.contacts)
        {
            c.depth = 1e-3 * some();
            if (next_uniform(seed) < 0.1) c.approach = 1, c.restitution = 0.5;
        }
    }
    std::size_t count() const { return first_member.size() - 1; }
    Island island(std::size_t i)
    {
        Island out;
        out.h = 1.0 / 60, out.size = 0.4;
        out.bodies = std::span(world.members).subspan(first_member[i], first_member[i + 1] - first_member[i]);
        out.contacts = std::span(world.contacts).subspan(first_contact[i], first_contact[i + 1] - first_contact[i]);
        return out;
    }

    IslandWorld world;
    std::vector<std::size_t> first_member, first_contact;
};

template <class Rows, class Solve>
void check_each_as_alone(const Solve& solve, Workers* workers)
{
    Stacks together, alone;
    std::vector<Island> islands;
    std::vector<PartMotion> motions;
    for (std::size_t i = 0; i < together.count(); ++i)
        islands.push_back(together.island(i)), motions.emplace_back(together.world.bodies, islands[i].bodies);
    for (std::size_t i = 0; i < islands.size(); ++i) islands[i].motion = &motions[i];
    StepContext context;
    context.workers = workers;
    OneRow<Rows> manager;
    solve(context, 0, manager.rows, together.world.bodies, together.world.shafts, islands);
    for (std::size_t i = 0; i < alone.count(); ++i)
    {
        CAPTURE(i);
        Island island = alone.island(i);
        PartMotion motion(alone.world.bodies, island.bodies);
        island.motion = &motion;
        OneRow<Rows> own;
        solve(StepContext{}, 0, own.rows, alone.world.bodies, alone.world.shafts, {&island, 1});
        CHECK(island.iterations == islands[i].iterations);
        CHECK(island.residual == islands[i].residual);
    }
    CHECK(together.world.bodies.position == alone.world.bodies.position);
    CHECK(together.world.bodies.velocity == alone.world.bodies.velocity);
    CHECK(together.world.bodies.angular_momentum == alone.world.bodies.angular_momentum);
    for (std::size_t i = 0; i < together.world.contacts.size(); ++i)
        CHECK(together.world.contacts[i].impulse == alone.world.contacts[i].impulse);
}

}  // namespace

TEST_CASE("an island becomes the same alone and with others, with 1, 2 and 5 threads")
{
    for (const int threads : {1, 2, 5})
    {
        CAPTURE(threads);
        simulation::WorkerPool pool(threads);
        check_each_as_alone<SoftStepRows>(solve_all_softly, &pool);
        check_each_as_alone<SequentialRows>(solve_all_sequentially, &pool);
        check_each_as_alone<DirectRows>(solve_all_directly, &pool);
        check_each_as_alone<AutomaticRows>(solve_all_automatically, &pool);
    }
}

TEST_CASE("what a manager reports of a step is summed over its islands in their order")
{
    Stacks stacks;
    std::vector<Island> islands;
    std::vector<PartMotion> motions;
    for (std::size_t i = 0; i < stacks.count(); ++i)
        islands.push_back(stacks.island(i)), motions.emplace_back(stacks.world.bodies, islands[i].bodies);
    for (std::size_t i = 0; i < islands.size(); ++i) islands[i].motion = &motions[i];
    struct Sink final : EventSink
    {
        void emit(Event event) override { events.push_back(std::move(event)); }
        std::vector<Event> events;
    } sink;
    StepContext context;
    context.events = &sink, context.tick = 3;
    OneRow<AutomaticRows> manager;
    solve_all_automatically(context, 0, manager.rows, stacks.world.bodies, stacks.world.shafts, islands);
    int iterations = 0;
    double residual = 0;
    for (const Island& i : islands) iterations += i.iterations, residual = std::max(residual, i.residual);
    CHECK(manager.rows.account.iterations[0] == iterations);
    CHECK(manager.rows.account.residual[0] == residual);
    CHECK(manager.rows.account.contacts[0] == static_cast<std::int64_t>(stacks.world.contacts.size()));
    CHECK(manager.rows.direct_islands[0] == 6);
    CHECK(manager.rows.soft_islands[0] == 2);
    CHECK(manager.rows.resolved[0] == "Direct, SoftStep");
}

TEST_CASE("shares: each job once; a large one has all threads, and a small one its own")
{
    for (const int threads : {1, 2, 7})
    {
        simulation::WorkerPool pool(threads);
        const std::vector<std::size_t> sizes{10, 5000, 1, 0, 300, 40, 7, 7, 200};
        std::vector<std::atomic<int>> done(sizes.size());
        std::atomic<int> inner{0};
        Shares shares;
        for (int call = 1; call <= 200; ++call)
        {
            shares.run(
                &pool, sizes.size(), 100, [&](std::size_t i) { return sizes[i]; }, [](std::size_t i) { return i != 4; },
                [&](std::size_t i)
                {
                    ++done[i];
                    // A job may divide its loops.
                    for_parts(&pool, 10, 1, [&](std::size_t, std::size_t) { ++inner; });
                });
            for (const auto& d : done) REQUIRE(d == call);
            REQUIRE(inner == 10 * call * static_cast<int>(sizes.size()));
        }
    }
}

TEST_CASE("sums of parts are added in the order of the parts")
{
    std::vector<double> numbers, sums;
    std::uint64_t seed = 1;
    for (int i = 0; i < 1000; ++i) numbers.push_back(std::exp(40 * next_uniform(seed)) * (i % 2 == 0 ? 1 : -1));
    const auto sum_with = [&](Workers* workers)
    {
        return sum_parts(workers, numbers.size(), 30, sums,
                         [&](std::size_t begin, std::size_t end)
                         {
                             double sum = 0;
                             for (std::size_t i = begin; i < end; ++i) sum += numbers[i];
                             return sum;
                         });
    };
    const double alone = sum_with(nullptr);
    for (const int threads : {2, 3, 16})
    {
        simulation::WorkerPool pool(threads);
        for (int i = 0; i < 50; ++i) CHECK(sum_with(&pool) == alone);
    }
}
