#include "simulation/transaction/inputs.h"

#include "model/values.h"
#include "simulation/costs/clock.h"
#include "simulation/run/field_change.h"

namespace plab::simulation
{
namespace
{

/// The field that an operation sets, if it is an input.
struct Input
{
    std::uint32_t component = kNoIndex;
    const Field* field = nullptr;
};

std::optional<Input> input_of(const world::World& world, const Operation& operation)
{
    const auto* set = std::get_if<SetOperation>(&operation);
    if (!set) return {};
    const std::uint32_t i = world.find(set->id);
    if (i == kNoIndex) return {};
    const world::Component& c = world.component(i);
    if (c.table == kNoIndex || c.quarantined) return {};
    const Field* field = world.table_of(i).schema().find_field(set->name);
    if (!field || !field->is_input || field->hosted || field->kind != FieldKind::State) return {};
    return Input{i, field};
}

}  // namespace

std::optional<Reply> set_inputs(Run& run, const Request& request)
{
    const std::uint64_t begin = now_ns();
    world::World& world = run.world();
    if (request.operations.empty()) return {};
    std::vector<Input> inputs(request.operations.size());
    for (std::size_t k = 0; k < inputs.size(); ++k)
    {
        const auto input = input_of(world, request.operations[k]);
        if (!input) return {};
        inputs[k] = *input;
    }
    Reply reply;
    reply.request = request.id, reply.step = run.clock.tick, reply.revision = run.revision;
    std::vector<Value> values(inputs.size());
    for (std::size_t k = 0; k < inputs.size() && reply.errors.empty(); ++k)
    {
        const auto& set = std::get<SetOperation>(request.operations[k]);
        auto value = value_for(*inputs[k].field, set.value);
        if (value)
            values[k] = value.take();
        else
            reply.errors = {
                {{}, set.id + " (" + world.type_of(inputs[k].component)->info.name + ")", set.name + ": " + value.error().reason}};
    }
    reply.done = reply.errors.empty();
    for (std::size_t k = 0; k < inputs.size() && reply.done; ++k)
    {
        inputs[k].field->column->set(world.component(inputs[k].component).row, values[k]);
        run.changes.by_scripts.insert(inputs[k].component);
    }
    reply.pause_ns = static_cast<double>(now_ns() - begin);
    return reply;
}

}  // namespace plab::simulation
