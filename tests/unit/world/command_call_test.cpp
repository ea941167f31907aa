// Calls of commands: which rows they get and whose they are, the first failure, and to what their time is booked.
#include "world/command_call.h"

#include <chrono>

#include "simulation/costs/measured_call.h"
#include "support/scene.h"

using namespace plab;

namespace
{

struct CalledRows
{
    Column<double> owner, calls, limit;

    void describe(Schema& s)
    {
        s.param(limit, "limit", unit::one, "number of calls that succeed").or_else(100);
        s.state(owner, "owner", unit::one, "component, as the call has it").initially(-1);
        s.state(calls, "calls", unit::one, "number of calls").initially(0);
    }
};

Result<void> count_calls(const StepContext& context, Rows rows, CalledRows& table)
{
    for (const Row row : rows)
    {
        table.owner[row] = context.component_of_row[row];
        if (++table.calls[row] > table.limit[row]) return reason("called too often");
    }
    return {};
}

void spend_time(const StepContext&, Rows rows, CalledRows& table)
{
    const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(200);
    while (std::chrono::steady_clock::now() < end) continue;
    for (const Row row : rows) table.calls[row] += 10;
}

/// Two rows, of the components 4 and 2.
struct CalledTable
{
    CalledTable()
    {
        Registrar registrar;
        registrar.component<CalledRows>("Thing/Called", "counts its calls")
            .command<count_calls>(Phase::Finish, "Thing/Count", "counts")
            .command<spend_time>(Phase::Finish, "Thing/Spend", "takes 0.2 ms");
        REQUIRE(types.add(std::move(registrar), "test").ok());
        table.emplace(*types.find("Thing/Called"));
        first = table->add(4, kNoIndex), second = table->add(2, kNoIndex);
    }
    CalledRows& rows() { return *static_cast<CalledRows*>(table->rows()); }
    const CommandInfo& command(std::size_t i) { return table->type().info.commands[i]; }

    model::TypeRegistry types;
    std::optional<world::Table> table;
    Row first = 0, second = 0;
};

}  // namespace

TEST_CASE("a call reaches the given rows only and knows their components")
{
    CalledTable called;
    world::CommandCall call;
    call.select(*called.table);
    CHECK(call.run(called.command(0), Rows(&called.second, 1)).ok());
    CHECK(called.rows().calls[called.first] == 0);
    CHECK(called.rows().calls[called.second] == 1);
    CHECK(called.rows().owner[called.second] == 2);
}

TEST_CASE("all commands of a phase run, until one fails")
{
    CalledTable called;
    called.rows().limit[called.second] = 0;
    world::CommandCall call;
    call.select(*called.table);
    CHECK(call.run(Phase::Finish, Rows(&called.first, 1)).ok());
    CHECK(called.rows().calls[called.first] == 11);
    const auto failed = call.run(Phase::Finish, Rows(&called.second, 1));
    REQUIRE_FALSE(failed.ok());
    CHECK(failed.error().reason == "called too often");
    CHECK(called.rows().calls[called.second] == 1);
    CHECK(call.run(Phase::Drive, Rows(&called.first, 1)).ok());
    CHECK(called.rows().calls[called.first] == 11);
}

TEST_CASE("the time of a call is booked to the type, or to each component")
{
    CalledTable called;
    const std::vector<Row> rows{called.first, called.second};
    const auto booked = [&](bool alone, std::uint32_t weight)
    {
        simulation::CostMeter meter;
        meter.accounts().fit(5, 1);
        world::CommandCall call;
        call.select(*called.table);
        meter.start();
        run_measured(call, {0, &called.command(1), rows, alone}, rows, meter, weight);
        meter.stop();
        CHECK(meter.accounts().phases[0] == 1u << static_cast<unsigned>(Phase::Finish));
        return meter.accounts();
    };
    constexpr std::int64_t kOneCall = 200'000;  // ns
    const simulation::CostAccounts by_type = booked(false, 1), alone = booked(true, 1), untimed = booked(false, 0),
                                   sampled = booked(false, 8);
    CHECK(by_type.by_table[0] >= kOneCall);
    CHECK(by_type.by_component == std::vector<std::int64_t>(5, 0));
    CHECK(alone.by_table[0] == 0);
    for (const std::size_t owner : {2, 4}) CHECK(alone.by_component[owner] >= kOneCall);
    CHECK(untimed.by_table[0] == 0);
    CHECK(untimed.host >= kOneCall);
    // One measured call of eight stands for the seven others, whose time is with the server's.
    CHECK(sampled.by_table[0] >= 8 * kOneCall);
    CHECK(sampled.host <= -6 * kOneCall);
}
