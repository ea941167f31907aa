#include "script.h"

#include <cassert>

namespace plab::scripts
{

void ScriptRows::describe(Schema& s)
{
    s.param(code, "code", unit::one, "Lua 5.4 text that defines drive(step), force(t, state), or both");
    s.param(parameters, "parameters", unit::one, "named constants that the code reads as parameters.name").or_else({});
    s.param(instruction_budget, "instruction_budget", unit::one, "instructions that one call may take")
        .or_else(100'000)
        .at_least(100)
        .at_most(1e10);
    s.param(memory_limit, "memory_limit", unit::one, "bytes that the script may hold").or_else(4 << 20).at_least(64 << 10).at_most(1 << 30);
    s.state(state, "state", unit::one, "named values that live across steps; read and written as state.name");
    s.state(random_state, "random_state", unit::one, "state of math.random; 0: seeded from the scene's seed and the component");
    s.state(quarantined, "quarantined", unit::one, "the script failed and is not called; false calls it again");
    s.output(instructions_used, "instructions_used", unit::one, "most instructions that one call of the step took");
    s.output(memory_used, "memory_used", unit::one, "bytes that the script holds");
    s.role(driver, "driver", {Facet::Body, Facet::Shaft, Facet::Quantities}, "participant that is only read").optional();
    s.role(driven, "driven", {Facet::Body, Facet::Shaft, Facet::Quantities}, "participant to which forces or rates can be added")
        .optional()
        .writes();
    s.role(between, "between", {Facet::Body, Facet::Shaft, Facet::Quantities},
           "participants to which forces or rates can be added, as between[i] in the order of ids")
        .optional()
        .writes();
    // The reference manual prints this text after the tables of fields (scratch fields themselves are not listed).
    s.scratch(machine, "machine", manual());
}

namespace
{

Call make_call(EntryPoint entry, const StepContext& context, const ScriptRows& rows, Row row)
{
    Call call;
    call.entry = entry, call.context = &context, call.row = row;
    call.driver = rows.driver[row], call.driven = rows.driven[row], call.between = &rows.between[row];
    call.parameters = &rows.parameters[row], call.state = &rows.state[row];
    return call;
}

/// Emits the event of a failure, once, with the time at which it happened.
void report(const StepContext& context, Row row, Machine& machine)
{
    const Failure& failure = *machine.failure();
    if (failure.reported) return;
    StepContext then = context;
    then.tick = failure.tick, then.time = failure.time;
    then.emit(row, failure.kind, Severity::Failure, failure.message);
    machine.mark_reported();
}

void quarantine(const StepContext& context, Row row, ScriptRows& rows)
{
    Machine& machine = *rows.machine[row];
    report(context, row, machine);
    machine.mark_booked();
    rows.quarantined[row] = true;
}

/// Whether the host has gone back to before the failure: a rewound trial, or a restored memento. Drive opens a step, so it
/// precedes everything else in that step.
bool is_before(const StepContext& context, EntryPoint entry, const Failure& failure)
{
    if (context.tick != failure.tick) return context.tick < failure.tick;
    return entry == EntryPoint::Drive || context.time < failure.time;
}

/// Whether the script can be called. A failure remains until it is recorded as a quarantine. If the host has gone back to before
/// it, or a client has ended the quarantine, the failure no longer counts: the machine, which may be in the state that the
/// failing call left, is built again.
bool is_ready(const StepContext& context, const ScriptRows& rows, Row row, EntryPoint entry)
{
    Machine& machine = *rows.machine[row];
    if (rows.quarantined[row]) return false;
    if (!machine.failure()) return true;
    if (machine.failure()->booked || is_before(context, entry, *machine.failure()))
        return machine.load(rows.code[row], make_call(EntryPoint::Load, context, rows, row)).ok();
    if (context.tick > machine.failure()->tick) report(context, row, machine);  // the scene's stages do not include Script/Finish
    return false;
}

/// Whether some participant that can receive forces is being advanced.
bool acts(const StepContext& context, const ScriptRows& rows, Row row)
{
    const Ref driven = rows.driven[row];
    if (driven.valid() && context.active(driven)) return true;
    for (const Ref r : rows.between[row])
        if (context.active(r)) return true;
    return false;
}

void apply(const Action& action, Wrenches& wrenches)
{
    switch (action.kind)
    {
        case Action::Kind::Force:
            return wrenches.add_force(action.on, action.value);
        case Action::Kind::ForceAt:
            return wrenches.add_force_at(action.on, action.value, action.at);
        case Action::Kind::Torque:
            return wrenches.add_torque(action.on, action.value);
        case Action::Kind::ShaftTorque:
            return wrenches.add_shaft_torque(action.on, action.value.x);
        case Action::Kind::Rate:
            return wrenches.add_rate(action.on, action.place, action.value.x);
    }
}

}  // namespace

Result<void> prepare(const StepContext& context, Row row, ScriptRows& rows)
{
    const Limits limits{rows.instruction_budget[row], static_cast<std::size_t>(rows.memory_limit[row])};
    auto machine = std::make_unique<Machine>(limits);
    if (auto loaded = machine->load(rows.code[row], make_call(EntryPoint::Load, context, rows, row)); !loaded) return loaded;
    rows.machine[row] = std::move(machine);
    return {};
}

void drive(const StepContext& context, Rows which, ScriptRows& rows, const Bodies& bodies, const Shafts& shafts,
           const Quantities& quantities)
{
    for (const Row row : which)
    {
        assert(rows.machine[row] && "Script/Prepare must run first");
        Machine& machine = *rows.machine[row];
        if (!is_ready(context, rows, row, EntryPoint::Drive)) continue;
        Call call = make_call(EntryPoint::Drive, context, rows, row);
        call.bodies = &bodies, call.shafts = &shafts, call.quantities = &quantities;
        call.writable_state = &rows.state[row], call.random_state = &rows.random_state[row];
        if (!machine.has_drive() || machine.drive(call)) continue;
        quarantine(context, row, rows);
    }
}

void force(const StepContext& context, Rows which, const ScriptRows& rows, const Bodies& bodies, const Shafts& shafts,
           const Quantities& quantities, Wrenches& wrenches)
{
    for (const Row row : which)
    {
        assert(rows.machine[row] && "Script/Prepare must run first");
        Machine& machine = *rows.machine[row];
        if (!acts(context, rows, row) || !is_ready(context, rows, row, EntryPoint::Force) || !machine.has_force()) continue;
        Call call = make_call(EntryPoint::Force, context, rows, row);
        call.bodies = &bodies, call.shafts = &shafts, call.quantities = &quantities;
        if (!machine.force(call)) continue;
        wrenches.begin(row < context.component_of_row.size() ? context.component_of_row[row] : kNoIndex);
        for (const Action& action : machine.actions())
            if (context.active(action.on)) apply(action, wrenches);
    }
}

void finish(const StepContext& context, Rows which, ScriptRows& rows)
{
    for (const Row row : which)
    {
        assert(rows.machine[row] && "Script/Prepare must run first");
        Machine& machine = *rows.machine[row];
        rows.instructions_used[row] = machine.take_instructions();
        rows.memory_used[row] = static_cast<std::int64_t>(machine.memory_used());
        if (rows.quarantined[row] || !machine.failure()) continue;
        quarantine(context, row, rows);
    }
}

}  // namespace plab::scripts
