// What a step costs and leaves behind: no memory is asked for once warm, every figure is finite, every command ran.
#include <algorithm>
#include <cmath>

#include "subjects.h"
#include "support/allocation_counter.h"

using namespace plab;
using namespace plab::test;

namespace
{

bool all_finite(const Value& value)
{
    if (const auto* x = std::get_if<double>(&value)) return std::isfinite(*x);
    if (const auto* v = std::get_if<Vec3>(&value)) return is_finite(*v);
    if (const auto* q = std::get_if<Quat>(&value)) return is_finite(*q);
    if (const auto* m = std::get_if<Mat3>(&value)) return is_finite(*m * Vec3{1, 1, 1});
    bool fine = true;
    if (const auto* list = std::get_if<Reals>(&value))
        for (const double x : *list) fine = fine && std::isfinite(x);
    if (const auto* entries = std::get_if<Entries>(&value))
        for (const Entry& e : *entries)
            if (const auto* x = std::get_if<double>(&e.value)) fine = fine && std::isfinite(*x);
    return fine;
}

void check_finite(const world::World& world)
{
    for (const std::uint32_t i : world.in_id_order())
    {
        if (!world.type_of(i)) continue;
        for (const Field& field : world.type_of(i)->schema.fields())
            if (field.kind != FieldKind::Scratch && !field.may_be_infinite)
                CHECK_MESSAGE(all_finite(world.get(i, field.name)), world.id_of(i), ".", field.name, " is not finite");
    }
}

/// The scene gave the type's commands of each timed phase something to do.
void check_ran(const simulation::Simulation& simulation, const std::string& type)
{
    const auto& tables = simulation.world().tables();
    for (std::size_t t = 0; t < tables.size(); ++t)
    {
        if (tables[t]->type().info.name != type) continue;
        for (const Phase phase : {Phase::Drive, Phase::Force, Phase::Detect, Phase::Respond, Phase::Finish})
        {
            const auto& commands = tables[t]->type().info.commands;
            const bool has = std::any_of(commands.begin(), commands.end(), [&](const CommandInfo& c) { return c.phase == phase && c.run; });
            const bool ran = (simulation.stepper().meter().accounts().phases[t] >> static_cast<unsigned>(phase) & 1u) != 0;
            CHECK_MESSAGE((!has || ran), "the scene never runs the phase ", std::string(name_of(phase)));
        }
    }
}

/// Sweeps do not get there at once, and say so.
void check_events(const simulation::Simulation& simulation, bool sweeps)
{
    for (const Event& e : simulation.events())
    {
        const bool may = e.severity == Severity::Info || (sweeps && e.kind == "manager.not_converged");
        CHECK_MESSAGE(may, e.kind, ": ", e.message);
        CHECK(std::isfinite(e.time));
        const bool may_be_unknown = e.kind == "level.changed";  // NaN: a figure that nothing tells
        for (const double x : e.values) CHECK_MESSAGE((std::isfinite(x) || (may_be_unknown && std::isnan(x))), e.kind, ": ", e.message);
    }
}

}  // namespace

TEST_CASE("a warm step in which nothing happens asks for no memory")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        const long loading = allocations;
        const auto running = started(compiled(subject.blueprint));
        CHECK_MESSAGE(allocations > loading, "allocations are not counted");
        // What rolls to rest may touch in more places than before for some seconds.
        for (int i = 0; i < 1000; ++i) running->step();
        int quiet = 0;
        for (int i = 0; i < 500; ++i)
        {
            const long before = allocations;
            running->step();
            const long made = allocations - before;
            if (!running->events().empty()) continue;
            ++quiet;
            CAPTURE(i);
            REQUIRE(made == 0);
        }
        CHECK_MESSAGE(quiet > 0, "something happens in every step of the scene: let it come to rest");
    }
}

TEST_CASE("every figure stays finite, and no warning is reported")
{
    for (const Subject& subject : subjects())
    {
        CAPTURE(subject.type);
        const auto running = started(compiled(subject.blueprint));
        check_finite(running->world());
        for (int i = 0; i < 300; ++i)
        {
            running->step();
            check_events(*running, subject.type == "Manager/SequentialImpulse");
            if (i % 10 == 0) check_finite(running->world());
        }
        check_ran(*running, subject.type);
        const simulation::Totals totals = running->totals();
        for (const double x : {totals.kinetic, totals.stored, totals.work, totals.shaft_momentum}) CHECK(std::isfinite(x));
        CHECK(is_finite(totals.momentum));
        CHECK(is_finite(totals.angular_momentum));
    }
}
