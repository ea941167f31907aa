#include "condition.h"

namespace plab::rules
{
namespace
{

constexpr scripts::Limits kLimits{100'000, std::size_t{1} << 20};
constexpr const char* kAnswer = "applies";

Entries parameters_of(const Measures& m, double radius_a, double radius_b)
{
    return {{"distance", m.distance}, {"along", m.along},     {"radial", m.radial},
            {"angle", m.angle},       {"radius_a", radius_a}, {"radius_b", radius_b}};
}

Entries with_answer(const Entries& values)
{
    Entries out = values;
    out.push_back({kAnswer, false});
    return out;
}

scripts::Call make_call(scripts::EntryPoint entry, const StepContext& context, Row row, const Entries& parameters, Entries& state,
                        const RefList& nobody)
{
    scripts::Call call;
    call.entry = entry, call.context = &context, call.row = row, call.between = &nobody;
    call.parameters = &parameters, call.state = &state;
    return call;
}

}  // namespace

Condition::Condition() : machine_(kLimits) {}

Result<void> Condition::load(const std::string& code, const Entries& values, const StepContext& context, Row row)
{
    // The line of the answer comes last, so that messages have the author's lines.
    code_ = code +
            "\nif not applies then error('applies() is not defined', 0) end function drive(step) state.applies = applies() and true or "
            "false end";
    loaded_for_pairs_ = false;
    const Entries parameters = parameters_of({}, 0, 0);
    Entries state = with_answer(values);
    const RefList nobody;
    return machine_.load(code_, make_call(scripts::EntryPoint::Load, context, row, parameters, state, nobody));
}

Result<bool> Condition::applies(const StepContext& context, Row row, Ref a, Ref b, const Measures& measures, double radius_a,
                                double radius_b, Entries& values, const Bodies& bodies, const Shafts& shafts, const Quantities& quantities)
{
    const Entries parameters = parameters_of(measures, radius_a, radius_b);
    Entries state = with_answer(values);
    const RefList nobody;
    std::int64_t random_state = 1;
    scripts::Call call = make_call(scripts::EntryPoint::Load, context, row, parameters, state, nobody);
    call.driver = a, call.driven = b;
    call.bodies = &bodies, call.shafts = &shafts, call.quantities = &quantities;
    // A failed machine refuses all calls until it is loaded again; the objects are known only now.
    if (!loaded_for_pairs_ || machine_.failure())
        if (auto loaded = machine_.load(code_, call); !loaded) return loaded.errors();
    loaded_for_pairs_ = true;
    call.entry = scripts::EntryPoint::Drive, call.writable_state = &state, call.random_state = &random_state;
    if (!machine_.drive(call)) return reason(machine_.failure()->message);
    const bool applies = std::get<bool>(state.back().value);
    state.pop_back();
    values = std::move(state);
    return applies;
}

}  // namespace plab::rules
