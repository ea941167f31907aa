#include "control/operations.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "blueprint/reader.h"
#include "idl/values/limits.h"
#include "model/compile.h"
#include "model/names.h"
#include "model/numbers.h"
#include "model/values.h"

namespace plab::control
{
namespace
{

using simulation::Operation;

/// What is needed to compile a scene that comes with a request.
struct Compiling
{
    model::TypeSource* types;
    const model::CompileLimits* limits;
};

/// What a verb uses; any other filled field is an error of the client, which is reported and not ignored.
struct Verb
{
    std::string_view name;
    std::string_view target;    ///< what the target is, "" if not used
    std::string_view argument;  ///< what the argument is, "" if not used
    bool argument_optional = false;
    bool blueprint = false;
    bool values = false;
    Result<Operation> (*make)(const wire::Operation&, const Compiling&) = nullptr;
};

std::vector<simulation::NamedValue> named_values(const wire::Operation& op)
{
    std::vector<simulation::NamedValue> out;
    for (const auto& [name, text] : op.values) out.push_back({name, text});
    return out;
}

Result<Vec3> parse_vector(const std::string& text, Unit unit)
{
    Field field;
    field.type = FieldType::Vector, field.unit = unit;
    auto value = model::parse_value(text, field);
    if (!value) return value.errors();
    return std::get<Vec3>(*value);
}

/// Three numbers in N s, or one in N m s for a shaft.
Result<Vec3> parse_impulse(const std::string& text)
{
    Field field;
    field.type = FieldType::Real, field.unit = unit::newton_metre_second;
    if (auto one = model::parse_value(text, field)) return Vec3{std::get<double>(*one), 0, 0};
    return parse_vector(text, unit::newton_second);
}

Result<Operation> make_add(const wire::Operation& op, const Compiling&)
{
    auto blueprint = blueprint::read_blueprint(op.blueprint, op.argument.empty() ? "request" : op.argument);
    if (!blueprint) return blueprint.errors();
    return Operation{simulation::AddBlueprintOperation{blueprint.take()}};
}
Result<Operation> make_load(const wire::Operation& op, const Compiling& with)
{
    auto blueprint = blueprint::read_blueprint(op.blueprint, op.argument.empty() ? "request" : op.argument);
    if (!blueprint) return blueprint.errors();
    auto scene = model::compile(*blueprint, *with.types, nullptr, *with.limits);
    if (!scene) return scene.errors();
    return Operation{simulation::LoadOperation{scene.take()}};
}
Result<Operation> make_remove(const wire::Operation& op, const Compiling&) { return Operation{simulation::RemoveOperation{op.target}}; }
Result<Operation> make_swap(const wire::Operation& op, const Compiling&)
{
    return Operation{simulation::SwapOperation{op.target, op.argument, named_values(op)}};
}
Result<Operation> make_push(const wire::Operation& op, const Compiling&)
{
    simulation::PushOperation push{op.target, {}, {}};
    bool given = false;
    for (const auto& [name, text] : op.values)
    {
        if (name != "impulse" && name != "point")
            return reason("has no value '" + name + "'" + model::did_you_mean(name, {"impulse", "point"}) + "; it has impulse and point");
        auto value = name == "impulse" ? parse_impulse(text) : parse_vector(text, unit::metre);
        if (!value) return reason(name + ": " + value.error().reason);
        if (name == "impulse")
            push.impulse = *value, given = true;
        else
            push.point = *value;
    }
    if (!given) return reason("needs the value impulse: three numbers in N s, or one in N m s for a shaft");
    return Operation{push};
}
Result<Operation> make_pause(const wire::Operation&, const Compiling&) { return Operation{simulation::PauseOperation{}}; }
Result<Operation> make_resume(const wire::Operation&, const Compiling&) { return Operation{simulation::ResumeOperation{}}; }
Result<Operation> make_reset(const wire::Operation&, const Compiling&) { return Operation{simulation::ResetOperation{}}; }
Result<Operation> make_step(const wire::Operation& op, const Compiling&)
{
    std::int64_t steps = 0;
    const char* const end = op.argument.data() + op.argument.size();
    const auto [stop, error] = std::from_chars(op.argument.data(), end, steps);
    if (error != std::errc() || stop != end || steps < 1) return reason("'" + op.argument + "' is not a number of steps: give 1 or more");
    return Operation{simulation::StepOperation{steps}};
}
Result<Operation> make_rate(const wire::Operation& op, const Compiling&)
{
    auto factor = parse_rate(op.argument);
    if (!factor) return factor.errors();
    return Operation{simulation::RateOperation{*factor}};
}
Result<Operation> make_dt(const wire::Operation& op, const Compiling&)
{
    auto dt = model::parse_step_length(op.argument);
    if (!dt) return dt.errors();
    return Operation{simulation::StepLengthOperation{*dt}};
}
Result<Operation> make_snapshot(const wire::Operation& op, const Compiling&)
{
    if (!wire::is_server_name(op.target))  // both occur in file names and command lines
        return reason("'" + op.target.substr(0, 64) + "' is not a valid snapshot name: use 1 to 64 letters, digits, '.', '_' or '-'");
    return Operation{simulation::SnapshotOperation{op.target}};
}
Result<Operation> make_restore(const wire::Operation& op, const Compiling&) { return Operation{simulation::RestoreOperation{op.target}}; }
Result<Operation> make_forget(const wire::Operation& op, const Compiling&) { return Operation{simulation::ForgetOperation{op.target}}; }
/// "2.5 s" is a time of the run, "back 2.5 s" is relative to the current time.
Result<Operation> make_rewind(const wire::Operation& op, const Compiling&)
{
    constexpr std::string_view kBack = "back ";
    const bool back = op.argument.starts_with(kBack);
    Field field;
    field.type = FieldType::Real, field.unit = unit::second;
    auto value = model::parse_value(op.argument.substr(back ? kBack.size() : 0), field);
    if (!value) return value.errors();
    const double time = std::get<double>(*value);
    if (std::signbit(time))
        return reason("'" + op.argument +
                      "' is negative: a rewind takes a time of the run, such as '2.5 s', or a duration to go back, such as 'back 0.5 s'");
    return Operation{simulation::RewindOperation{time, back}};
}
/// These verbs only need an entry in the table: set makes one operation of each value, shutdown none.
Result<Operation> make_nothing(const wire::Operation&, const Compiling&) { return reason("is not an operation"); }

constexpr std::array<Verb, 20> kVerbs{{
    {"add", "", "the file's name for messages", true, true, false, &make_add},
    {"remove", "the component", "", false, false, false, &make_remove},
    {"swap", "the component", "the new type", false, false, true, &make_swap},
    {"set", "the component", "", false, false, true, &make_nothing},
    {"push", "the object", "", false, false, true, &make_push},
    {"pause", "", "", false, false, false, &make_pause},
    {"resume", "", "", false, false, false, &make_resume},
    {"step", "", "the number of steps", false, false, false, &make_step},
    {"rate", "", "real, max or a factor", false, false, false, &make_rate},
    {"reset", "", "", false, false, false, &make_reset},
    {"load", "", "the file's name for messages", true, true, false, &make_load},
    {"dt", "", "the step length", false, false, false, &make_dt},
    {"snapshot", "the snapshot's name", "", false, false, false, &make_snapshot},
    {"restore", "the snapshot's name", "", false, false, false, &make_restore},
    {"forget", "the snapshot's name", "", false, false, false, &make_forget},
    {"rewind", "", "a time of the run, or 'back' and a duration", false, false, false, &make_rewind},
    {"shutdown", "", "", false, false, false, &make_nothing},
    {"trial", "", "none, a time in ms, and or refuse", false, false, false, &make_nothing},
    {"energy", "", "a factor, or any", false, false, false, &make_nothing},
    {"cancel", "", "a request: client:number", false, false, false, &make_nothing},
}};

const Verb* find_verb(const std::string& name)
{
    const auto found = std::find_if(kVerbs.begin(), kVerbs.end(), [&](const Verb& v) { return v.name == name; });
    return found == kVerbs.end() ? nullptr : &*found;
}

Error unknown_verb(const std::string& name)
{
    std::vector<std::string> known;
    for (const Verb& v : kVerbs) known.emplace_back(v.name);
    return reason("'" + name + "' is not an operation" + model::did_you_mean(name, known));
}

std::string given_too_much(const Verb& verb, const wire::Operation& op)
{
    if (verb.target.empty() && !op.target.empty()) return "takes no target";
    if (verb.argument.empty() && !op.argument.empty()) return "takes no argument";
    if (!verb.blueprint && !op.blueprint.empty()) return "takes no blueprint";
    if (!verb.values && !op.values.empty()) return "takes no values";
    return {};
}

std::string given_too_little(const Verb& verb, const wire::Operation& op)
{
    if (!verb.target.empty() && op.target.empty()) return "needs a target: " + std::string(verb.target);
    if (!verb.argument.empty() && !verb.argument_optional && op.argument.empty()) return "needs an argument: " + std::string(verb.argument);
    if (verb.blueprint && op.blueprint.empty()) return "needs a blueprint: XML text";
    if (op.verb == "set" && op.values.empty()) return "needs values: pairs of name and text";
    std::set<std::string_view> names;
    for (const auto& [name, text] : op.values)
    {
        if (name.empty()) return "has a value without a name";
        if (!names.insert(name).second) return "gives '" + name + "' twice";
    }
    return {};
}

/// trial and energy change nothing themselves: they specify how the swap in the same request is tested.
Result<void> choose_proof(const wire::Operation& op, simulation::TrialChoice& choice)
{
    if (op.verb == "trial")
    {
        auto trial = parse_trial(op.argument);
        if (!trial) return trial.errors();
        choice.budget = trial->budget, choice.ns = trial->ns, choice.must = trial->must;
        return {};
    }
    if (op.argument == "any")
    {
        choice.energy_factor = std::numeric_limits<double>::infinity();
        return {};
    }
    Field field;
    field.type = FieldType::Real;
    auto factor = model::parse_value(op.argument, field);
    if (!factor) return factor.errors();
    choice.energy_factor = std::get<double>(*factor);
    if (!(choice.energy_factor >= 1)) return reason("'" + op.argument + "' is not a factor of the energy: give 1 or more, or any");
    return {};
}

Result<void> append(const wire::Operation& op, const Compiling& with, Wanted& out)
{
    const Verb* verb = find_verb(op.verb);
    if (!verb) return unknown_verb(op.verb);
    if (const std::string why = given_too_much(*verb, op); !why.empty()) return reason(why);
    if (const std::string why = given_too_little(*verb, op); !why.empty()) return reason(why);
    if (op.verb == "shutdown")
    {
        out.shutdown = true;
        return {};
    }
    if (op.verb == "trial" || op.verb == "energy") return choose_proof(op, out.request.trial);
    if (op.verb == "cancel")
    {
        auto name = parse_request_name(op.argument);
        if (!name) return name.errors();
        out.cancel = *name;
        return {};
    }
    if (op.verb == "set")
    {
        for (const auto& [name, text] : op.values) out.request.operations.push_back(simulation::SetOperation{op.target, name, text});
        return {};
    }
    auto made = verb->make(op, with);
    if (!made) return made.errors();
    out.request.operations.push_back(made.take());
    return {};
}

}  // namespace

Result<Wanted> wanted_of(const wire::Request& text, model::TypeSource& types, const model::CompileLimits& limits)
{
    Wanted out;
    // A request on the bus runs in a loop that other clients watch: its trial must not block the loop for long.
    out.request.trial.budget = simulation::TrialChoice::Budget::Automatic;
    Errors errors;
    for (std::size_t i = 0; i < text.operations.size(); ++i)
    {
        auto done = append(text.operations[i], {&types, &limits}, out);
        if (done) continue;
        for (Error e : done.errors())
        {
            // Errors in a blueprint have a place of their own.
            if (e.where.file.empty())
                e.element = "operation " + std::to_string(i + 1) + " (" + text.operations[i].verb + ")" +
                            (e.element.empty() ? "" : ": " + e.element);
            errors.push_back(std::move(e));
        }
    }
    if (errors.empty() && out.shutdown && text.operations.size() > 1)
        errors.push_back(reason("shutdown must be the only operation of a request"));
    if (errors.empty() && out.shutdown && (text.at >= 0 || text.revision >= 0))
        errors.push_back(reason("shutdown takes effect at once: do not give a step or a revision"));
    if (errors.empty() && out.cancel && (text.operations.size() > 1 || text.at >= 0 || text.revision >= 0))
        errors.push_back(
            reason("cancel must be the only operation of a request, and takes effect at once: do not give a step or a revision"));
    if (!errors.empty()) return errors;
    if (text.at >= 0) out.request.at = text.at;
    if (text.revision >= 0) out.request.revision = static_cast<std::uint64_t>(text.revision);
    return out;
}

}  // namespace plab::control
