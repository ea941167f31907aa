// From operations to their text: for the log, events, and requests that plabd's own command line makes.
#include <algorithm>

#include "control/operations.h"
#include "model/numbers.h"
#include "model/values.h"

namespace plab::control
{

Description description_of(const simulation::Operation& operation)
{
    using namespace simulation;
    struct Words
    {
        Description operator()(const AddOperation& op) const
        {
            return {"add", op.fragment.components.empty() ? "" : op.fragment.components.front().id, ""};
        }
        Description operator()(const AddBlueprintOperation& op) const
        {
            return {"add", op.blueprint->components.empty() ? "" : op.blueprint->components.front().id, ""};
        }
        Description operator()(const RemoveOperation& op) const { return {"remove", op.id, ""}; }
        Description operator()(const SwapOperation& op) const { return {"swap", op.id, op.type}; }
        Description operator()(const SetOperation& op) const
        {
            const auto* text = std::get_if<std::string>(&op.value);
            return {"set", op.id, op.name + " = " + (text ? *text : model::format_value(std::get<Value>(op.value)))};
        }
        Description operator()(const PushOperation& op) const { return {"push", op.id, model::format_value(op.impulse)}; }
        Description operator()(const PauseOperation&) const { return {"pause", "", ""}; }
        Description operator()(const ResumeOperation&) const { return {"resume", "", ""}; }
        Description operator()(const StepOperation& op) const { return {"step", "", std::to_string(op.steps)}; }
        Description operator()(const RateOperation& op) const
        {
            return {"rate", "", op.factor == 0 ? std::string("max") : model::format_real(op.factor)};
        }
        Description operator()(const ResetOperation&) const { return {"reset", "", ""}; }
        Description operator()(const LoadOperation& op) const { return {"load", "", op.scene.file}; }
        Description operator()(const SnapshotOperation& op) const { return {"snapshot", op.name, ""}; }
        Description operator()(const RestoreOperation& op) const { return {"restore", op.name, ""}; }
        Description operator()(const ForgetOperation& op) const { return {"forget", op.name, ""}; }
        Description operator()(const RewindOperation& op) const
        {
            return {"rewind", "", (op.back ? "back " : "") + model::format_real(op.time)};
        }
        Description operator()(const StepLengthOperation& op) const { return {"dt", "", model::format_real(op.dt.seconds)}; }
    };
    return std::visit(Words{}, operation);
}

wire::Operation text_of(const simulation::Operation& operation)
{
    const auto text = [](const simulation::GivenValue& given)
    {
        const auto* words = std::get_if<std::string>(&given);
        return words ? *words : model::format_value(std::get<Value>(given));
    };
    const Description words = description_of(operation);
    wire::Operation out{words.verb, words.target, words.argument, "", {}};
    if (const auto* swap = std::get_if<simulation::SwapOperation>(&operation))
        for (const simulation::NamedValue& v : swap->values) out.values.push_back({v.name, text(v.value)});
    if (const auto* set = std::get_if<simulation::SetOperation>(&operation))
    {
        out.argument.clear();
        out.values.push_back({set->name, text(set->value)});
    }
    return out;
}

bool begins_a_run(const std::vector<wire::Operation>& operations)
{
    const auto begins = [](const wire::Operation& op)
    { return op.verb == "reset" || op.verb == "load" || op.verb == "restore" || op.verb == "rewind"; };
    return std::any_of(operations.begin(), operations.end(), begins);
}

}  // namespace plab::control
